// libpng and libjpeg-turbo behind one Result each; their long jumps stay inside this file.
#include "firmware-host/files/picture_file.hpp"

#include <array>
#include <csetjmp>
#include <cstdio>
#include <string>

#include <jpeglib.h>

#include <jerror.h>
#include <png.h>

#include "firmware-host/files/whole_file.hpp"

namespace orcart {
namespace {

constexpr unsigned kMostPixelsASide = 16'384;
constexpr std::uintmax_t kLargestFileBytes = 512U << 20U;

using Bytes = std::span<const std::byte>;

std::string size_sentence(const std::filesystem::path& file, unsigned width, unsigned height) {
  return file.string() + " is " + std::to_string(width) + "x" + std::to_string(height) + " pixels; up to " +
         std::to_string(kMostPixelsASide) + " a side are accepted";
}

bool too_large(unsigned width, unsigned height) {
  return width > kMostPixelsASide || height > kMostPixelsASide;
}

/// Room for a picture of this size; rows are packed.
Picture blank_picture(unsigned width, unsigned height) {
  Picture picture{.width_px = static_cast<int>(width), .height_px = static_cast<int>(height)};
  picture.rgba.resize(std::size_t{width} * height * 4);
  return picture;
}

Result<Picture> read_png(const std::filesystem::path& file, Bytes bytes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0)
    return fail(file.string() + " is no readable PNG (" + image.message + ")");
  if (too_large(image.width, image.height)) {
    const unsigned width = image.width, height = image.height;
    png_image_free(&image);
    return fail(size_sentence(file, width, height));
  }
  image.format = PNG_FORMAT_RGBA;
  image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;  // else 16 bits without a gAMA chunk are taken as linear light
  Picture picture = blank_picture(image.width, image.height);
  if (png_image_finish_read(&image, nullptr, picture.rgba.data(), 0, nullptr) == 0)
    return fail(file.string() + " is a damaged PNG (" + image.message + ")");
  return picture;
}

struct JpegErrors {
  jpeg_error_mgr base;  ///< first, so that a pointer to it is one to this
  std::jmp_buf back;
  std::array<char, JMSG_LENGTH_MAX> message;
};

[[noreturn]] void give_up(j_common_ptr info) {
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  info->err->format_message(info, errors->message.data());
  std::longjmp(errors->back, 1);
}

/// libjpeg calls missing or wrong pixels a warning and fills in grey; a painting must not show that. What
/// costs no pixel is passed over in silence.
void judge_warning(j_common_ptr info, int level) {
  const int code = info->err->msg_code;
  const bool damaged = code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER || code == JWRN_HUFF_BAD_CODE ||
                       code == JWRN_MUST_RESYNC;
  if (level < 0 && damaged) give_up(info);
}

/// A long jump passes over this function's end: it owns nothing with a destructor.
bool decode_jpeg(Bytes bytes, JpegErrors& errors, jpeg_decompress_struct& info, Picture& picture) {
  if (setjmp(errors.back) != 0) return false;
  jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&info, TRUE);
  if (too_large(info.image_width, info.image_height)) {
    std::snprintf(errors.message.data(), errors.message.size(), "larger than %u pixels a side",
                  kMostPixelsASide);
    return false;
  }
  info.out_color_space = JCS_EXT_RGBA;
  jpeg_start_decompress(&info);
  picture = blank_picture(info.output_width, info.output_height);
  const std::size_t row_bytes = std::size_t{info.output_width} * 4;
  while (info.output_scanline < info.output_height) {
    JSAMPROW row = picture.rgba.data() + row_bytes * info.output_scanline;
    jpeg_read_scanlines(&info, &row, 1);
  }
  jpeg_finish_decompress(&info);
  return true;
}

Result<Picture> read_jpeg(const std::filesystem::path& file, Bytes bytes) {
  JpegErrors errors{};
  jpeg_decompress_struct info{};
  info.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = give_up;
  errors.base.emit_message = judge_warning;
  jpeg_create_decompress(&info);
  Picture picture;
  const bool decoded = decode_jpeg(bytes, errors, info, picture);
  jpeg_destroy_decompress(&info);
  if (!decoded) return fail(file.string() + " is no readable JPEG (" + errors.message.data() + ")");
  return picture;
}

std::vector<std::uint8_t> without_alpha(std::span<const std::uint8_t> rgba) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(rgba.size() / 4 * 3);
  for (std::size_t i = 0; i < rgba.size(); i += 4) rgb.insert(rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
  return rgb;
}

}  // namespace

ImageDescriptor Picture::descriptor() {
  return packed_image(reinterpret_cast<std::byte*>(rgba.data()), PixelFormat::rgba8888, width_px, height_px);
}

Result<Picture> read_picture(const std::filesystem::path& file) {
  const auto bytes = read_whole_file(file, kLargestFileBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  const auto* start = reinterpret_cast<const unsigned char*>(bytes->data());
  if (bytes->size() >= 8 && png_sig_cmp(start, 0, 8) == 0) return read_png(file, *bytes);
  if (bytes->size() >= 3 && start[0] == 0xFF && start[1] == 0xD8 && start[2] == 0xFF)
    return read_jpeg(file, *bytes);
  return fail(file.string() + " is neither PNG nor JPEG; one of them is accepted");
}

Result<void> write_png(const std::filesystem::path& file, int width_px, int height_px,
                       std::span<const std::uint8_t> rgba, Alpha alpha) {
  if (width_px <= 0 || height_px <= 0 ||
      rgba.size() != static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px) * 4)
    return fail(file.string() + " is not written: the picture has no pixels, or not four bytes for each");
  const std::vector<std::uint8_t> rgb =
      alpha == Alpha::drop ? without_alpha(rgba) : std::vector<std::uint8_t>{};
  const void* pixels = alpha == Alpha::drop ? rgb.data() : rgba.data();
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width_px);
  image.height = static_cast<png_uint_32>(height_px);
  image.format = alpha == Alpha::drop ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<std::byte> bytes(size);
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels, 0, nullptr) == 0)
    return fail(file.string() + " cannot be written (" + image.message + ")");
  bytes.resize(size);
  return write_whole_file(file, bytes);
}

}  // namespace orcart
