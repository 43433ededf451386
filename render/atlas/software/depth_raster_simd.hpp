// Triangles into a picture of reciprocal depths, which are linear across a triangle's picture; compiled once
// for each processor target of a file that includes Highway's foreach_target.h; not for other files.
#if defined(ORCART_RENDER_ATLAS_SOFTWARE_DEPTH_RASTER_SIMD) == defined(HWY_TARGET_TOGGLE)
#ifdef ORCART_RENDER_ATLAS_SOFTWARE_DEPTH_RASTER_SIMD
#undef ORCART_RENDER_ATLAS_SOFTWARE_DEPTH_RASTER_SIMD
#else
#define ORCART_RENDER_ATLAS_SOFTWARE_DEPTH_RASTER_SIMD
#endif

#include "render/atlas/software/depth_job.hpp"
#include "render/shaders/wide.hpp"

HWY_BEFORE_NAMESPACE();
namespace orcart::HWY_NAMESPACE {

constexpr std::size_t kBatch = 16;  ///< triangles set up together, and depths of a row looked at together

/// Corners in C, mm, of up to kBatch triangles.
struct CornerBatch {
  alignas(64) float x[3][kBatch], y[3][kBatch], z[3][kBatch];
  std::size_t count = 0;
};

/// An edge of each triangle: a x + b y, of places from the edge's first corner, is not negative inside.
struct EdgeBatch {
  alignas(64) float a[kBatch], b[kBatch], x[kBatch], y[kBatch], slack[kBatch];
};

class DepthRules {
 public:
  explicit DepthRules(const DepthJob& job)
      : job_(job), half_(0.5F * static_cast<float>(job.size_texels)), per_slope_(half_ / job.tangent) {}

  void draw(std::span<const std::uint32_t> triangles) {
    for (std::size_t i = 0; i < triangles.size(); i += kBatch)
      draw_batch(triangles.subspan(i, std::min(kBatch, triangles.size() - i)));
  }

 private:
  void draw_batch(std::span<const std::uint32_t> triangles) {
    alignas(64) std::int32_t ids[kBatch] = {};
    std::copy(triangles.begin(), triangles.end(), ids);
    CornerBatch whole_ones;
    whole_ones.count = triangles.size();
    bool crosses = false;
    for (std::size_t i = 0; i < kBatch; i += hn::Lanes(Reals())) {
      const Whole id = hn::Load(Wholes(), ids + i);
      truth some_near = real(1.0) < 0.0;
      for (std::size_t c = 0; c < 3; ++c) {
        const Whole corner = hn::GatherIndex(Wholes(), job_.triangles + c, hn::Mul(id, hn::Set(Wholes(), 3)));
        const vec3 p = in_camera(hn::Mul(corner, hn::Set(Wholes(), 3)));
        hn::Store(p.x.v, Reals(), whole_ones.x[c] + i);
        hn::Store(p.y.v, Reals(), whole_ones.y[c] + i);
        hn::Store(p.z.v, Reals(), whole_ones.z[c] + i);
        some_near = either(some_near, p.z < job_.near_mm);
      }
      crosses = crosses || any(some_near);
    }
    if (crosses) cut_at_near(whole_ones);
    fill(whole_ones);
  }

  vec3 in_camera(Whole first_number) const {
    const vec3 p{gathered(0, first_number), gathered(1, first_number), gathered(2, first_number)};
    const auto along = [&](std::size_t row) HWY_ATTR {
      return p.x * job_.R_CM[row] + p.y * job_.R_CM[row + 3] + p.z * job_.R_CM[row + 6] + job_.t_CM[row];
    };
    return {along(0), along(1), along(2)};
  }
  real gathered(std::size_t axis, Whole first_number) const {
    return hn::GatherIndex(Reals(), job_.vertices_mm + axis, first_number);
  }

  /// Takes triangles that reach before the near plane out of the batch, and fills what of them lies beyond
  /// it.
  void cut_at_near(CornerBatch& batch) {
    CornerBatch rests;
    for (std::size_t i = 0; i < batch.count;) {
      int beyond = 0;
      for (std::size_t c = 0; c < 3; ++c) beyond += batch.z[c][i] >= job_.near_mm ? 1 : 0;
      if (beyond == 3) {
        ++i;
        continue;
      }
      if (rests.count + 2 > kBatch) {
        fill(rests);
        rests.count = 0;
      }
      if (beyond > 0) add_rest(batch, i, rests);
      --batch.count;
      for (std::size_t c = 0; c < 3; ++c) put(batch, i, c, point(batch, batch.count, c));
    }
    fill(rests);
  }

  struct Point {
    float x, y, z;
  };
  static Point point(const CornerBatch& batch, std::size_t i, std::size_t corner) {
    return {batch.x[corner][i], batch.y[corner][i], batch.z[corner][i]};
  }
  static void put(CornerBatch& batch, std::size_t i, std::size_t corner, const Point& p) {
    batch.x[corner][i] = p.x;
    batch.y[corner][i] = p.y;
    batch.z[corner][i] = p.z;
  }

  /// One or two triangles (Sutherland and Hodgman 1974).
  void add_rest(const CornerBatch& from, std::size_t i, CornerBatch& rests) const {
    Point kept[4];
    std::size_t count = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const Point a = point(from, i, c), b = point(from, i, (c + 1) % 3);
      if (a.z >= job_.near_mm) kept[count++] = a;
      if ((a.z >= job_.near_mm) == (b.z >= job_.near_mm)) continue;
      const float share = (job_.near_mm - a.z) / (b.z - a.z);
      kept[count++] = {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), job_.near_mm};
    }
    for (std::size_t second = 1; second + 1 < count; ++second) {
      put(rests, rests.count, 0, kept[0]);
      put(rests, rests.count, 1, kept[second]);
      put(rests, rests.count, 2, kept[second + 1]);
      ++rests.count;
    }
  }

  void fill(const CornerBatch& batch) {
    if (batch.count == 0) return;
    EdgeBatch edges[3];
    alignas(64) float at[kBatch], by_x[kBatch], by_y[kBatch], least[kBatch], most[kBatch];
    alignas(64) std::int32_t x0[kBatch], x1[kBatch], y0[kBatch], y1[kBatch];
    for (std::size_t i = 0; i < kBatch; i += hn::Lanes(Reals())) {
      const Reals d;
      real x[3], y[3], r[3];
      for (std::size_t c = 0; c < 3; ++c) {
        r[c] = real(1.0) / max(hn::Load(d, batch.z[c] + i), job_.near_mm);
        x[c] = real(hn::Load(d, batch.x[c] + i)) * r[c] * per_slope_ + half_;
        y[c] = real(hn::Load(d, batch.y[c] + i)) * r[c] * per_slope_ + half_;
      }
      const real area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
      const real turn = pick(area < 0.0, -1.0, 1.0);
      for (std::size_t e = 0; e < 3; ++e) {
        const std::size_t next = (e + 1) % 3;
        const real a = (y[e] - y[next]) * turn, b = (x[next] - x[e]) * turn;
        hn::Store(a.v, d, edges[e].a + i);
        hn::Store(b.v, d, edges[e].b + i);
        hn::Store(x[e].v, d, edges[e].x + i);
        hn::Store(y[e].v, d, edges[e].y + i);
        hn::Store(((abs(a) + abs(b)) * kSlack_texels).v, d, edges[e].slack + i);
      }
      const real per_area = real(1.0) / pick(abs(area) > 1e-12, area, 1e-12);
      const real dr1 = r[1] - r[0], dr2 = r[2] - r[0];
      hn::Store(r[0].v, d, at + i);
      hn::Store(((dr1 * (y[2] - y[0]) - dr2 * (y[1] - y[0])) * per_area).v, d, by_x + i);
      hn::Store(((dr2 * (x[1] - x[0]) - dr1 * (x[2] - x[0])) * per_area).v, d, by_y + i);
      hn::Store(min(r[0], min(r[1], r[2])).v, d, least + i);
      hn::Store(max(r[0], max(r[1], r[2])).v, d, most + i);
      const real last = static_cast<double>(job_.size_texels - 1);
      const auto first_of = [&](const real* v) HWY_ATTR {
        return whole(floor(clamp(min(v[0], min(v[1], v[2])) + (0.5 - kSlack_texels), 0.0, last + 1.0)));
      };
      const auto last_of = [&](const real* v) HWY_ATTR {
        return whole(floor(clamp(max(v[0], max(v[1], v[2])) + (kSlack_texels - 0.5), -1.0, last)));
      };
      hn::Store(first_of(x), Wholes(), x0 + i);
      hn::Store(last_of(x), Wholes(), x1 + i);
      hn::Store(first_of(y), Wholes(), y0 + i);
      hn::Store(last_of(y), Wholes(), y1 + i);
    }
    for (std::size_t i = 0; i < batch.count; ++i) {
      const Box box{x0[i], x1[i], y0[i], y1[i]};
      if (box.x0 > box.x1 || box.y0 > box.y1) continue;
      fill_one(edges, i, {at[i], by_x[i], by_y[i], least[i], most[i]}, box);
    }
  }

  struct Box {
    std::int32_t x0, x1, y0, y1;  ///< texels, both ends included
  };
  struct Plane {
    float at_first, by_x, by_y, least, most;  ///< reciprocal depth, from the first corner
  };

  void fill_one(const EdgeBatch* edges, std::size_t i, const Plane& plane, const Box& box) {
    const Reals d;
    const real lane = hn::Iota(d, 0.5F);
    for (std::int32_t y = box.y0; y <= box.y1; ++y) {
      const float row = static_cast<float>(y) + 0.5F;
      float from[3];
      for (std::size_t e = 0; e < 3; ++e) from[e] = edges[e].b[i] * (row - edges[e].y[i]) + edges[e].slack[i];
      const float depth = plane.at_first + plane.by_y * (row - edges[0].y[i]);
      float* const out =
          job_.per_mm + static_cast<std::size_t>(y) * static_cast<std::size_t>(job_.size_texels);
      for (std::int32_t x = box.x0; x <= box.x1; x += static_cast<std::int32_t>(hn::Lanes(d))) {
        const real place = lane + static_cast<float>(x);
        const auto side = [&](std::size_t e)
                              HWY_ATTR { return (place - edges[e].x[i]) * edges[e].a[i] + from[e]; };
        const truth inside =
            both(min(side(0), min(side(1), side(2))) >= 0.0, place < static_cast<float>(box.x1 + 1));
        if (!any(inside)) continue;
        const real r = clamp((place - edges[0].x[i]) * plane.by_x + depth, plane.least, plane.most);
        const real before = hn::LoadU(d, out + x);
        hn::StoreU(pick(inside, max(before, r), before).v, d, out + x);
      }
    }
  }

  static constexpr double kSlack_texels = 1.0 / 1024;  ///< no cracks between neighbours
  const DepthJob& job_;
  float half_, per_slope_;
};

}  // namespace orcart::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
