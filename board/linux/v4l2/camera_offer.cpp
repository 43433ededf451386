// Sentences and comparisons; no device.
#include "board/linux/v4l2/camera_offer.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <set>

namespace orcart {
namespace {

struct Named {
  WireFormat format;
  std::string_view name;
};
constexpr std::array<Named, 4> kNames{{{WireFormat::yuyv, "yuyv"},
                                       {WireFormat::uyvy, "uyvy"},
                                       {WireFormat::nv12, "nv12"},
                                       {WireFormat::mjpeg, "mjpeg"}}};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string size_of(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

bool same_rate(double a, double b) {
  return std::abs(a - b) <= kRateTolerance * b;
}

bool has_rate(const CameraMode& mode, double rate_hz) {
  if (mode.rates.empty()) return true;
  return std::ranges::any_of(mode.rates, [&](const RateRange& range) {
    return same_rate(range.min_hz, rate_hz) || same_rate(range.max_hz, rate_hz) ||
           (range.min_hz <= rate_hz && rate_hz <= range.max_hz);
  });
}

std::string rates_of(const CameraMode& mode) {
  std::string text;
  for (const RateRange& range : mode.rates) {
    text += text.empty() ? "" : ", ";
    text += number(range.min_hz);
    if (!same_rate(range.min_hz, range.max_hz)) text += " to " + number(range.max_hz);
  }
  return text + " Hz";
}

std::string joined(const std::set<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

std::string sizes_of(const CameraMode& mode) {
  if (mode.width.max_px == 0) return "the size of its signal";
  const std::string least = size_of(mode.width.min_px, mode.height.min_px);
  const std::string most = size_of(mode.width.max_px, mode.height.max_px);
  return least == most ? least : least + " to " + most;
}

std::string prefix(const CameraWish& wish, const CameraOffer& offer) {
  return "camera " + wish.device + (offer.card.empty() ? "" : " (" + offer.card + ")");
}

}  // namespace

std::string_view name_of(WireFormat format) {
  for (const Named& named : kNames)
    if (named.format == format) return named.name;
  return "none";
}

std::string name_of_code(std::uint32_t code) {
  for (const Named& named : kNames)
    if (static_cast<std::uint32_t>(named.format) == code) return std::string(named.name);
  std::string text;
  for (int shift = 0; shift < 32; shift += 8) {
    const auto letter = static_cast<unsigned char>(code >> shift & 0xFFu);
    text += std::isprint(letter) != 0 ? static_cast<char>(letter) : '?';
  }
  return text;
}

PixelFormat picture_format(WireFormat format) {
  switch (format) {
    case WireFormat::yuyv:
      return PixelFormat::yuyv;
    case WireFormat::uyvy:
      return PixelFormat::uyvy;
    case WireFormat::nv12:
      return PixelFormat::nv12;
    case WireFormat::mjpeg:
      return PixelFormat::rgba8888;
  }
  return PixelFormat::none;
}

std::string text_of(const CameraMode& mode) {
  return sizes_of(mode) + (mode.rates.empty() ? "" : " at " + rates_of(mode));
}

Result<void> check(const CameraWish& wish, const CameraOffer& offer) {
  if (offer.modes.empty()) return {};
  const auto code = static_cast<std::uint32_t>(wish.format);
  std::set<std::string> formats, sizes, rates;
  const int height = wish.field == FieldChoice::progressive ? wish.height_px : 2 * wish.height_px;
  bool known_format = false, known_size = false;
  for (const CameraMode& mode : offer.modes) {
    formats.insert(name_of_code(mode.wire_code));
    if (mode.wire_code != code) continue;
    known_format = true;
    sizes.insert(sizes_of(mode));
    if (!mode.width.holds(wish.width_px) || !mode.height.holds(height)) continue;
    known_size = true;
    rates.insert(rates_of(mode));
    if (has_rate(mode, wish.rate_hz)) return {};
  }
  const std::string format(name_of(wish.format)), size = size_of(wish.width_px, height);
  if (!known_format)
    return fail(prefix(wish, offer) + " does not deliver " + format + "; it offers " + joined(formats));
  if (!known_size)
    return fail(prefix(wish, offer) + " does not deliver " + format + " in " + size + "; it offers " +
                joined(sizes));
  return fail(prefix(wish, offer) + " does not deliver " + format + " in " + size + " at " +
              number(wish.rate_hz) + " Hz; it offers " + joined(rates));
}

}  // namespace orcart
