// Unpacks pixels with GDCM, a frame at a time.
#include "tools/volume/dicom_pixels.hpp"

#include <gdcmImageReader.h>
#include <gdcmSequenceOfFragments.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>

#include "tools/volume/voxel_numbers.hpp"

namespace orcart {

namespace {

VoxelType voxel_type(const gdcm::PixelFormat& format) {
  const bool is_signed = format.GetPixelRepresentation() == 1;
  if (format.GetBitsAllocated() == 8) return is_signed ? VoxelType::i8 : VoxelType::u8;
  if (format.GetBitsAllocated() == 16) return is_signed ? VoxelType::i16 : VoxelType::u16;
  return is_signed ? VoxelType::i32 : VoxelType::u32;
}

/// The piece of compressed pixels that each frame begins with, and the count of pieces at the end; empty
/// where nothing tells.
std::vector<std::size_t> first_pieces(const gdcm::SequenceOfFragments& pieces, std::size_t frames) {
  const std::size_t count = pieces.GetNumberOfFragments();
  std::vector<std::size_t> by_table, by_start;
  std::vector<std::uint32_t> table;
  if (const gdcm::ByteValue* bytes = pieces.GetTable().GetByteValue(); bytes != nullptr) {
    table.resize(bytes->GetLength() / 4);
    std::copy_n(bytes->GetPointer(), table.size() * 4, reinterpret_cast<char*>(table.data()));
  }
  std::uint64_t offset = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const gdcm::ByteValue* bytes = pieces.GetFragment(i).GetByteValue();
    if (bytes == nullptr) return {};
    if (by_table.size() < table.size() && table[by_table.size()] == offset) by_table.push_back(i);
    offset += 8 + bytes->GetLength();
    const std::string_view start(bytes->GetPointer(), std::min<std::size_t>(bytes->GetLength(), 2));
    if (start == "\xFF\xD8" || start == "\xFF\x4F") by_start.push_back(i);  // JPEG's, JPEG 2000's
  }
  std::vector<std::size_t> firsts;
  if (count == frames)
    for (std::size_t i = 0; i < count; ++i) firsts.push_back(i);
  else if (frames == 1 && count > 0)
    firsts.push_back(0);
  else if (by_table.size() == frames)
    firsts = std::move(by_table);
  else if (by_start.size() == frames)
    firsts = std::move(by_start);
  if (!firsts.empty()) firsts.push_back(count);
  return firsts;
}

/// One of the byte planes of run-length pixels (PS3.5, annex G.3.1), as many bytes as there is room for.
std::size_t unpack_plane(std::string_view packed, std::span<char> plane) {
  std::size_t at = 0, done = 0;
  while (at + 1 < packed.size() && done < plane.size()) {
    const int control = static_cast<signed char>(packed[at++]);
    if (control == -128) continue;
    const std::size_t asked = static_cast<std::size_t>(control >= 0 ? control + 1 : 1 - control);
    const std::size_t count = std::min(asked, plane.size() - done);
    if (control >= 0 && count > packed.size() - at) break;
    for (std::size_t i = 0; i < count; ++i) plane[done++] = packed[at + (control >= 0 ? i : 0)];
    at += control >= 0 ? asked : 1;
  }
  return done;
}

/// Run-length pixels of one sample: a head of 64 bytes with the places of the planes, the highest byte's
/// plane first. By hand, since GDCM aborts on damaged ones.
bool unpack_run_lengths(std::string_view packed, std::size_t bytes_each, std::span<char> pixels) {
  constexpr std::size_t kHead = 64;
  if (packed.size() < kHead) return false;
  std::array<std::uint32_t, 16> head{};
  std::memcpy(head.data(), packed.data(), kHead);
  if (head[0] != bytes_each) return false;
  std::vector<char> plane(pixels.size() / bytes_each);
  for (std::size_t i = 0; i < bytes_each; ++i) {
    const std::size_t start = head[i + 1], end = i + 1 < bytes_each ? head[i + 2] : packed.size();
    if (start < kHead || start > end || end > packed.size()) return false;
    if (unpack_plane(packed.substr(start, end - start), plane) != plane.size()) return false;
    for (std::size_t pixel = 0; pixel < plane.size(); ++pixel)
      pixels[pixel * bytes_each + bytes_each - 1 - i] = plane[pixel];
  }
  return true;
}

std::string joined(const gdcm::SequenceOfFragments& pieces) {
  std::string all;
  for (std::size_t i = 0; i < pieces.GetNumberOfFragments(); ++i)
    if (const gdcm::ByteValue* bytes = pieces.GetFragment(i).GetByteValue(); bytes != nullptr)
      all.append(bytes->GetPointer(), bytes->GetLength());
  return all;
}

}  // namespace

struct DicomPixels::Parts {
  std::string name;
  gdcm::ImageReader reader;
  std::size_t frames = 1, frame_bytes = 0;
  std::vector<std::size_t> firsts;  ///< of compressed pixels

  const gdcm::Image& image() const { return reader.GetImage(); }
  tl::unexpected<Error> cut_short() const {
    return fail(name + ": its pixels (" +
                std::string(gdcm::TransferSyntax::GetTSString(image().GetTransferSyntax())) +
                ") cannot be unpacked or are cut short; a whole file, best uncompressed, is expected");
  }

  /// The bytes of a frame as the file has them; nothing where they end before it does.
  std::optional<gdcm::DataElement> packed(std::size_t frame) const {
    gdcm::DataElement element(gdcm::Tag(0x7fe0, 0x0010));
    element.SetVR(image().GetDataElement().GetVR());
    if (const gdcm::ByteValue* bytes = image().GetDataElement().GetByteValue(); bytes != nullptr) {
      if ((frame + 1) * frame_bytes > bytes->GetLength()) return std::nullopt;
      element.SetByteValue(bytes->GetPointer() + frame * frame_bytes,
                           gdcm::VL(static_cast<std::uint32_t>(frame_bytes)));
      return element;
    }
    const gdcm::SequenceOfFragments* pieces = image().GetDataElement().GetSequenceOfFragments();
    if (pieces == nullptr || frame + 1 >= firsts.size()) return std::nullopt;
    auto own = gdcm::SequenceOfFragments::New();
    for (std::size_t i = firsts[frame]; i < firsts[frame + 1]; ++i) own->AddFragment(pieces->GetFragment(i));
    element.SetValue(*own);
    return element;
  }
};

DicomPixels::DicomPixels(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
DicomPixels::DicomPixels(DicomPixels&&) noexcept = default;
DicomPixels& DicomPixels::operator=(DicomPixels&&) noexcept = default;
DicomPixels::~DicomPixels() = default;

Result<DicomPixels> DicomPixels::read(const std::filesystem::path& file) {
  auto parts = std::make_unique<Parts>();
  parts->name = file.string();
  std::ifstream stream(file, std::ios::binary);
  parts->reader.SetStream(stream);
  if (!parts->reader.Read())
    return fail(parts->name +
                ": its pixels cannot be read; it is broken, cut short, or compressed in a way that is "
                "not known, so export it uncompressed");
  const gdcm::Image& image = parts->image();
  const gdcm::PixelFormat& format = image.GetPixelFormat();
  const unsigned bits = format.GetBitsAllocated();
  if (format.GetSamplesPerPixel() != 1 || (bits != 8 && bits != 16 && bits != 32))
    return fail(parts->name + ": has " + std::to_string(format.GetSamplesPerPixel()) + " samples of " +
                std::to_string(bits) + " bits a pixel; one of 8, 16 or 32 is accepted");
  if (image.GetNumberOfDimensions() > 2) parts->frames = image.GetDimension(2);
  parts->frame_bytes = std::size_t{image.GetDimension(0)} * image.GetDimension(1) * bits / 8;
  if (const auto* pieces = image.GetDataElement().GetSequenceOfFragments(); pieces != nullptr) {
    parts->firsts = first_pieces(*pieces, parts->frames);
    if (parts->firsts.empty())
      return fail(parts->name + ": holds " + std::to_string(parts->frames) + " frames in " +
                  std::to_string(pieces->GetNumberOfFragments()) +
                  " pieces of compressed pixels, and nothing says which begins a frame; it is cut short, or "
                  "should be exported uncompressed");
  }
  return DicomPixels(std::move(parts));
}

Result<void> DicomPixels::take(const DicomSlice& slice, float* values) const {
  const std::size_t pixels = static_cast<std::size_t>(slice.columns) * static_cast<std::size_t>(slice.rows);
  const gdcm::PixelFormat& format = parts_->image().GetPixelFormat();
  const std::size_t bytes = pixels * format.GetBitsAllocated() / 8;
  const auto packed = parts_->packed(slice.frame > 0 ? static_cast<std::size_t>(slice.frame) - 1 : 0);
  if (!packed || parts_->frame_bytes != bytes) return parts_->cut_short();
  gdcm::Image frame(parts_->image());
  frame.SetNumberOfDimensions(2);
  frame.SetDimension(0, static_cast<unsigned>(slice.columns));
  frame.SetDimension(1, static_cast<unsigned>(slice.rows));
  frame.SetDataElement(*packed);
  std::vector<char> buffer(std::max<std::size_t>(frame.GetBufferLength(), bytes));
  const gdcm::SequenceOfFragments* pieces = packed->GetSequenceOfFragments();
  const bool runs = frame.GetTransferSyntax() == gdcm::TransferSyntax::RLELossless && pieces != nullptr;
  const bool unpacked = runs ? unpack_run_lengths(joined(*pieces), format.GetBitsAllocated() / 8,
                                                  std::span(buffer).first(bytes))
                             : frame.GetBufferLength() >= bytes && frame.GetBuffer(buffer.data());
  if (!unpacked) return parts_->cut_short();
  const VoxelEncoding encoding{
      .type = voxel_type(format), .slope = slice.slope, .intercept = slice.intercept};
  std::vector<float> numbers;
  append_numbers(std::as_bytes(std::span(buffer)).first(bytes), encoding, numbers);
  std::copy(numbers.begin(), numbers.end(), values);
  return {};
}

}  // namespace orcart
