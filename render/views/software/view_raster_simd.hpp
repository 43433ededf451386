// Triangles into a picture of places, and glass over it; compiled once for each processor target of a file
// that includes Highway's foreach_target.h; not for other files.
#if defined(ORCART_RENDER_VIEWS_SOFTWARE_VIEW_RASTER_SIMD) == defined(HWY_TARGET_TOGGLE)
#ifdef ORCART_RENDER_VIEWS_SOFTWARE_VIEW_RASTER_SIMD
#undef ORCART_RENDER_VIEWS_SOFTWARE_VIEW_RASTER_SIMD
#else
#define ORCART_RENDER_VIEWS_SOFTWARE_VIEW_RASTER_SIMD
#endif

#include "render/shaders/wide.hpp"
#include "render/views/software/view_job.hpp"

HWY_BEFORE_NAMESPACE();
namespace orcart::HWY_NAMESPACE {

class ViewRules {
 protected:
#include "render/shaders/view.glsl"
};

/// Vertices, as many as there are lanes at a time.
class VertexRules : private ViewRules {
 public:
  explicit VertexRules(const ViewJob& job) : job_(job), clip_(job.from.projection * job.from.view) {}

  void see_all() {
    for (std::size_t i = 0; i < job_.vertices.count; i += hn::Lanes(Reals())) see(i);
  }

 private:
  void see(std::size_t first) {
    const Reals d;
    const VertexNumbers& from = job_.vertices;
    const vec3 point{hn::LoadU(d, from.x + first), hn::LoadU(d, from.y + first),
                     hn::LoadU(d, from.z + first)};
    const vec3 normal{hn::LoadU(d, from.nx + first), hn::LoadU(d, from.ny + first),
                      hn::LoadU(d, from.nz + first)};
    const vec3 p{row(job_.from.view, 0, point), row(job_.from.view, 1, point), row(job_.from.view, 2, point)};
    const vec3 n{turned(job_.from.view, 0, normal), turned(job_.from.view, 1, normal),
                 turned(job_.from.view, 2, normal)};
    const vec3 light = head_light(p, n);
    const real away = row(clip_, 3, point);
    const real nearness = pick(away < job_.near_mm, 0.0, real(1.0) / max(away, 1e-6));
    const real x = (row(clip_, 0, point) * nearness * 0.5 + 0.5) * static_cast<double>(job_.places.width);
    const real y = (row(clip_, 1, point) * nearness * 0.5 + 0.5) * static_cast<double>(job_.places.height);
    float* const out = &job_.seen_vertices[first].x_px;
    alignas(64) float numbers[8][16];
    const std::array<real, 8> of_vertex{x,
                                        y,
                                        nearness,
                                        light.z,
                                        real(hn::LoadU(d, from.u + first)) * 16.0,
                                        real(hn::LoadU(d, from.v + first)) * 16.0,
                                        light.x * 65535.0,
                                        light.y * 65535.0};
    for (std::size_t k = 0; k < of_vertex.size(); ++k) hn::Store(of_vertex[k].v, d, numbers[k]);
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane)
      for (std::size_t k = 0; k < of_vertex.size(); ++k) out[lane * of_vertex.size() + k] = numbers[k][lane];
  }

  static real turned(const glm::mat4& m, int to, const vec3& p) {
    return p.x * m[0][to] + p.y * m[1][to] + p.z * m[2][to];
  }
  static real row(const glm::mat4& m, int to, const vec3& p) { return turned(m, to, p) + m[3][to]; }

  const ViewJob& job_;
  glm::mat4 clip_;
};

/// Triangles, one after the other, a vector of pixels of a row at a time.
class TriangleRules : private ViewRules {
 public:
  TriangleRules(const ViewJob& job, bool glass) : job_(job), glass_(glass) {}

  void draw(std::span<const std::uint32_t> indices) {
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
      const SeenVertex &a = job_.seen_vertices[indices[i]], &b = job_.seen_vertices[indices[i + 1]],
                       &c = job_.seen_vertices[indices[i + 2]];
      if (std::min(a.nearness, std::min(b.nearness, c.nearness)) > 0)
        draw(a, b, c);
      else if (std::max(a.nearness, std::max(b.nearness, c.nearness)) > 0)
        draw_rest(indices.data() + i);
    }
  }

 private:
  struct Edge {
    float a, b, x, y, slack;  ///< a x + b y, from x y on, is not negative inside
  };
  struct Box {
    int x0, x1, y0, y1;  ///< pixels, both ends included
  };

  void draw(const SeenVertex& a, const SeenVertex& b, const SeenVertex& c) {
    const float area = (b.x_px - a.x_px) * (c.y_px - a.y_px) - (c.x_px - a.x_px) * (b.y_px - a.y_px);
    if (!(area * job_.facing_area > 0)) return;
    const Box box{first(std::min(a.x_px, std::min(b.x_px, c.x_px)), job_.places.width),
                  last(std::max(a.x_px, std::max(b.x_px, c.x_px)), job_.places.width),
                  first(std::min(a.y_px, std::min(b.y_px, c.y_px)), job_.places.height),
                  last(std::max(a.y_px, std::max(b.y_px, c.y_px)), job_.places.height)};
    if (box.x0 > box.x1 || box.y0 > box.y1) return;
    const float turn = area < 0 ? -1.0F : 1.0F;
    const Edge edges[3]{edge(a, b, turn), edge(b, c, turn), edge(c, a, turn)};
    const Slopes slopes{.b_x = b.x_px - a.x_px,
                        .b_y = b.y_px - a.y_px,
                        .c_x = c.x_px - a.x_px,
                        .c_y = c.y_px - a.y_px,
                        .per_area = 1 / area};
    if (glass_)
      fill_glass(edges, box, a, b, c, slopes);
    else
      fill_places(edges, box, a, b, c, slopes);
  }

  /// Centres of pixels from this place on, and up to it.
  static int first(float from_px, int size) {
    return static_cast<int>(
        std::floor(std::clamp(from_px + (0.5F - kSlack_px), 0.0F, static_cast<float>(size))));
  }
  static int last(float to_px, int size) {
    return static_cast<int>(
        std::floor(std::clamp(to_px + (kSlack_px - 0.5F), -1.0F, static_cast<float>(size - 1))));
  }

  Edge edge(const SeenVertex& from, const SeenVertex& to, float turn) const {
    const float a = (from.y_px - to.y_px) * turn, b = (to.x_px - from.x_px) * turn;
    // Glass that overlaps shows; places may.
    return {a, b, from.x_px, from.y_px, glass_ ? 0 : (std::abs(a) + std::abs(b)) * kSlack_px};
  }

  struct Slopes {
    float b_x, b_y, c_x, c_y, per_area;  ///< from corner a
    float by_x(float to_b, float to_c) const { return (to_b * c_y - to_c * b_y) * per_area; }
    float by_y(float to_b, float to_c) const { return (to_c * b_x - to_b * c_x) * per_area; }
  };

  /// A number that is linear across the triangle's picture.
  struct Plane {
    float at_a, by_x, by_y;
    Plane(float a, float b, float c, const Slopes& slopes)
        : at_a(a), by_x(slopes.by_x(b - a, c - a)), by_y(slopes.by_y(b - a, c - a)) {}
    float row(float down) const { return at_a + by_y * down; }
  };
  /// A number of the corners, with perspective: divided by nearness it is linear, and it stays between
  /// theirs.
  struct Number {
    Plane plane;
    float low, high;
    Number(float a, float b, float c, const SeenVertex& va, const SeenVertex& vb, const SeenVertex& vc,
           const Slopes& slopes)
        : plane(a * va.nearness, b * vb.nearness, c * vc.nearness, slopes),
          low(std::min(a, std::min(b, c))),
          high(std::max(a, std::max(b, c))) {}
    HWY_INLINE real at(real right, float row_value, real distance) const {
      return clamp((right * plane.by_x + row_value) * distance, low, high);
    }
  };

  /// Calls `at(index of the first pixel, its and the next ones' places, which of them are inside, y)` row by
  /// row.
  template <class At>
  HWY_INLINE void each(const Edge (&edges)[3], const Box& box, const At& at) {
    const Reals d;
    const real lane = hn::Iota(d, 0.5F);
    for (int y = box.y0; y <= box.y1; ++y) {
      const float middle = static_cast<float>(y) + 0.5F;
      float from[3];
      for (int e = 0; e < 3; ++e) from[e] = edges[e].b * (middle - edges[e].y) + edges[e].slack;
      const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(job_.places.stride);
      for (int x = box.x0; x <= box.x1; x += static_cast<int>(hn::Lanes(d))) {
        const real place = lane + static_cast<float>(x);
        const auto side = [&](int e) HWY_ATTR { return (place - edges[e].x) * edges[e].a + from[e]; };
        const truth inside =
            both(min(side(0), min(side(1), side(2))) >= 0.0, place < static_cast<float>(box.x1 + 1));
        if (any(inside)) at(row + static_cast<std::size_t>(x), place, inside, middle);
      }
    }
  }

  void fill_places(const Edge (&edges)[3], const Box& box, const SeenVertex& a, const SeenVertex& b,
                   const SeenVertex& c, const Slopes& slopes) {
    const Plane nearness(a.nearness, b.nearness, c.nearness, slopes);
    const float least = std::min(a.nearness, std::min(b.nearness, c.nearness)),
                most = std::max(a.nearness, std::max(b.nearness, c.nearness));
    const Number numbers[4]{{a.u, b.u, c.u, a, b, c, slopes},
                            {a.v, b.v, c.v, a, b, c, slopes},
                            {a.bare, b.bare, c.bare, a, b, c, slopes},
                            {a.lit, b.lit, c.lit, a, b, c, slopes}};
    each(edges, box, [&](std::size_t pixel, real place, truth inside, float middle) HWY_ATTR {
      const Reals d;
      const real right = place - a.x_px;
      const float down = middle - a.y_px;
      const real near = clamp(right * nearness.by_x + nearness.row(down), least, most);
      const real before = hn::LoadU(d, job_.places.nearness + pixel);
      const truth nearer = both(inside, near > before);
      if (!any(nearer)) return;
      const real distance = real(1.0) / near;
      const auto number = [&](std::size_t k) HWY_ATTR {
        return whole(numbers[k].at(right, numbers[k].plane.row(down), distance));
      };
      const auto keep = [&](std::uint32_t* numbers_of, Whole low, Whole high) HWY_ATTR {
        auto* const words = reinterpret_cast<std::int32_t*>(numbers_of + pixel);
        hn::StoreU(hn::IfThenElse(hn::RebindMask(Wholes(), nearer.m), hn::Or(low, hn::ShiftLeft<16>(high)),
                                  hn::LoadU(Wholes(), words)),
                   Wholes(), words);
      };
      hn::StoreU(pick(nearer, near, before).v, d, job_.places.nearness + pixel);
      keep(job_.places.place, number(0), number(1));
      keep(job_.places.light, number(2), number(3));
    });
  }

  void fill_glass(const Edge (&edges)[3], const Box& box, const SeenVertex& a, const SeenVertex& b,
                  const SeenVertex& c, const Slopes& slopes) {
    const Plane nearness(a.nearness, b.nearness, c.nearness, slopes);
    const Number facing(a.facing, b.facing, c.facing, a, b, c, slopes);
    each(edges, box, [&](std::size_t pixel, real place, truth inside, float middle) HWY_ATTR {
      const real right = place - a.x_px;
      const float down = middle - a.y_px;
      const real near = max(right * nearness.by_x + nearness.row(down), 1e-9);
      const truth nearer = both(inside, near > real(hn::LoadU(Reals(), job_.places.nearness + pixel)));
      if (!any(nearer)) return;
      const vec4 colour = glass(facing.at(right, facing.plane.row(down), real(1.0) / near));
      auto* const words = reinterpret_cast<std::int32_t*>(job_.shell + pixel);
      const Whole before = hn::LoadU(Wholes(), words);
      const real rest = 1.0 - colour.w;
      const Whole after = rgba_of(colour.x + byte_of<0>(before) * (1 / 255.0) * rest,
                                  colour.y + byte_of<8>(before) * (1 / 255.0) * rest,
                                  colour.z + byte_of<16>(before) * (1 / 255.0) * rest,
                                  colour.w + byte_of<24>(before) * (1 / 255.0) * rest);
      hn::StoreU(hn::IfThenElse(hn::RebindMask(Wholes(), nearer.m), after, before), Wholes(), words);
    });
  }

  /// What lies beyond the near plane of a triangle that reaches before it (Sutherland and Hodgman 1974).
  void draw_rest(const std::uint32_t* corners) {
    struct Corner {
      glm::vec4 clip;
      SeenVertex seen;
    };
    const glm::mat4 to_clip = job_.from.projection * job_.from.view;
    const auto corner = [&](std::size_t i) {
      const VertexNumbers& from = job_.vertices;
      const std::uint32_t v = corners[i % 3];
      return Corner{to_clip * glm::vec4(from.x[v], from.y[v], from.z[v], 1), job_.seen_vertices[v]};
    };
    SeenVertex kept[4];
    std::size_t count = 0;
    const auto keep = [&](const glm::vec4& clip, const SeenVertex& from) {
      SeenVertex& seen = kept[count++] = from;
      seen.nearness = 1 / clip.w;
      seen.x_px = (clip.x / clip.w * 0.5F + 0.5F) * static_cast<float>(job_.places.width);
      seen.y_px = (clip.y / clip.w * 0.5F + 0.5F) * static_cast<float>(job_.places.height);
    };
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner from = corner(i), to = corner(i + 1);
      if (from.clip.w >= job_.near_mm) keep(from.clip, from.seen);
      if ((from.clip.w >= job_.near_mm) == (to.clip.w >= job_.near_mm)) continue;
      const float share = (job_.near_mm - from.clip.w) / (to.clip.w - from.clip.w);
      const auto between = [&](float a, float b) { return a + (b - a) * share; };
      SeenVertex cut = from.seen;
      cut.facing = between(from.seen.facing, to.seen.facing);
      cut.u = between(from.seen.u, to.seen.u);
      cut.v = between(from.seen.v, to.seen.v);
      cut.bare = between(from.seen.bare, to.seen.bare);
      cut.lit = between(from.seen.lit, to.seen.lit);
      keep(from.clip + (to.clip - from.clip) * share, cut);
    }
    for (std::size_t second = 1; second + 1 < count; ++second) draw(kept[0], kept[second], kept[second + 1]);
  }

  static constexpr float kSlack_px = 1.0F / 1024;  ///< no cracks between neighbours
  const ViewJob& job_;
  bool glass_;
};

}  // namespace orcart::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
