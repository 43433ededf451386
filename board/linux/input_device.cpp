// evdev: events carry the kernel's stamp on the clock that was asked for.
#include "board/linux/input_device.hpp"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <filesystem>

#include "board/linux/byte_stream.hpp"

namespace orcart {

Result<OpenDevice, int> open_input(DeviceCalls& calls, const std::string& node) noexcept {
  const int fd = calls.open(node.c_str(), O_RDONLY | O_NONBLOCK);
  if (fd < 0) return tl::unexpected(fd);
  return OpenDevice(calls, fd);
}

int take_over(const OpenDevice& device) noexcept {
  int clock = CLOCK_MONOTONIC;
  if (const int answer = device.control(EVIOCSCLOCKID, &clock); answer < 0) return answer;
  return std::min(0, device.control(EVIOCGRAB, reinterpret_cast<void*>(1)));
}

Result<std::size_t, PortFault> read_events(const OpenDevice& device, std::span<input_event> events) noexcept {
  const std::int64_t size = device.calls().read(device.fd(), events.data(), events.size_bytes());
  if (size == -EAGAIN || size == -EINTR) return tl::unexpected(PortFault::nothing_yet);
  if (size <= 0) return tl::unexpected(PortFault::disconnected);
  return static_cast<std::size_t>(size) / sizeof(input_event);
}

Instant stamp_of(const input_event& event) noexcept {
  return instant_from_nanos(std::int64_t{event.input_event_sec} * 1'000'000'000 +
                            std::int64_t{event.input_event_usec} * 1000);
}

std::string input_remedy(std::string_view what, PortFault fault) {
  switch (fault) {
    case PortFault::no_permission:
      return "; a user in the group input would be let in";
    case PortFault::busy:
      return "; end the program that grabbed it";
    case PortFault::disconnected:
      return "; plug the " + std::string(what) + " in, or name another device (orcart probe lists them)";
    default:
      return "; an input device of /dev/input/by-id would be accepted";
  }
}

std::string input_trouble(std::string_view what, const std::string& node, int error) {
  const PortFault fault = port_fault_of(-error);
  return std::string(what) + " " + node + " cannot be had: " + std::string(word_for(fault)) +
         input_remedy(what, fault);
}

std::vector<std::string> input_nodes() {
  std::vector<std::string> nodes;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/input", error))
    if (entry.path().filename().string().starts_with("event")) nodes.push_back(entry.path());
  std::ranges::sort(nodes);
  return nodes;
}

std::string input_name(const OpenDevice& device) {
  char name[128] = "";
  (void)device.control(EVIOCGNAME(sizeof name), name);
  return name;
}

}  // namespace orcart
