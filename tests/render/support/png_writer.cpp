// Keeps a test's picture for a person to look at.
#include <cstdlib>

#include <png.h>

#include "tests/render/support/offscreen.hpp"

namespace orcart::testing {

void keep_picture(const Pixels& pixels, const std::string& name) {
  const char* folder = std::getenv("ORCART_PICTURES");
  if (folder == nullptr) return;
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(pixels.width_px);
  image.height = static_cast<png_uint_32>(pixels.height_px);
  image.format = PNG_FORMAT_RGBA;
  const std::string path = std::string(folder) + "/" + name + ".png";
  png_image_write_to_file(&image, path.c_str(), 0, pixels.rgba.data(), 0, nullptr);
}

}  // namespace orcart::testing
