// Movie layout: header in the first page; then per frame a record, its pixels, and padding to a whole page.
#include "board/sim/movie_file.hpp"

#include <cerrno>
#include <cstring>
#include <system_error>
#include <type_traits>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace orcart {
namespace {

static_assert(std::is_trivially_copyable_v<MovieHeader> && std::is_trivially_copyable_v<MovieFrame>);
static_assert(sizeof(MovieHeader) == 64 && sizeof(MovieFrame) == 112,
              "the file has no padding inside its structures");

constexpr std::size_t kPage = 4096;

std::size_t pixel_bytes(const MovieHeader& header) {
  return packed_bytes(header.format, header.width_px, header.height_px);
}

off_t offset_of(const MovieHeader& header, std::uint64_t frame) {
  const std::size_t stride = (sizeof(MovieFrame) + pixel_bytes(header) + kPage - 1) / kPage * kPage;
  return static_cast<off_t>(kPage + frame * stride);
}

bool read_all(int descriptor, void* into, std::size_t bytes, off_t at) noexcept {
  return pread(descriptor, into, bytes, at) == static_cast<ssize_t>(bytes);
}

bool write_all(int descriptor, const void* from, std::size_t bytes, off_t at) noexcept {
  return pwrite(descriptor, from, bytes, at) == static_cast<ssize_t>(bytes);
}

bool plausible(const MovieHeader& header) {
  return header.magic == MovieHeader{}.magic && header.width_px > 0 && header.height_px > 0 &&
         header.width_px <= 8192 && header.height_px <= 8192 && header.rate_hz > 0 && pixel_bytes(header) > 0;
}

}  // namespace

Result<MovieFile> MovieFile::open(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return fail(file.string() + " cannot be opened: " + std::strerror(errno));
  MovieFile movie(descriptor, {});
  MovieHeader header;
  if (!read_all(descriptor, &header, sizeof(header), 0) || !plausible(header))
    return fail(file.string() + " is no orcart movie; delete it and it is drawn again");
  movie.header_ = header;
  struct stat status {};
  if (fstat(descriptor, &status) != 0 || status.st_size < offset_of(header, header.frame_count))
    return fail(file.string() + " is shorter than its " + std::to_string(header.frame_count) +
                " frames; delete it and it is drawn again");
  return movie;
}

MovieFile::MovieFile(MovieFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), header_(other.header_) {}

MovieFile::~MovieFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

std::optional<MovieFrame> MovieFile::truth(std::uint64_t frame) const noexcept {
  MovieFrame record;
  if (frame >= header_.frame_count ||
      !read_all(descriptor_, &record, sizeof(record), offset_of(header_, frame)))
    return std::nullopt;
  return record;
}

FrameFormat MovieFile::format() const noexcept {
  return {.width_px = header_.width_px,
          .height_px = header_.height_px,
          .format = header_.format,
          .rate_hz = header_.rate_hz};
}

ExposureTiming MovieFile::timing() const noexcept {
  return {
      .rate_hz = header_.rate_hz, .exposure = Nanos{header_.exposure_ns}, .first = Nanos{header_.first_ns}};
}

bool MovieFile::read(std::uint64_t frame, std::span<std::byte> into) const noexcept {
  if (frame >= header_.frame_count || into.size() != pixel_bytes(header_)) return false;
  return read_all(descriptor_, into.data(), into.size(),
                  offset_of(header_, frame) + static_cast<off_t>(sizeof(MovieFrame)));
}

Result<MovieWriter> MovieWriter::create(const std::filesystem::path& file, const MovieHeader& header) {
  std::error_code ignored;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  const std::filesystem::path beside = file.string() + ".part" + std::to_string(getpid());
  const int descriptor = ::open(beside.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor < 0) return fail(beside.string() + " cannot be written: " + std::strerror(errno));
  MovieWriter writer(descriptor, file, beside, header);
  const off_t size = offset_of(header, header.frame_count);
  if (const int error = posix_fallocate(descriptor, 0, size); error != 0)
    return fail(beside.string() + " needs " + std::to_string(size >> 20) + " MB: " + std::strerror(error));
  return writer;
}

MovieWriter::MovieWriter(int descriptor, std::filesystem::path file, std::filesystem::path beside,
                         const MovieHeader& header)
    : descriptor_(descriptor), file_(std::move(file)), beside_(std::move(beside)), header_(header) {}

MovieWriter::MovieWriter(MovieWriter&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      file_(std::move(other.file_)),
      beside_(std::move(other.beside_)),
      header_(other.header_) {}

MovieWriter::~MovieWriter() {
  if (descriptor_ < 0) return;
  close(descriptor_);
  unlink(beside_.c_str());
}

bool MovieWriter::put(std::uint64_t frame, const MovieFrame& record,
                      std::span<const std::byte> pixels) noexcept {
  const off_t at = offset_of(header_, frame);
  return frame < header_.frame_count && pixels.size() == pixel_bytes(header_) &&
         write_all(descriptor_, &record, sizeof(record), at) &&
         write_all(descriptor_, pixels.data(), pixels.size(), at + static_cast<off_t>(sizeof(record)));
}

Result<void> MovieWriter::finish() {
  std::error_code error;
  if (!write_all(descriptor_, &header_, sizeof(header_), 0))
    return fail(beside_.string() + " cannot be written: " + std::strerror(errno));
  std::filesystem::rename(beside_, file_, error);
  if (error) return fail(file_.string() + " could not be put in place: " + error.message());
  close(std::exchange(descriptor_, -1));
  return {};
}

}  // namespace orcart
