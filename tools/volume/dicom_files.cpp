// Reads DICOM with GDCM; everything it says is checked before it is believed.
#include "tools/volume/dicom_files.hpp"

#include <gdcmAttribute.h>
#include <gdcmImageReader.h>
#include <gdcmReader.h>
#include <gdcmStringFilter.h>
#include <gdcmTrace.h>
#include <gdcmUIDs.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <set>
#include <string_view>

#include "firmware-host/files/whole_file.hpp"
#include "tools/volume/header_words.hpp"
#include "tools/volume/voxel_numbers.hpp"

namespace orcart {

namespace {

using namespace std::string_view_literals;

constexpr std::uintmax_t kMostSliceBytes = std::uintmax_t{1} << 30U;

/// A number at a place of a file in memory; 0 beyond its end.
std::uint32_t little_at(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < count && at + i < bytes.size(); ++i)
    number |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return number;
}

/// Where the data set begins and how it is written, or nothing where that is not a plain little-endian one.
struct SetStart {
  std::size_t at = 0;
  bool implicit = false, plain = true;
};

/// A file without the 128 bytes and `DICM` in front, as software of the 1990s wrote them: its first two
/// elements are of group 8, in order.
std::optional<SetStart> bare_start(std::string_view bytes) {
  if (bytes.size() < 16 || little_at(bytes, 0, 2) != 8) return std::nullopt;
  const auto capital = [&](std::size_t at) { return bytes[at] >= 'A' && bytes[at] <= 'Z'; };
  const bool named = capital(4) && capital(5);
  const std::uint32_t length = named ? little_at(bytes, 6, 2) : little_at(bytes, 4, 4);
  if (length > bytes.size() || 8 + length + 4 > bytes.size()) return std::nullopt;
  const std::size_t next = 8 + length;
  if (little_at(bytes, next, 2) != 8 || little_at(bytes, next + 2, 2) <= little_at(bytes, 2, 2))
    return std::nullopt;
  return SetStart{.at = 0, .implicit = !named};
}

std::optional<SetStart> set_start(std::string_view bytes) {
  constexpr std::size_t kMetaAt = 132;
  if (bytes.substr(0, kMetaAt).substr(std::min<std::size_t>(bytes.size(), 128)) != "DICM")
    return bare_start(bytes);
  if (bytes.size() < kMetaAt + 12 || little_at(bytes, kMetaAt, 4) != 2) return std::nullopt;
  const std::size_t set_at = kMetaAt + 12 + little_at(bytes, kMetaAt + 8, 4);
  if (set_at + 8 > bytes.size()) return std::nullopt;
  const std::string_view meta = bytes.substr(kMetaAt, set_at - kMetaAt);
  const bool big = meta.find("1.2.840.10008.1.2.2"sv) != std::string_view::npos,
             deflated = meta.find("1.2.840.10008.1.2.1.99"sv) != std::string_view::npos;
  return SetStart{.at = set_at,
                  .implicit = meta.find("1.2.840.10008.1.2\0"sv) != std::string_view::npos,
                  .plain = !big && !deflated};
}

/// Whether every element up to the pixels lies within the file: GDCM aborts on some files that are cut short
/// and fills others up. Walks explicit and implicit little endian; an element of undefined length, whose end
/// only its contents tell, ends the walk.
bool is_whole(std::string_view bytes) {
  const auto start = set_start(bytes);
  if (!start || !start->plain) return start.has_value();
  const bool implicit = start->implicit;
  std::size_t at = start->at;
  while (at < bytes.size()) {
    if (at + 8 > bytes.size()) return false;
    const std::string_view kind = bytes.substr(at + 4, 2);
    const bool wide =
        !implicit && "OB OD OF OL OV OW SQ SV UC UN UR UT UV"sv.find(kind) != std::string_view::npos;
    const std::size_t head = wide ? 12 : 8;
    if (at + head > bytes.size()) return false;
    const std::uint32_t length = implicit ? little_at(bytes, at + 4, 4)
                                 : wide   ? little_at(bytes, at + 8, 4)
                                          : little_at(bytes, at + 6, 2);
    if (length == 0xFFFFFFFFU) return true;
    at += head + length;
  }
  return at == bytes.size();
}

/// The text of an element; several values are separated by backslashes.
std::string text_at(const gdcm::DataSet& set, std::uint16_t group, std::uint16_t element) {
  const gdcm::Tag tag(group, element);
  if (!set.FindDataElement(tag)) return {};
  const gdcm::ByteValue* value = set.GetDataElement(tag).GetByteValue();
  if (value == nullptr) return {};
  std::string text(value->GetPointer(), value->GetLength());
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
  return std::string(trimmed(text));
}

std::optional<std::vector<double>> numbers_at(const gdcm::DataSet& set, std::uint16_t group,
                                              std::uint16_t element, std::size_t count) {
  std::string text = text_at(set, group, element);
  std::replace(text.begin(), text.end(), '\\', ' ');
  return numbers_of(text, count);
}

double number_at(const gdcm::DataSet& set, std::uint16_t group, std::uint16_t element, double fallback) {
  const auto number = numbers_at(set, group, element, 1);
  return number ? (*number)[0] : fallback;
}

int short_at(const gdcm::DataSet& set, std::uint16_t group, std::uint16_t element) {
  const gdcm::Tag tag(group, element);
  if (!set.FindDataElement(tag)) return 0;
  const gdcm::ByteValue* value = set.GetDataElement(tag).GetByteValue();
  if (value == nullptr || value->GetLength() < 2) return 0;
  std::uint16_t number = 0;
  std::copy_n(value->GetPointer(), 2, reinterpret_cast<char*>(&number));
  return number;
}

bool unit_and_square(const std::vector<double>& six) {
  double u = 0, v = 0, uv = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    u += six[i] * six[i];
    v += six[i + 3] * six[i + 3];
    uv += six[i] * six[i + 3];
  }
  return std::abs(u - 1) < 0.01 && std::abs(v - 1) < 0.01 && std::abs(uv) < 0.01;
}

std::string variant_of(const gdcm::DataSet& set) {
  std::string variant;
  const auto add = [&](const char* name, std::uint16_t group, std::uint16_t element) {
    const std::string value = text_at(set, group, element);
    if (!value.empty()) variant += (variant.empty() ? "" : ", ") + (name + (" " + value));
  };
  add("time", 0x0020, 0x0100);
  add("echo", 0x0018, 0x0086);
  return variant;
}

Result<DicomSlice> slice_of(const std::filesystem::path& file, const gdcm::DataSet& set) {
  DicomSlice slice{.file = file};
  slice.patient = std::hash<std::string>{}(text_at(set, 0x0010, 0x0020) + "|" + text_at(set, 0x0010, 0x0010) +
                                           "|" + text_at(set, 0x0010, 0x0030));
  slice.instance = text_at(set, 0x0008, 0x0018);
  slice.series = text_at(set, 0x0020, 0x000E);
  slice.frame_of_reference = text_at(set, 0x0020, 0x0052);
  slice.modality = text_at(set, 0x0008, 0x0060);
  slice.variant = variant_of(set);
  slice.acquisition = text_at(set, 0x0020, 0x0012);
  slice.rows = short_at(set, 0x0028, 0x0010);
  slice.columns = short_at(set, 0x0028, 0x0011);
  slice.thickness_mm = number_at(set, 0x0018, 0x0050, 1);
  const auto position = numbers_at(set, 0x0020, 0x0032, 3), axes = numbers_at(set, 0x0020, 0x0037, 6),
             spacing = numbers_at(set, 0x0028, 0x0030, 2);
  slice.has_position = position && axes;
  if (!slice.has_position) return slice;
  if (!spacing || !((*spacing)[0] > 0 && (*spacing)[1] > 0))
    return fail(file.string() + ": states the PixelSpacing \"" + text_at(set, 0x0028, 0x0030) +
                "\"; two positive numbers are expected");
  if (!unit_and_square(*axes))
    return fail(file.string() + ": states the ImageOrientationPatient \"" + text_at(set, 0x0020, 0x0037) +
                "\"; two unit vectors at right angles are expected");
  for (std::size_t i = 0; i < 3; ++i) {
    slice.position_mm[i] = (*position)[i];
    slice.along_columns[i] = (*axes)[i];
    slice.along_rows[i] = (*axes)[i + 3];
  }
  slice.row_step_mm = (*spacing)[0];
  slice.column_step_mm = (*spacing)[1];
  return slice;
}

Result<DicomSlice> read_header(const std::filesystem::path& file) {
  const auto bytes = read_whole_file(file, kMostSliceBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  if (!is_whole({reinterpret_cast<const char*>(bytes->data()), bytes->size()}))
    return fail(file.string() + ": begins as DICOM but is broken or cut short; a whole file is expected");
  std::ifstream stream(file, std::ios::binary);
  gdcm::Reader reader;
  reader.SetStream(stream);
  const std::set<gdcm::Tag> no_skipped;
  if (!reader.ReadUpToTag(gdcm::Tag(0x7fe0, 0x0010), no_skipped))
    return fail(file.string() + ": begins as DICOM but cannot be read; it is broken or cut short");
  const gdcm::DataSet& set = reader.GetFile().GetDataSet();
  const double frames = number_at(set, 0x0028, 0x0008, 1);
  if (frames > 1)
    return fail(file.string() + ": holds " + std::to_string(std::lround(frames)) +
                " frames (enhanced multi-frame DICOM); one slice a file is accepted, so export it as classic "
                "DICOM or as NIfTI");
  return slice_of(file, set);
}

bool is_image(const DicomSlice& slice) {
  return slice.rows > 0 && slice.columns > 0;
}

VoxelType voxel_type(const gdcm::PixelFormat& format) {
  const bool is_signed = format.GetPixelRepresentation() == 1;
  if (format.GetBitsAllocated() == 8) return is_signed ? VoxelType::i8 : VoxelType::u8;
  if (format.GetBitsAllocated() == 16) return is_signed ? VoxelType::i16 : VoxelType::u16;
  return is_signed ? VoxelType::i32 : VoxelType::u32;
}

Result<void> read_pixels(const DicomSlice& slice, float* values) {
  const std::string name = slice.file.string();
  gdcm::ImageReader reader;
  std::ifstream stream(slice.file, std::ios::binary);
  reader.SetStream(stream);
  const bool read = reader.Read();
  const gdcm::Image& image = reader.GetImage();
  const gdcm::PixelFormat& format = image.GetPixelFormat();
  const unsigned bits = format.GetBitsAllocated();
  const auto pixels = static_cast<std::size_t>(slice.columns) * static_cast<std::size_t>(slice.rows);
  if (!read)
    return fail(name +
                ": its pixels cannot be read; it is broken, cut short, or compressed in a way that is "
                "not known, so export it uncompressed");
  if (format.GetSamplesPerPixel() != 1 || (bits != 8 && bits != 16 && bits != 32))
    return fail(name + ": has " + std::to_string(format.GetSamplesPerPixel()) + " samples of " +
                std::to_string(bits) + " bits a pixel; one of 8, 16 or 32 is accepted");
  const std::size_t bytes = pixels * bits / 8;
  std::vector<char> buffer(std::max<std::size_t>(image.GetBufferLength(), bytes));
  if (image.GetBufferLength() < bytes || !image.GetBuffer(buffer.data()))
    return fail(name + ": its pixels (" +
                std::string(gdcm::TransferSyntax::GetTSString(image.GetTransferSyntax())) +
                ") cannot be unpacked or are cut short; a whole file, best uncompressed, is expected");
  const gdcm::DataSet& set = reader.GetFile().GetDataSet();
  const VoxelEncoding encoding{.type = voxel_type(format),
                               .slope = number_at(set, 0x0028, 0x1053, 1),
                               .intercept = number_at(set, 0x0028, 0x1052, 0)};
  std::vector<float> numbers;
  append_numbers(std::as_bytes(std::span(buffer)).first(bytes), encoding, numbers);
  std::copy(numbers.begin(), numbers.end(), values);
  return {};
}

}  // namespace

bool is_dicom(const std::filesystem::path& file) {
  std::array<char, 132> start{};
  std::ifstream(file, std::ios::binary).read(start.data(), start.size());
  const std::string_view bytes(start.data(), start.size());
  return bytes.substr(128) == "DICM" || bare_start(bytes);
}

Result<DicomFolder> read_dicom_folder(const std::filesystem::path& folder) {
  gdcm::Trace::SetWarning(false);
  gdcm::Trace::SetError(false);
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (auto entry = std::filesystem::recursive_directory_iterator(folder, error);
       entry != std::filesystem::recursive_directory_iterator() && !error; entry.increment(error))
    if (entry->is_regular_file()) files.push_back(entry->path());
  std::sort(files.begin(), files.end());
  DicomFolder found;
  std::size_t others = 0;
  for (const auto& file : files) {
    auto slice = is_dicom(file) ? read_header(file) : Result<DicomSlice>(DicomSlice{});
    if (!slice) return tl::unexpected(slice.error());
    if (is_image(*slice))
      found.slices.push_back(*std::move(slice));
    else
      ++others;
  }
  if (found.slices.empty())
    return fail(folder.string() + ": holds " + std::to_string(files.size()) +
                " files and no DICOM image; a folder with the slices of a series is expected");
  if (others > 0)
    found.notes.push_back(std::to_string(others) + " files beside the slices are no DICOM images");
  return found;
}

Result<Volume> read_stack(const DicomStack& stack, const std::function<void(double done)>& progress) {
  const DicomSlice& first = stack.slices.front();
  Volume volume{.lattice = stack.lattice,
                .values = {},
                .kind = "DICOM " + first.modality + ", " + std::to_string(stack.slices.size()) + " slices",
                .series = first.series,
                .frame_of_reference = first.frame_of_reference,
                .notes = stack.notes};
  const std::size_t layer = static_cast<std::size_t>(first.columns) * static_cast<std::size_t>(first.rows);
  if (layer * stack.slices.size() > kMostVoxels)
    return fail(first.file.parent_path().string() + ": has " + std::to_string(layer * stack.slices.size()) +
                " voxels; up to " + std::to_string(kMostVoxels) + " are accepted");
  volume.values.resize(layer * stack.slices.size());
  for (std::size_t i = 0; i < stack.slices.size(); ++i) {
    if (auto read = read_pixels(stack.slices[i], volume.values.data() + i * layer); !read)
      return tl::unexpected(read.error());
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(stack.slices.size()));
  }
  return volume;
}

}  // namespace orcart
