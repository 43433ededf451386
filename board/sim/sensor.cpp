// The simulated sensor: noise as light itself brings it, the display's curve, BT.601.
#include "board/sim/sensor.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "board/sim/lattice_noise.hpp"

namespace orcart {
namespace {

constexpr float kShoulder = 0.7F;
constexpr float kShotNoise = 0.010F;   ///< standard deviation at full light: about 10,000 electrons
constexpr float kReadNoise = 0.0015F;  ///< standard deviation in the dark

/// Nearly normal, mean 0, standard deviation 1: the sum of four bytes (Irwin-Hall).
float bell(std::uint32_t hash) {
  const auto sum = (hash & 255U) + ((hash >> 8) & 255U) + ((hash >> 16) & 255U) + (hash >> 24);
  return (static_cast<float>(sum) - 510.0F) / 147.8F;
}

struct Yuv {
  float y, u, v;
};

Yuv to_yuv(const Eigen::Vector3f& rgb) {
  return {16 + 65.481F * rgb.x() + 128.553F * rgb.y() + 24.966F * rgb.z(),
          128 - 37.797F * rgb.x() - 74.203F * rgb.y() + 112.0F * rgb.z(),
          128 + 112.0F * rgb.x() - 93.786F * rgb.y() - 18.214F * rgb.z()};
}

std::byte byte_of(float value) {
  return static_cast<std::byte>(std::clamp(static_cast<int>(value + 0.5F), 0, 255));
}

/// Chroma of the pixel pair that starts at even x: a 1-2-1 filter about the left pixel.
Yuv left_sited(std::span<const Eigen::Vector3f> row, std::size_t x) {
  const Eigen::Vector3f& left = row[x == 0 ? 0 : x - 1];
  return to_yuv(0.25F * left + 0.5F * row[x] + 0.25F * row[std::min(x + 1, row.size() - 1)]);
}

std::byte* row_of(const ImagePlane& plane, int row) {
  return plane.data + plane.offset_bytes + static_cast<std::size_t>(row) * plane.stride_bytes;
}

void pack_yuyv_row(std::span<const Eigen::Vector3f> row, std::byte* out) {
  for (std::size_t x = 0; x + 1 < row.size(); x += 2, out += 4) {
    const Yuv chroma = left_sited(row, x);
    out[0] = byte_of(to_yuv(row[x]).y);
    out[1] = byte_of(chroma.u);
    out[2] = byte_of(to_yuv(row[x + 1]).y);
    out[3] = byte_of(chroma.v);
  }
}

void pack_nv12_rows(std::span<const Eigen::Vector3f> top, std::span<const Eigen::Vector3f> bottom,
                    const ImageDescriptor& image, int y) {
  std::byte* luma[2] = {row_of(image.planes[0], y), row_of(image.planes[0], y + 1)};
  std::byte* chroma = row_of(image.planes[1], y / 2);
  for (std::size_t x = 0; x + 1 < top.size(); x += 2) {
    for (std::size_t i = x; i < x + 2; ++i) {
      luma[0][i] = byte_of(to_yuv(top[i]).y);
      luma[1][i] = byte_of(to_yuv(bottom[i]).y);
    }
    const Yuv above = left_sited(top, x), below = left_sited(bottom, x);
    chroma[x] = byte_of(0.5F * (above.u + below.u));
    chroma[x + 1] = byte_of(0.5F * (above.v + below.v));
  }
}

float tone(float linear) {
  // Above the shoulder the curve bends towards 1 with the slope it had: 1 - r exp(-(x - s) / r), r = 1 - s.
  constexpr float room = 1 - kShoulder;
  const float x =
      linear <= kShoulder ? std::max(linear, 0.0F) : 1 - room * std::exp(-(linear - kShoulder) / room);
  return x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1 / 2.4F) - 0.055F;
}

constexpr std::size_t kSteps = 8192;
constexpr float kBrightest = 3;  ///< beyond it the curve is white

std::array<float, kSteps + 2> tone_table() {
  std::array<float, kSteps + 2> table{};
  // Quadratic spacing: fine steps in the dark, where the curve is steep.
  for (std::size_t i = 0; i < table.size(); ++i) {
    const float root = static_cast<float>(i) / kSteps;
    table[i] = tone(kBrightest * root * root);
  }
  return table;
}

}  // namespace

float displayed(float linear) {
  static const auto table = tone_table();
  const float place = std::sqrt(std::clamp(linear / kBrightest, 0.0F, 1.0F)) * kSteps;
  const auto i = static_cast<std::size_t>(place);
  return table[i] + (place - static_cast<float>(i)) * (table[i + 1] - table[i]);
}

void add_sensor_noise(std::span<Eigen::Vector3f> light, std::uint64_t picture) {
  const std::uint32_t seed = hash32(static_cast<std::uint32_t>(picture) * 0x9e3779b9U + 1);
  for (std::size_t i = 0; i < light.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const float signal = std::max(light[i][c], 0.0F);
      const float deviation = std::sqrt(kShotNoise * kShotNoise * signal + kReadNoise * kReadNoise);
      light[i][c] =
          signal +
          deviation * bell(hash32(seed + 3 * static_cast<std::uint32_t>(i) + static_cast<std::uint32_t>(c)));
    }
}

void pack_yuv(std::span<const Eigen::Vector3f> shown, const ImageDescriptor& image) {
  const auto width = static_cast<std::size_t>(image.width_px);
  const auto row = [&](int y) { return shown.subspan(static_cast<std::size_t>(y) * width, width); };
  if (image.format == PixelFormat::yuyv)
    for (int y = 0; y < image.height_px; ++y) pack_yuyv_row(row(y), row_of(image.planes[0], y));
  if (image.format == PixelFormat::nv12)
    for (int y = 0; y + 1 < image.height_px; y += 2) pack_nv12_rows(row(y), row(y + 1), image, y);
}

}  // namespace orcart
