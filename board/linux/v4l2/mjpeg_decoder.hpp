// One frame of motion JPEG into R G B A bytes, by libjpeg-turbo, in memory taken once.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "board/ports/port_fault.hpp"
#include "realtime/base/image.hpp"
#include "realtime/base/result.hpp"

namespace orcart {

/// One thread. After create() it allocates nothing: libjpeg's per-picture memory comes from an arena, and a
/// picture that wants more (a progressive one, say) is refused as damaged.
class MjpegDecoder {
 public:
  static Result<MjpegDecoder> create(int width_px, int height_px);
  struct State;
  MjpegDecoder(MjpegDecoder&&) noexcept;
  MjpegDecoder& operator=(MjpegDecoder&&) noexcept;
  ~MjpegDecoder();

  /// Fills `into`, rgba8888 in memory of the decoder's size. Any bytes are safe. `damaged` where they are no
  /// whole JPEG picture of that size: `into` then holds a mixture, to be thrown away. A missing Huffman table
  /// is the standard one, as motion JPEG has it.
  Result<void, PortFault> decode(std::span<const std::byte> jpeg, const ImageDescriptor& into) noexcept;

 private:
  explicit MjpegDecoder(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace orcart
