// From the bytes of a volume file to intensities.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "realtime/base/result.hpp"

namespace orcart {

enum class VoxelType : std::uint8_t { u8, i8, u16, i16, u32, i32, u64, i64, f32, f64 };
std::size_t bytes_of(VoxelType type);
const char* name_of(VoxelType type);

struct VoxelEncoding {
  VoxelType type = VoxelType::u8;
  bool big_endian = false;
  double slope = 1, intercept = 0;  ///< intensity = slope * number + intercept
};

/// Appends bytes.size() / bytes_of(type) intensities.
void append_numbers(std::span<const std::byte> bytes, const VoxelEncoding& encoding,
                    std::vector<float>& values);

/// What a volume file may hold at most.
inline constexpr std::uint64_t kMostVolumeBytes = std::uint64_t{8} << 30U;
inline constexpr std::uint64_t kMostVoxels = 1'000'000'000;

/// gzip or zlib, told apart by the stream itself; at most `enough` bytes come out. What comes before damage
/// is given: the caller sees that it is short.
std::vector<std::byte> inflate(std::span<const std::byte> packed, std::uint64_t enough);
bool is_gzip(std::span<const std::byte> bytes);

/// A file in memory; a gzipped one is unpacked.
Result<std::vector<std::byte>> read_plain(const std::filesystem::path& file);

}  // namespace orcart
