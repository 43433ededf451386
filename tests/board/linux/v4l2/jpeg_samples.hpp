// JPEG pictures made on the spot, as cameras send them and as they do not.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <vector>

#include <jpeglib.h>

namespace orcart::testing {

struct JpegSample {
  int width_px = 64, height_px = 48;
  int quality = 90;
  int chroma_h = 2, chroma_v = 1;  ///< 4:2:2, the usual of a USB camera
  bool progressive = false;
  unsigned restart_interval = 0;  ///< blocks between restart markers; 0: none
};

/// Red rises from left to right, green from top to bottom, blue is 64.
inline std::vector<std::byte> jpeg_ramp(const JpegSample& sample) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &bytes, &size);
  jpeg.image_width = static_cast<JDIMENSION>(sample.width_px);
  jpeg.image_height = static_cast<JDIMENSION>(sample.height_px);
  jpeg.input_components = 3;
  jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, sample.quality, TRUE);
  jpeg.comp_info[0].h_samp_factor = sample.chroma_h;
  jpeg.comp_info[0].v_samp_factor = sample.chroma_v;
  jpeg.restart_interval = sample.restart_interval;
  if (sample.progressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  std::vector<JSAMPLE> row(static_cast<std::size_t>(sample.width_px) * 3);
  for (int y = 0; y < sample.height_px; ++y) {
    for (int x = 0; x < sample.width_px; ++x) {
      JSAMPLE* pixel = row.data() + 3 * x;
      pixel[0] = static_cast<JSAMPLE>(x * 255 / sample.width_px);
      pixel[1] = static_cast<JSAMPLE>(y * 255 / sample.height_px);
      pixel[2] = 64;
    }
    JSAMPLE* pixels = row.data();
    (void)jpeg_write_scanlines(&jpeg, &pixels, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  const auto* begin = reinterpret_cast<const std::byte*>(bytes);
  std::vector<std::byte> picture(begin, begin + size);
  std::free(bytes);
  return picture;
}

}  // namespace orcart::testing
