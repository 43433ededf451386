// What a camera offers and what is wanted of it, compared without a device: formats, sizes, rates.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "realtime/base/image.hpp"
#include "realtime/base/result.hpp"

namespace orcart {

/// How pixels travel from the device. MJPEG is decoded into rgba8888, the others are handed on as they come.
enum class WireFormat : std::uint32_t {
  yuyv = fourcc('Y', 'U', 'Y', 'V'),
  uyvy = fourcc('U', 'Y', 'V', 'Y'),
  nv12 = fourcc('N', 'V', '1', '2'),
  mjpeg = fourcc('M', 'J', 'P', 'G'),
};

/// As cart.toml spells it.
std::string_view name_of(WireFormat format);
/// The same for any code: four letters where they can be printed.
std::string name_of_code(std::uint32_t code);
/// What the cart's pictures are in, where the wire carries `format`.
PixelFormat picture_format(WireFormat format);

/// Inclusive; a single value where min = max.
struct SizeRange {
  int min_px = 0, max_px = 0, step_px = 1;
  /// A device that does not tell its size (max 0) may have any.
  bool holds(int px) const {
    return max_px == 0 || (px >= min_px && px <= max_px && (px - min_px) % step_px == 0);
  }
};
struct RateRange {
  double min_hz = 0, max_hz = 0;
};

/// One format and size (or range of sizes) with its rates; no rates where the device does not tell them.
struct CameraMode {
  std::uint32_t wire_code = 0;
  SizeRange width, height;
  std::vector<RateRange> rates;
};

struct CameraOffer {
  std::string card;  ///< the device's own name
  std::vector<CameraMode> modes;
};

/// Which lines of the picture are taken. An interlaced picture holds two instants; one field holds one.
enum class FieldChoice : std::uint8_t { progressive, top, bottom };

struct CameraWish {
  std::string device = "/dev/video0";
  WireFormat format = WireFormat::yuyv;
  int width_px = 640, height_px = 480;  ///< of what the cart gets: of a field, half the device's lines
  double rate_hz = 30;                  ///< of frames, not fields
  FieldChoice field = FieldChoice::progressive;
  struct Control {
    std::string name;  ///< as `orcart probe` lists it, e.g. "exposure_time_absolute"
    std::int64_t value = 0;
  };
  std::vector<Control> controls;
};

/// Refuses a wish that no mode can meet, in one sentence that lists what could be had instead: the sizes of
/// the wanted format, the rates of the wanted size. A device that lists nothing is asked and not judged.
Result<void> check(const CameraWish& wish, const CameraOffer& offer);

/// "640x480 at 25, 30 Hz"; of a range "32x32 to 1920x1080".
std::string text_of(const CameraMode& mode);

/// Rates that differ by less than this share are one rate: 29.97 is not 30, 30.0003 is.
inline constexpr double kRateTolerance = 0.0005;

}  // namespace orcart
