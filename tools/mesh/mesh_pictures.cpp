// One ray a pixel, four for an even edge.
#include "tools/mesh/mesh_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

#include <Eigen/Geometry>

namespace orcart {

namespace {

using Eigen::Vector3f;

class Drawing {
 public:
  Drawing(const TriangleMesh& mesh, const RayScene& rays, const MeshView& view, const MeshColour& colour)
      : mesh_(mesh), rays_(rays), view_(view), colour_(colour) {
    Vector3f low = mesh.vertices_mm.front(), high = low;
    for (const Vector3f& v : mesh.vertices_mm) {
      low = low.cwiseMin(v);
      high = high.cwiseMax(v);
    }
    const Vector3f towards = view.from.normalized();
    right_ = view.up.cross(towards).normalized();
    up_ = towards.cross(right_);
    into_ = -towards;
    centre_ = (low + high) / 2;
    reach_mm_ = (high - low).norm();
    float across = 0, along = 0;
    for (const Vector3f& v : mesh.vertices_mm) {
      across = std::max(across, std::abs(right_.dot(v - centre_)));
      along = std::max(along, std::abs(up_.dot(v - centre_)));
    }
    mm_a_pixel_ = 2.08F * std::max(across / static_cast<float>(view.width_px),
                                   along / static_cast<float>(view.height_px));
  }

  void row(int y, std::uint8_t* rgba) const {
    constexpr int kSamples = 2;
    for (int x = 0; x < view_.width_px; ++x, rgba += 4) {
      Vector3f sum = Vector3f::Zero();
      for (int s = 0; s < kSamples * kSamples; ++s)
        sum += sample(static_cast<float>(x) + (static_cast<float>(s % kSamples) + 0.5F) / kSamples,
                      static_cast<float>(y) + (static_cast<float>(s / kSamples) + 0.5F) / kSamples);
      for (int c = 0; c < 3; ++c)
        rgba[c] = static_cast<std::uint8_t>(255 * std::clamp(sum[c] / (kSamples * kSamples), 0.0F, 1.0F));
      rgba[3] = 255;
    }
  }

 private:
  Vector3f normal_of(std::uint32_t triangle) const {
    const auto& t = mesh_.triangles[triangle];
    const Vector3f a = mesh_.vertices_mm[t[0]];
    return (mesh_.vertices_mm[t[1]] - a).cross(mesh_.vertices_mm[t[2]] - a).normalized();
  }

  Vector3f sample(float x, float y) const {
    const float across = (x - static_cast<float>(view_.width_px) / 2) * mm_a_pixel_,
                along = (static_cast<float>(view_.height_px) / 2 - y) * mm_a_pixel_;
    const Vector3f origin = centre_ + across * right_ + along * up_ - reach_mm_ * into_;
    const float far_mm = 2 * reach_mm_ + 1;
    float near_mm = 0;
    constexpr int kMostSheets = 32;
    for (int i = 0; i < kMostSheets; ++i) {
      const auto hit = rays_.nearest(origin, into_, far_mm, near_mm);
      if (!hit) break;
      const float facing = -normal_of(hit->triangle).dot(into_);
      const bool wanted = view_.seen_from == SeenFrom::outside || facing < 0;
      if (wanted) {
        const Vector3f base =
            colour_ ? colour_(*hit, origin + hit->distance_mm * into_) : Vector3f(0.93F, 0.87F, 0.78F);
        return base * (0.25F + 0.75F * std::abs(facing));
      }
      near_mm = hit->distance_mm + 1e-3F;
    }
    return Vector3f::Ones();
  }

  const TriangleMesh& mesh_;
  const RayScene& rays_;
  const MeshView& view_;
  const MeshColour& colour_;
  Vector3f right_, up_, into_, centre_;
  float reach_mm_ = 0, mm_a_pixel_ = 1;
};

}  // namespace

Picture draw_mesh(const TriangleMesh& mesh, const RayScene& rays, const MeshView& view,
                  const MeshColour& colour) {
  Picture picture{.width_px = view.width_px, .height_px = view.height_px, .rgba = {}};
  const std::size_t row_bytes = static_cast<std::size_t>(view.width_px) * 4;
  picture.rgba.resize(row_bytes * static_cast<std::size_t>(view.height_px));
  const Drawing drawing(mesh, rays, view, colour);
  const auto half = [&](int parity) {
    for (int y = parity; y < view.height_px; y += 2)
      drawing.row(y, picture.rgba.data() + static_cast<std::size_t>(y) * row_bytes);
  };
  std::thread other(half, 1);
  half(0);
  other.join();
  return picture;
}

}  // namespace orcart
