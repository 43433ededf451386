// Pictures from memory.
#include "board/sim/picture_supply.hpp"

#include <algorithm>

namespace orcart {

bool MemoryPictures::read(std::uint64_t frame, std::span<std::byte> into) const noexcept {
  if (frame >= frame_count_ || pictures_.empty()) return false;
  const std::vector<std::byte>& picture = pictures_[frame % pictures_.size()];
  if (picture.size() != into.size()) return false;
  std::ranges::copy(picture, into.begin());
  return true;
}

}  // namespace orcart
