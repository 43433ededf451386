// Puts the bridge on the guest's own bus, runs a command beside it, and says what went over the bus.
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "tests/vm/ftdi_gadget.hpp"

namespace {

/// Until the kernel's own driver has taken it.
bool appears(const char* file, orcart::RealClock& clock) {
  using namespace std::chrono_literals;
  const orcart::Instant latest = clock.now() + 30s;
  while (!std::filesystem::exists(file) && clock.now() < latest) clock.sleep_until(clock.now() + 50ms);
  return std::filesystem::exists(file);
}

int run(char** command) {
  const pid_t child = fork();
  if (child == 0) {
    execvp(command[0], command);
    _exit(127);
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) < 0) return 1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: vm_ftdi_gadget COMMAND [ARGUMENTS...]\n");
    return 2;
  }
  auto gadget = orcart::testing::FtdiGadget::create();
  if (!gadget) {
    std::fprintf(stderr, "%s\n", gadget.error().message.c_str());
    return 1;
  }
  orcart::RealClock clock;
  if (!appears("/dev/ttyUSB0", clock)) {
    std::fprintf(stderr, "the kernel's ftdi_sio did not take the bridge within 30 s\n");
    return 1;
  }
  const int status = run(argv + 1);
  const auto idle = (*gadget)->idle_packets(), full = (*gadget)->full_packets();
  std::printf("bridge: %llu idle status packets, %llu with bytes, up to %u baud\n",
              static_cast<unsigned long long>(idle), static_cast<unsigned long long>(full),
              (*gadget)->highest_baud());
  if (status == 0 && (idle == 0 || full == 0)) {
    std::fprintf(stderr, "no idle packets, or no others: that is not the bridge that was wanted\n");
    return 1;
  }
  return status;
}
