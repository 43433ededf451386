// .orcmovie: the pictures of a simulated procedure with their exposures and true poses, drawn before the run.
#pragma once

#include <filesystem>
#include <optional>

#include "board/sim/picture_supply.hpp"
#include "realtime/base/result.hpp"

namespace orcart {

/// What a movie shows. Two movies with the same header hold the same pictures. Written to disk as it is,
/// little-endian.
struct MovieHeader {
  std::array<char, 8> magic{'O', 'R', 'C', 'M', 'O', 'V', '0', '1'};
  std::int32_t width_px = 0, height_px = 0;
  PixelFormat format = PixelFormat::none;
  std::uint32_t frame_count = 0;
  double rate_hz = 0;
  std::int64_t exposure_ns = 0, first_ns = 0;
  std::uint64_t seed = 0;
  std::uint64_t content = 0;  ///< fingerprint of surface, scope, script and look
  friend bool operator==(const MovieHeader&, const MovieHeader&) = default;
};

/// One frame's record, before its pixels. Offsets count from the procedure's start.
struct MovieFrame {
  std::int64_t exposure_start_ns = 0, exposure_end_ns = 0;
  std::array<double, 12> X_MC{};  ///< true pose at mid-exposure, row-major 3x4, mm
};

/// A movie opened for reading. Frames are read with pread, so any thread may.
class MovieFile final : public PictureSupply {
 public:
  /// Refuses a file that is no movie, or shorter than its header says.
  static Result<MovieFile> open(const std::filesystem::path& file);
  MovieFile(MovieFile&& other) noexcept;
  MovieFile& operator=(MovieFile&&) = delete;
  ~MovieFile() override;

  const MovieHeader& header() const noexcept { return header_; }
  std::optional<MovieFrame> truth(std::uint64_t frame) const noexcept;

  FrameFormat format() const noexcept override;
  ExposureTiming timing() const noexcept override;
  std::uint64_t frame_count() const noexcept override { return header_.frame_count; }
  bool read(std::uint64_t frame, std::span<std::byte> into) const noexcept override;

 private:
  MovieFile(int descriptor, const MovieHeader& header) : descriptor_(descriptor), header_(header) {}
  int descriptor_;
  MovieHeader header_;
};

/// Writes a movie beside its place and puts it there when it is whole. put() may come from any thread, in any
/// order.
class MovieWriter {
 public:
  static Result<MovieWriter> create(const std::filesystem::path& file, const MovieHeader& header);
  MovieWriter(MovieWriter&& other) noexcept;
  MovieWriter& operator=(MovieWriter&&) = delete;
  ~MovieWriter();  ///< throws away what was not finished

  bool put(std::uint64_t frame, const MovieFrame& record, std::span<const std::byte> pixels) noexcept;
  Result<void> finish();

 private:
  MovieWriter(int descriptor, std::filesystem::path file, std::filesystem::path beside,
              const MovieHeader& header);
  int descriptor_;
  std::filesystem::path file_, beside_;
  MovieHeader header_;
};

}  // namespace orcart
