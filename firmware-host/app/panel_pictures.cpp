// One copy a chosen instant.
#include "firmware-host/app/panel_pictures.hpp"

#include <cstring>

namespace orcart {
namespace {
std::size_t bytes_of(const PanelMode& mode) {
  return packed_bytes(PixelFormat::xrgb8888, mode.width_px, mode.height_px);
}
}  // namespace

PanelPictures::PanelPictures(const PanelMode& mode, std::vector<Instant> instants)
    : mode_(mode), instants_(std::move(instants)), pixels_(instants_.size() * bytes_of(mode), std::byte{0}) {}

void PanelPictures::flipped(const ShownPicture& now, const ShownPicture*) noexcept {
  if (next_ == instants_.size() || now.flip.at < instants_[next_]) return;
  std::byte* to = pixels_.data() + next_ * bytes_of(mode_);
  const ImagePlane& plane = now.image.planes[0];
  const auto row = static_cast<std::size_t>(mode_.width_px) * 4;
  for (int y = 0; y < mode_.height_px; ++y) {
    std::memcpy(to + static_cast<std::size_t>(y) * row,
                plane.data + plane.offset_bytes + static_cast<std::size_t>(y) * plane.stride_bytes, row);
  }
  ++next_;
}

std::vector<Picture> PanelPictures::kept() const {
  std::vector<Picture> pictures;
  for (std::size_t i = 0; i < next_; ++i) {
    Picture picture;
    picture.width_px = mode_.width_px;
    picture.height_px = mode_.height_px;
    picture.rgba.resize(bytes_of(mode_));
    const std::byte* from = pixels_.data() + i * bytes_of(mode_);
    for (std::size_t p = 0; p < picture.rgba.size(); p += 4) {
      picture.rgba[p] = static_cast<std::uint8_t>(from[p + 2]);
      picture.rgba[p + 1] = static_cast<std::uint8_t>(from[p + 1]);
      picture.rgba[p + 2] = static_cast<std::uint8_t>(from[p]);
      picture.rgba[p + 3] = 255;
    }
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

}  // namespace orcart
