// libpng and libjpeg-turbo behind one Result each; their long jumps stay inside this file.
#include "firmware-host/files/picture_file.hpp"

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>

#include <jpeglib.h>
#include <png.h>

namespace orcart {
namespace {

constexpr unsigned kMostPixelsASide = 16'384;
using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

std::string size_sentence(const std::filesystem::path& file, unsigned width, unsigned height) {
  return file.string() + " is " + std::to_string(width) + "x" + std::to_string(height) + " pixels; up to " +
         std::to_string(kMostPixelsASide) + " a side are accepted";
}

Result<Picture> read_png(const std::filesystem::path& file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&image, file.c_str()) == 0) {
    return fail(file.string() + " is no readable PNG (" + image.message + ")");
  }
  if (image.width > kMostPixelsASide || image.height > kMostPixelsASide) {
    png_image_free(&image);
    return fail(size_sentence(file, image.width, image.height));
  }
  image.format = PNG_FORMAT_RGBA;
  Picture picture;
  picture.width_px = static_cast<int>(image.width);
  picture.height_px = static_cast<int>(image.height);
  picture.rgba.resize(PNG_IMAGE_SIZE(image));
  if (png_image_finish_read(&image, nullptr, picture.rgba.data(), 0, nullptr) == 0) {
    return fail(file.string() + " is a damaged PNG (" + image.message + ")");
  }
  return picture;
}

struct JpegErrors {
  jpeg_error_mgr base;
  std::jmp_buf back;
  char message[JMSG_LENGTH_MAX];
};

void give_up(j_common_ptr info) {
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  info->err->format_message(info, errors->message);
  std::longjmp(errors->back, 1);
}

void keep_quiet(j_common_ptr, int) {}

/// Everything that a long jump could skip is outside: this function owns nothing with a destructor.
bool decode_jpeg(std::FILE* in, JpegErrors& errors, jpeg_decompress_struct& info, Picture& picture) {
  if (setjmp(errors.back) != 0) return false;
  jpeg_stdio_src(&info, in);
  jpeg_read_header(&info, TRUE);
  if (info.image_width > kMostPixelsASide || info.image_height > kMostPixelsASide) {
    std::snprintf(errors.message, sizeof errors.message, "larger than %u pixels a side", kMostPixelsASide);
    return false;
  }
  info.out_color_space = JCS_EXT_RGBA;
  jpeg_start_decompress(&info);
  picture.width_px = static_cast<int>(info.output_width);
  picture.height_px = static_cast<int>(info.output_height);
  const std::size_t row_bytes = static_cast<std::size_t>(info.output_width) * 4;
  picture.rgba.resize(row_bytes * info.output_height);
  while (info.output_scanline < info.output_height) {
    JSAMPROW row = picture.rgba.data() + row_bytes * info.output_scanline;
    jpeg_read_scanlines(&info, &row, 1);
  }
  jpeg_finish_decompress(&info);
  return true;
}

Result<Picture> read_jpeg(const std::filesystem::path& file, std::FILE* in) {
  JpegErrors errors{};
  jpeg_decompress_struct info{};
  info.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = give_up;
  errors.base.emit_message = keep_quiet;
  jpeg_create_decompress(&info);
  Picture picture;
  const bool decoded = decode_jpeg(in, errors, info, picture);
  jpeg_destroy_decompress(&info);
  if (!decoded) return fail(file.string() + " is no readable JPEG (" + errors.message + ")");
  return picture;
}

}  // namespace

ImageDescriptor Picture::descriptor() {
  return packed_image(reinterpret_cast<std::byte*>(rgba.data()), PixelFormat::rgba8888, width_px, height_px);
}

Result<Picture> read_picture(const std::filesystem::path& file) {
  const File in(std::fopen(file.c_str(), "rb"), std::fclose);
  if (!in) return fail(file.string() + " cannot be opened: " + std::strerror(errno));
  unsigned char start[8] = {};
  const std::size_t got = std::fread(start, 1, sizeof start, in.get());
  if (got >= 8 && png_sig_cmp(start, 0, 8) == 0) return read_png(file);
  if (got >= 3 && start[0] == 0xFF && start[1] == 0xD8 && start[2] == 0xFF) {
    std::rewind(in.get());
    return read_jpeg(file, in.get());
  }
  return fail(file.string() + " is neither PNG nor JPEG; one of them is accepted");
}

Result<void> write_png(const std::filesystem::path& file, int width_px, int height_px, std::span<const std::uint8_t> rgba,
                       Alpha alpha) {
  if (width_px <= 0 || height_px <= 0 ||
      rgba.size() != static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px) * 4) {
    return fail(file.string() + " is not written: the picture has no pixels, or not four bytes for each");
  }
  std::vector<std::uint8_t> rgb;
  if (alpha == Alpha::drop) {
    rgb.reserve(rgba.size() / 4 * 3);
    for (std::size_t i = 0; i < rgba.size(); i += 4) rgb.insert(rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width_px);
  image.height = static_cast<png_uint_32>(height_px);
  image.format = alpha == Alpha::drop ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  const std::filesystem::path beside = file.string() + ".part";
  const void* pixels = alpha == Alpha::drop ? rgb.data() : rgba.data();
  std::error_code error;
  if (png_image_write_to_file(&image, beside.c_str(), 0, pixels, 0, nullptr) == 0) {
    std::filesystem::remove(beside, error);
    return fail(file.string() + " cannot be written (" + image.message + ")");
  }
  std::filesystem::rename(beside, file, error);
  if (error) return fail(file.string() + " cannot be replaced: " + error.message());
  return {};
}

}  // namespace orcart
