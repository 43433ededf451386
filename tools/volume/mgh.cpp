// FreeSurfer's MGH and MGZ, which is the same gzipped ("FsTutorial/MghFormat", surfer.nmr.mgh.harvard.edu).
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "tools/volume/volume_formats.hpp"

namespace orcart {

namespace {

constexpr std::size_t kHeaderBytes = 284;
constexpr std::int32_t kMostSize = 100'000;

/// Numbers at their places, big endian.
template <class Number>
Number at(std::span<const std::byte> bytes, std::size_t offset) {
  std::array<std::byte, sizeof(Number)> raw;
  std::memcpy(raw.data(), bytes.data() + offset, sizeof(Number));
  if constexpr (std::endian::native == std::endian::little) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<Number>(raw);
}

std::int32_t size_at(std::span<const std::byte> bytes, std::size_t axis) {
  return at<std::int32_t>(bytes, 4 + 4 * axis);
}

std::optional<VoxelType> voxel_type(std::int32_t type) {
  switch (type) {
    case 0:
      return VoxelType::u8;
    case 1:
      return VoxelType::i32;
    case 3:
      return VoxelType::f32;
    case 4:
      return VoxelType::i16;
    case 10:
      return VoxelType::u16;
    default:
      return std::nullopt;
  }
}

/// The header gives the directions of the axes and the place of the middle, RAS.
Result<void> place(const VolumeSource& source, VoxelLattice& lattice) {
  constexpr std::size_t kFlag = 28, kSpacing = 30, kAxes = 42, kMiddle = 78;
  const bool stated = at<std::int16_t>(source.bytes, kFlag) > 0;
  if (!stated && !source.where_unstated)
    return unstated_space(source.file.string(), "its goodRASFlag is not set");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double spacing = at<float>(source.bytes, kSpacing + 4 * axis);
    if (!stated) lattice.step_mm[axis][axis] = spacing;
    for (std::size_t row = 0; row < 3 && stated; ++row)
      lattice.step_mm[axis][row] = spacing * at<float>(source.bytes, kAxes + 12 * axis + 4 * row);
  }
  for (std::size_t row = 0; row < 3 && stated; ++row) {
    lattice.origin_mm[row] = at<float>(source.bytes, kMiddle + 4 * row);
    for (std::size_t axis = 0; axis < 3; ++axis)
      lattice.origin_mm[row] -= lattice.step_mm[axis][row] * lattice.size[axis] / 2.0;
  }
  convert_to_lps(stated ? Space::ras : *source.where_unstated, lattice);
  return {};
}

}  // namespace

bool is_mgh(std::span<const std::byte> bytes) {
  if (bytes.size() < kHeaderBytes || at<std::int32_t>(bytes, 0) != 1) return false;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (size_at(bytes, axis) < 1 || size_at(bytes, axis) > kMostSize) return false;
  return size_at(bytes, 3) >= 1;
}

Result<Volume> parse_mgh(const VolumeSource& source) {
  const std::string name = source.file.string();
  const auto type = voxel_type(at<std::int32_t>(source.bytes, 20));
  if (!type)
    return fail(name + ": has voxels of MGH type " + std::to_string(at<std::int32_t>(source.bytes, 20)) +
                "; uchar, short, ushort, int and float are accepted");
  if (size_at(source.bytes, 3) > 1)
    return fail(name + ": has " + std::to_string(size_at(source.bytes, 3)) +
                " volumes in one file; one is accepted, so export one of them");
  Volume volume;
  for (std::size_t axis = 0; axis < 3; ++axis) volume.lattice.size[axis] = size_at(source.bytes, axis);
  if (auto placed = place(source, volume.lattice); !placed) return tl::unexpected(placed.error());
  if (auto sound = check_lattice(name, volume.lattice); !sound) return tl::unexpected(sound.error());
  volume.kind = std::string("MGH, ") + name_of(*type);
  const VoxelEncoding encoding{.type = *type, .big_endian = true};
  if (auto taken = take_voxels(name, source.bytes.subspan(kHeaderBytes), encoding, volume); !taken)
    return tl::unexpected(taken.error());
  return volume;
}

}  // namespace orcart
