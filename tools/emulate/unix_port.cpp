// A socket in the file system as the emulated tracker's line: a virtual machine's serial port connects to it.
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "tools/emulate/listening_port.hpp"

namespace orcart {
namespace {

/// What an emulator that was killed left behind would keep the next one from listening.
void remove_dead_socket(const std::string& file) {
  struct stat found {};
  if (::lstat(file.c_str(), &found) == 0 && S_ISSOCK(found.st_mode)) ::unlink(file.c_str());
}

Result<FileDescriptor> listen_at(const std::string& file) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (file.empty() || file.size() >= sizeof address.sun_path) {
    return fail("socket \"" + file + "\" cannot be made: a path of 1 to " +
                std::to_string(sizeof address.sun_path - 1) + " bytes would be accepted");
  }
  std::memcpy(address.sun_path, file.data(), file.size());
  remove_dead_socket(file);
  FileDescriptor listener(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const bool listening = ::bind(listener.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) == 0 &&
                         ::listen(listener.get(), 1) == 0;
  if (!listening) {
    return fail("socket " + file + " cannot be listened on: " + std::strerror(errno) +
                "; a free name in a folder that may be written would be accepted");
  }
  return listener;
}

}  // namespace

Result<std::unique_ptr<EmulatorPort>> open_unix_port(const std::string& file) {
  auto listener = listen_at(file);
  if (!listener) return tl::unexpected(listener.error());
  return std::make_unique<ListeningPort>(std::move(*listener), file, [file] { return listen_at(file); });
}

}  // namespace orcart
