// An X server in memory for tests of windows, whose pixels can be read back from its frame-buffer file.
#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>
#include <csignal>

namespace orcart::testing {

/// Runs Xvfb with 640 x 480 pixels of 24 bits while it lives, and names it in DISPLAY.
class VirtualScreen {
 public:
  VirtualScreen()
      : folder_(std::filesystem::temp_directory_path() / ("orcart-screen-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    int told[2] = {-1, -1};
    if (pipe(told) != 0) return;
    server_ = fork();
    if (server_ == 0) become_server(told[1]);
    close(told[1]);
    if (const auto number = read_number(told[0])) display_ = ":" + *number;
    close(told[0]);
    if (!display_.empty()) setenv("DISPLAY", display_.c_str(), 1);
    setenv("SDL_VIDEODRIVER", "x11", 1);
  }
  ~VirtualScreen() {
    if (server_ > 0) {
      kill(server_, SIGTERM);
      waitpid(server_, nullptr, 0);
    }
    std::filesystem::remove_all(folder_);
  }
  VirtualScreen(const VirtualScreen&) = delete;
  VirtualScreen& operator=(const VirtualScreen&) = delete;

  bool runs() const { return !display_.empty(); }

  /// Red, green, blue of a pixel, from the XWD file that Xvfb keeps.
  std::array<int, 3> pixel(int x, int y) const {
    std::ifstream file(folder_ / "Xvfb_screen0", std::ios::binary);
    const auto word = [&](std::streamoff index) {  // big-endian, as XWD headers are
      std::array<unsigned char, 4> b{};
      file.seekg(4 * index);
      file.read(reinterpret_cast<char*>(b.data()), 4);
      return static_cast<std::streamoff>(b[0] << 24 | b[1] << 16 | b[2] << 8 | b[3]);
    };
    const std::streamoff header = word(0), line = word(12), colours = word(19);
    std::array<unsigned char, 4> bgrx{};
    file.seekg(header + 12 * colours + y * line + 4 * x);
    file.read(reinterpret_cast<char*>(bgrx.data()), 4);
    return {bgrx[2], bgrx[1], bgrx[0]};
  }

 private:
  [[noreturn]] void become_server(int tell) const {
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    dup2(nowhere, STDERR_FILENO);
    const std::string number = std::to_string(tell), folder = folder_.string();
    execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "640x480x24", "-fbdir",
           folder.c_str(), "-nolisten", "tcp", nullptr);
    _exit(127);
  }
  /// The display's number, once the server is up; nothing where it does not come within 20 s.
  static std::optional<std::string> read_number(int from) {
    std::string number;
    char digit = 0;
    pollfd waiting{.fd = from, .events = POLLIN, .revents = 0};
    while (poll(&waiting, 1, 20'000) > 0 && read(from, &digit, 1) == 1) {
      if (digit == '\n') return number;
      number += digit;
    }
    return std::nullopt;
  }

  std::filesystem::path folder_;
  std::string display_;
  pid_t server_ = -1;
};

}  // namespace orcart::testing
