// A painted sphere whose colour says where on it one looks: what viewers are asked to show.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "firmware-host/files/surface_file.hpp"
#include "firmware-host/files/textured_file.hpp"
#include "render/atlas/atlas_layout.hpp"
#include "tests/render/support/scenes.hpp"

namespace orcart::testing {

/// The six sides of a sphere: +x red, -x cyan, +y green, -y magenta, +z blue, -z yellow. Not about the
/// origin, so that a viewer that moves it is found out.
struct Globe {
  static inline const Eigen::Vector3d kCentre_mm{5, -3, 8};
  static constexpr double kRadius_mm = 20;

  /// Channels that are bright on the side that a direction points to.
  static std::array<bool, 3> side_of(const Eigen::Vector3d& direction) {
    Eigen::Index axis = 0;
    direction.cwiseAbs().maxCoeff(&axis);
    std::array<bool, 3> bright{};
    for (std::size_t c = 0; c < 3; ++c)
      bright[c] = (static_cast<Eigen::Index>(c) == axis) == (direction[axis] > 0);
    return bright;
  }
  /// Far enough from where two sides meet.
  static bool is_plain(const Eigen::Vector3d& direction) {
    std::array<double, 3> size{std::abs(direction.x()), std::abs(direction.y()), std::abs(direction.z())};
    std::sort(size.begin(), size.end());
    return size[1] < 0.85 * size[2];
  }
  /// Which channels of a shown colour are bright; nothing where it is dark or says neither.
  static std::optional<std::array<bool, 3>> bright_in(const std::array<int, 3>& rgb) {
    const int most = *std::max_element(rgb.begin(), rgb.end());
    if (most < 60) return std::nullopt;
    std::array<bool, 3> bright{};
    for (std::size_t c = 0; c < 3; ++c) {
      if (rgb[c] > 0.5 * most && rgb[c] < 0.7 * most) return std::nullopt;
      bright[c] = rgb[c] >= 0.7 * most;
    }
    return bright;
  }

  /// Writes NAME.obj, .ply and .glb with what comes beside them.
  static void write(const std::filesystem::path& folder) {
    const Surface surface =
        *make_surface(scenes::sphere(kCentre_mm.cast<float>(), kRadius_mm, 24).mesh, "globe");
    const AtlasLayout layout = *build_atlas(surface.mesh, {.texel_mm = 0.25});
    std::vector<std::uint8_t> rgba(layout.owners.size() * 4, 0);
    for (std::size_t i = 0; i < layout.owners.size(); ++i) {
      if (layout.owners[i].triangle == 0xFFFFFFFF) continue;
      const auto bright = side_of(scenes::point_of(surface, layout, i) - kCentre_mm);
      for (std::size_t c = 0; c < 3; ++c) rgba[4 * i + c] = bright[c] ? 235 : 25;
      rgba[4 * i + 3] = 255;
    }
    auto places = layout.corners_texels;
    for (auto& corners : places)
      for (Eigen::Vector2f& corner : corners)
        corner = {corner.x() / static_cast<float>(layout.width_texels),
                  1 - corner.y() / static_cast<float>(layout.height_texels)};
    for (const char* kind : {"obj", "ply", "glb"}) {
      const auto written =
          write_textured(folder / (std::string("globe.") + kind), {.surface = surface,
                                                                   .corners_uv = places,
                                                                   .width_texels = layout.width_texels,
                                                                   .height_texels = layout.height_texels,
                                                                   .rgba = rgba});
      if (!written) ADD_FAILURE() << written.error().message;
    }
  }
};

/// Millimetres, LPS, to the metres with +Y up that a GLB's viewer shows.
inline Eigen::Vector3d as_gltf(const Eigen::Vector3d& mm) {
  return Eigen::Vector3d(mm.x(), mm.z(), -mm.y()) / 1000;
}

/// A square picture of the globe, its middle in the middle.
struct GlobeView {
  Eigen::Vector3d from;  ///< unit, from the centre to the eye
  Eigen::Vector3d up;    ///< unit, square to it
  static constexpr double kDistance_mm = 120, kAngle_deg = 30;
  Eigen::Vector3d eye_mm() const { return Globe::kCentre_mm + kDistance_mm * from; }

  /// What a pixel's ray meets, as a direction from the globe's centre; nothing beside it or near its outline.
  std::optional<Eigen::Vector3d> seen_at(int x, int y, int size_px) const {
    const double half = std::tan(kAngle_deg * M_PI / 360);
    const Eigen::Vector3d side = up.cross(from);
    const Eigen::Vector3d ray =
        (-from + half * ((2 * (x + 0.5) / size_px - 1) * side + (1 - 2 * (y + 0.5) / size_px) * up))
            .normalized();
    const double along = kDistance_mm * from.dot(-ray), gap2 = kDistance_mm * kDistance_mm - along * along;
    if (gap2 > 0.8 * Globe::kRadius_mm * Globe::kRadius_mm) return std::nullopt;
    const double distance = along - std::sqrt(Globe::kRadius_mm * Globe::kRadius_mm - gap2);
    return (kDistance_mm * from + distance * ray).normalized();
  }
};

inline std::vector<GlobeView> globe_views() {
  const Eigen::Vector3d a = Eigen::Vector3d(1, -1.3, 0.6).normalized(),
                        b = Eigen::Vector3d(-1, 0.8, -0.7).normalized();
  const auto up_for = [](const Eigen::Vector3d& from) {
    return (Eigen::Vector3d::UnitZ() - from.z() * from).normalized();
  };
  return {{a, up_for(a)}, {b, up_for(b)}};
}

/// How many plain pixels show their side, and how many another or nothing. `rgb_at(x, y)`, row 0 on top.
struct Agreement {
  int right = 0, wrong = 0;
};
template <class RgbAt>
Agreement agreement(const GlobeView& view, int size_px, RgbAt rgb_at) {
  Agreement found;
  for (int y = 0; y < size_px; y += 3)
    for (int x = 0; x < size_px; x += 3) {
      const auto direction = view.seen_at(x, y, size_px);
      if (!direction || !Globe::is_plain(*direction)) continue;
      ++(Globe::bright_in(rgb_at(x, y)) == Globe::side_of(*direction) ? found.right : found.wrong);
    }
  return found;
}

}  // namespace orcart::testing
