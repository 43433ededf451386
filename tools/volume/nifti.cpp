// NIfTI-1 and NIfTI-2 (nifti1.h and nifti2.h of the NIfTI Data Format Working Group, 2004 and 2011).
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "tools/volume/volume_formats.hpp"

namespace orcart {

namespace {

constexpr std::size_t kBytes1 = 348, kBytes2 = 540;

/// A header of either version in either byte order.
class Header {
 public:
  explicit Header(std::span<const std::byte> bytes) : bytes_(bytes) {
    for (const bool swapped : {false, true})
      for (const std::size_t size : {kBytes1, kBytes2}) {
        swapped_ = swapped;
        if (valid_ || bytes.size() < size || at<std::int32_t>(0) != static_cast<std::int32_t>(size)) continue;
        second_ = size == kBytes2;
        std::array<char, 4> magic{};
        std::memcpy(magic.data(), bytes.data() + (second_ ? 4 : 344), magic.size());
        const std::string_view word(magic.data(), 3);
        if (word != "n+1" && word != "ni1" && word != "n+2" && word != "ni2") continue;
        single_file_ = word[1] == '+';
        valid_ = true;
        byte_order_swapped_ = swapped;
      }
    swapped_ = byte_order_swapped_;
  }

  bool valid() const { return valid_; }
  bool single_file() const { return single_file_; }
  /// Of the voxels in a single file: behind the header and the four bytes that tell of extensions.
  std::size_t least_offset() const { return (second_ ? kBytes2 : kBytes1) + 4; }
  bool big_endian() const { return swapped_ == (std::endian::native == std::endian::little); }
  std::int64_t dim(std::size_t i) const {
    return second_ ? at<std::int64_t>(16 + 8 * i) : at<std::int16_t>(40 + 2 * i);
  }
  double pixdim(std::size_t i) const { return second_ ? at<double>(104 + 8 * i) : at<float>(76 + 4 * i); }
  int datatype() const { return second_ ? at<std::int16_t>(12) : at<std::int16_t>(70); }
  double vox_offset() const { return second_ ? static_cast<double>(at<std::int64_t>(168)) : at<float>(108); }
  double slope() const { return second_ ? at<double>(176) : at<float>(112); }
  double intercept() const { return second_ ? at<double>(184) : at<float>(116); }
  int qform_code() const { return second_ ? at<std::int32_t>(344) : at<std::int16_t>(252); }
  int sform_code() const { return second_ ? at<std::int32_t>(348) : at<std::int16_t>(254); }
  /// b c d x y z
  double quaternion(std::size_t i) const {
    return second_ ? at<double>(352 + 8 * i) : at<float>(256 + 4 * i);
  }
  double srow(std::size_t row, std::size_t column) const {
    return second_ ? at<double>(400 + 8 * (4 * row + column)) : at<float>(280 + 4 * (4 * row + column));
  }
  int units() const { return second_ ? at<std::int32_t>(500) & 7 : std::to_integer<int>(bytes_[123]) & 7; }

 private:
  template <class Number>
  Number at(std::size_t offset) const {
    std::array<std::byte, sizeof(Number)> raw;
    std::memcpy(raw.data(), bytes_.data() + offset, sizeof(Number));
    if (swapped_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<Number>(raw);
  }

  std::span<const std::byte> bytes_;
  bool swapped_ = false, byte_order_swapped_ = false, second_ = false, single_file_ = false, valid_ = false;
};

std::optional<VoxelType> voxel_type(int datatype) {
  switch (datatype) {
    case 2:
      return VoxelType::u8;
    case 4:
      return VoxelType::i16;
    case 8:
      return VoxelType::i32;
    case 16:
      return VoxelType::f32;
    case 64:
      return VoxelType::f64;
    case 256:
      return VoxelType::i8;
    case 512:
      return VoxelType::u16;
    case 768:
      return VoxelType::u32;
    case 1024:
      return VoxelType::i64;
    case 1280:
      return VoxelType::u64;
    default:
      return std::nullopt;
  }
}

/// Method 2 of nifti1.h: a rotation from the quaternion, steps from pixdim, the third turned by qfac.
void set_from_quaternion(const Header& header, VoxelLattice& lattice) {
  const double b = header.quaternion(0), c = header.quaternion(1), d = header.quaternion(2);
  const double a = std::sqrt(std::max(0.0, 1 - b * b - c * c - d * d));
  const std::array<PlainPoint, 3> columns{
      PlainPoint{a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)},
      PlainPoint{2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)},
      PlainPoint{2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double turned = axis == 2 && header.pixdim(0) < 0 ? -1 : 1;
    for (std::size_t row = 0; row < 3; ++row)
      lattice.step_mm[axis][row] = columns[axis][row] * turned * std::abs(header.pixdim(axis + 1));
    lattice.origin_mm[axis] = header.quaternion(3 + axis);
  }
}

void set_from_affine(const Header& header, VoxelLattice& lattice) {
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t axis = 0; axis < 3; ++axis) lattice.step_mm[axis][row] = header.srow(row, axis);
    lattice.origin_mm[row] = header.srow(row, 3);
  }
}

double mm_per_unit(const Header& header) {
  return header.units() == 1 ? 1000 : header.units() == 3 ? 0.001 : 1;  // metres, micrometres
}

constexpr double kSame_mm = 0.1;  ///< forms that agree within this at the volume's corners are one

/// The most that a corner of the volume lies apart in two lattices of one size.
double apart(const VoxelLattice& a, const VoxelLattice& b) {
  double most = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    std::array<double, 3> index{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      index[axis] = (corner >> axis & 1U) != 0 ? a.size[axis] - 1 : 0;
    const PlainPoint p = place_of(a, index), q = place_of(b, index);
    most = std::max(most, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
  }
  return most;
}

std::string with_decimals(double number, int decimals) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, number);
  return text.data();
}

/// An affine may stretch: volumes and lengths then are those of the space it leads to, not the patient's.
void note_stretching(const Header& header, const VoxelLattice& lattice, std::vector<std::string>& notes) {
  std::string columns, voxels;
  bool stretched = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double column = step_length_mm(lattice, static_cast<int>(axis)),
                 voxel = std::abs(header.pixdim(axis + 1));
    stretched =
        stretched || !(std::abs(column - voxel) * mm_per_unit(header) * (lattice.size[axis] - 1) <= kSame_mm);
    columns += (axis > 0 ? " x " : "") + with_decimals(column * mm_per_unit(header), 3);
    voxels += (axis > 0 ? " x " : "") + with_decimals(voxel * mm_per_unit(header), 3);
  }
  if (stretched)
    notes.push_back("its sform makes voxels of " + columns + " mm out of those of " + voxels +
                    " mm that its pixdim states; lengths and volumes are the sform's");
}

/// Of two forms that disagree the one in the scanner's coordinates, the patient's own, and else the sform.
void place_by_forms(const Header& header, VoxelLattice& lattice, std::vector<std::string>& notes) {
  constexpr int kScanner = 1;
  const int sform = header.sform_code(), qform = header.qform_code();
  VoxelLattice by_quaternion = lattice;
  set_from_quaternion(header, by_quaternion);
  set_from_affine(header, lattice);
  const double apart_mm = sform > 0 && qform > 0 ? apart(lattice, by_quaternion) * mm_per_unit(header) : 0;
  const bool take_quaternion =
      sform <= 0 || (!(apart_mm <= kSame_mm) && qform == kScanner && sform != kScanner);
  if (!(apart_mm <= kSame_mm))
    notes.push_back("its qform (code " + std::to_string(qform) + ") and its sform (code " +
                    std::to_string(sform) + ") lie up to " + with_decimals(apart_mm, 1) + " mm apart; the " +
                    (take_quaternion ? "qform" : "sform") +
                    (qform == kScanner || sform == kScanner ? ", in the scanner's coordinates, was taken"
                                                            : " was taken, neither is the scanner's"));
  if (take_quaternion)
    lattice = by_quaternion;
  else
    note_stretching(header, lattice, notes);
  convert_to_lps(Space::ras, lattice);
}

Result<void> place(const VolumeSource& source, const Header& header, VoxelLattice& lattice,
                   std::vector<std::string>& notes) {
  if (header.sform_code() > 0 || header.qform_code() > 0) {
    place_by_forms(header, lattice, notes);
  } else {
    if (!source.where_unstated)
      return unstated_space(source.file.string(), "neither a qform nor an sform code");
    for (std::size_t axis = 0; axis < 3; ++axis)
      lattice.step_mm[axis][axis] = std::abs(header.pixdim(axis + 1));
    convert_to_lps(*source.where_unstated, lattice);
  }
  const double scale = mm_per_unit(header);
  for (std::size_t row = 0; row < 3; ++row) {
    lattice.origin_mm[row] *= scale;
    for (auto& step : lattice.step_mm) step[row] *= scale;
  }
  return {};
}

Result<void> check_dimensions(const std::string& name, const Header& header) {
  const std::int64_t count = header.dim(0);
  if (count < 1 || count > 7)
    return fail(name + ": says it has " + std::to_string(count) + " dimensions; a NIfTI of 3 is expected");
  for (std::int64_t axis = 4; axis <= count; ++axis) {
    const std::int64_t size = header.dim(static_cast<std::size_t>(axis));
    if (size > 1)
      return fail(name + ": has " + std::to_string(count) + " dimensions, " + std::to_string(size) +
                  " volumes in one file; one volume of 3 dimensions is accepted, so export one of them");
  }
  for (std::size_t axis = 1; axis <= 3; ++axis)
    if (count < 3 || header.dim(axis) < 1 || header.dim(axis) > 100'000)
      return fail(name + ": has no three dimensions of 1 to 100000 voxels; a volume is expected");
  return {};
}

}  // namespace

bool is_nifti(std::span<const std::byte> bytes) {
  return Header(bytes).valid();
}

Result<Volume> parse_nifti(const VolumeSource& source) {
  const Header header(source.bytes);
  const std::string name = source.file.string();
  if (auto sound = check_dimensions(name, header); !sound) return tl::unexpected(sound.error());
  const auto type = voxel_type(header.datatype());
  if (!type)
    return fail(name + ": has voxels of NIfTI type " + std::to_string(header.datatype()) +
                "; one integer or real intensity a voxel is accepted (no colour, no complex numbers)");
  constexpr double kLargestOffset = 1e12;
  if (!(header.vox_offset() <= kLargestOffset))
    return fail(name + ": says its voxels start at byte " + std::to_string(header.vox_offset()) +
                "; a place within the file is expected");
  Volume volume;
  for (std::size_t axis = 0; axis < 3; ++axis)
    volume.lattice.size[axis] = static_cast<int>(header.dim(axis + 1));
  if (auto placed = place(source, header, volume.lattice, volume.notes); !placed)
    return tl::unexpected(placed.error());
  if (auto sound = check_lattice(name, volume.lattice); !sound) return tl::unexpected(sound.error());
  const bool scaled = std::isfinite(header.slope()) && header.slope() != 0;
  const VoxelEncoding encoding{.type = *type,
                               .big_endian = header.big_endian(),
                               .slope = scaled ? header.slope() : 1,
                               .intercept = scaled ? header.intercept() : 0};
  volume.kind = std::string("NIfTI, ") + name_of(*type);
  const double offset = std::max(header.vox_offset(), 0.0);  // some write 0 for "right behind the header"
  if (header.single_file()) {
    const auto skip = std::max(static_cast<std::size_t>(offset), header.least_offset());
    if (auto taken =
            take_voxels(name, source.bytes.subspan(std::min(skip, source.bytes.size())), encoding, volume);
        !taken)
      return tl::unexpected(taken.error());
    return volume;
  }
  std::string voxels = source.file.filename().string();
  if (const auto dot = voxels.rfind(".hdr"); dot != std::string::npos) voxels.replace(dot, 4, ".img");
  const auto bytes = read_detached(name, {.folder = source.file.parent_path(),
                                          .names = {voxels},
                                          .skip_bytes = static_cast<std::int64_t>(offset),
                                          .bytes_each = volume.lattice.voxels() * bytes_of(*type)});
  if (!bytes) return tl::unexpected(bytes.error());
  if (auto taken = take_voxels(name, *bytes, encoding, volume); !taken) return tl::unexpected(taken.error());
  return volume;
}

}  // namespace orcart
