// Whole files through POSIX calls, so that an error can say what the system said.
#include "firmware-host/files/whole_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace orcart {

namespace {

/// Owns a file descriptor for the length of a call.
struct OpenFile {
  int fd;
  ~OpenFile() {
    if (fd >= 0) ::close(fd);
  }
};

tl::unexpected<Error> system_failure(const std::filesystem::path& file, const char* what) {
  return fail(file.string() + ": " + what + ": " + std::strerror(errno));
}

bool write_all(int fd, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

/// A device or a pipe takes the bytes as it is. One that nobody reads is refused, where opening it would
/// wait.
Result<void> write_into(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  const OpenFile open{::open(file.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)};
  if (open.fd < 0 && errno == ENXIO) return fail(file.string() + ": cannot be written: nobody reads it");
  if (open.fd < 0) return system_failure(file, "cannot be written");
  ::fcntl(open.fd, F_SETFL, ::fcntl(open.fd, F_GETFL) & ~O_NONBLOCK);
  if (!write_all(open.fd, bytes)) return system_failure(file, "cannot be written");
  return {};
}

}  // namespace

Result<std::vector<std::byte>> read_whole_file(const std::filesystem::path& file,
                                               std::uintmax_t largest_bytes) {
  const OpenFile open{::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  struct stat status {};
  if (open.fd < 0 || ::fstat(open.fd, &status) != 0) return system_failure(file, "cannot be read");
  if (!S_ISREG(status.st_mode)) return fail(file.string() + ": is not a regular file; a file is expected");
  const auto size = static_cast<std::uintmax_t>(status.st_size);
  if (size > largest_bytes)
    return fail(file.string() + ": is " + std::to_string(size) + " bytes long; up to " +
                std::to_string(largest_bytes) + " are accepted");
  std::vector<std::byte> bytes(size);
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t got = ::read(open.fd, bytes.data() + filled, bytes.size() - filled);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return system_failure(file, "cannot be read");
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
  }
  bytes.resize(filled);
  return bytes;
}

std::filesystem::path behind_links(const std::filesystem::path& file) {
  constexpr int kMostLinks = 40;  // as Linux follows
  std::filesystem::path place = file;
  for (int link = 0; link < kMostLinks; ++link) {
    std::error_code no_link;
    const std::filesystem::path next = std::filesystem::read_symlink(place, no_link);
    if (no_link) break;
    place = place.parent_path() / next;
  }
  return place;
}

Result<void> write_whole_file(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  struct stat status {};
  const bool there = ::stat(file.c_str(), &status) == 0;
  if (there && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)) return write_into(file, bytes);
  const std::filesystem::path target = behind_links(file);
  std::filesystem::path beside = target;
  beside.replace_filename("." + target.filename().string() + ".part-" + std::to_string(::getpid()));
  bool written = false;
  {
    const OpenFile open{::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)};
    if (open.fd < 0) return system_failure(file, "cannot be written");
    written = write_all(open.fd, bytes) && ::fsync(open.fd) == 0;
  }
  if (written && ::rename(beside.c_str(), target.c_str()) == 0) return {};
  const auto failure = system_failure(file, "cannot be written");
  ::unlink(beside.c_str());
  return failure;
}

Result<void> write_whole_file(const std::filesystem::path& file, std::string_view text) {
  return write_whole_file(file, std::as_bytes(std::span(text.data(), text.size())));
}

}  // namespace orcart
