// From linear light to the bytes a camera delivers: noise, tone, BT.601 and the packing into YUYV or NV12.
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "realtime/base/image.hpp"

namespace orcart {

/// Linear light 0..1 (more is clipped softly) to the displayed value 0..1: a shoulder from 0.7 on, then the
/// sRGB curve (IEC 61966-2-1). Below the shoulder it is the sRGB curve exactly.
float displayed(float linear);

/// Adds shot and read noise to linear light, in place; seeded by picture and pixel, so the same on any
/// thread.
void add_sensor_noise(std::span<Eigen::Vector3f> light, std::uint64_t picture);

/// Packs displayed values (red green blue, 0..1, width x height, row by row) as BT.601 limited range, chroma
/// sited left.
void pack_yuv(std::span<const Eigen::Vector3f> shown, const ImageDescriptor& image);

}  // namespace orcart
