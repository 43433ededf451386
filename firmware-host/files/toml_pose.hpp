// Reads a rigid transform from TOML: re-orthonormalised and told up to a deviation of 0.01, refused beyond.
#pragma once

#include <cstdio>
#include <optional>
#include <string>

#include "firmware-host/files/toml_reader.hpp"
#include "realtime/geometry/pose.hpp"

namespace orcart {

/// X_AB as a row-major 3x4 matrix (12 numbers, or 16 ending in 0 0 0 1), millimetres. Reflections are
/// refused.
template <class A, class B>
Pose<A, B> pose_from_toml(const TomlSection& section, std::string_view key,
                          std::optional<Pose<A, B>> fallback = std::nullopt) {
  constexpr double kLargestDeviation = 0.01, kWorthTelling = 1e-6;
  if (fallback && !section.has(key)) {
    section.matrix_3x4(key, std::array<double, 12>{});  // makes the key known
    return *fallback;
  }
  const auto m = section.matrix_3x4(key);
  Eigen::Matrix3d given;
  given << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
  const NearestRotation nearest = nearest_rotation(given);
  std::array<char, 32> deviation{};
  std::snprintf(deviation.data(), deviation.size(), "%.2g", nearest.deviation);
  const std::string off = std::string(" differs by ") + deviation.data() + " from a rotation";
  if (nearest.reflected)
    section.refuse(key, "holds a reflection; a rotation is accepted");
  else if (!(nearest.deviation <= kLargestDeviation))
    section.refuse(key, off.substr(1) + "; up to 0.01 is accepted");
  else if (nearest.deviation > kWorthTelling)
    section.note(key, off.substr(1) + " and was made one");
  return {.rotation = nearest.rotation, .translation_mm = Eigen::Vector3d(m[3], m[7], m[11])};
}

}  // namespace orcart
