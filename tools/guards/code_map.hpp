// Whose code an address belongs to: the program's own, the C and C++ runtime's, or another library's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace orcart::guards {

enum class Origin : std::uint8_t {
  program,    ///< the executable itself: our code
  runtime,    ///< libc, libstdc++, libgcc, the loader: it acts for whoever called it
  library,    ///< any other shared library: the GL driver, Embree, libusb
  generated,  ///< no file's: code a driver compiled at run time
};

struct Place {
  Origin origin = Origin::generated;
  std::uint16_t library = 0;  ///< an index for CodeMap::name_of where origin is library
};

/// The executable's segments as they were mapped at the last refresh().
class CodeMap {
 public:
  CodeMap() { refresh(); }
  /// After libraries were loaded. Allocates; not beside a reader.
  void refresh();
  /// Any thread; allocates nothing.
  Place of(const void* address) const noexcept;
  /// The innermost of `stack` (innermost first) that is not the runtime's; the program's where all are.
  Place blamed(std::span<void* const> stack) const noexcept;
  std::size_t libraries() const noexcept { return names_.size(); }
  std::string_view name_of(std::uint16_t library) const noexcept { return names_[library]; }

 private:
  struct Segment {
    std::uintptr_t from = 0, until = 0;
    Place place;
  };
  std::vector<Segment> segments_;  ///< sorted
  std::vector<std::string> names_;
};

/// One line a frame, innermost first: function and source line of the program's own code (by addr2line, where
/// it is installed), library and symbol of other code. The runtime's frames are left out. Slow; for reports.
std::string words_for(std::span<void* const> stack, std::size_t most_frames = 6);

}  // namespace orcart::guards
