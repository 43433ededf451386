// Places into colours; compiled once for each processor target of a file that includes Highway's
// foreach_target.h; not for other files.
#if defined(ORCART_RENDER_VIEWS_SOFTWARE_VIEW_SHADE_SIMD) == defined(HWY_TARGET_TOGGLE)
#ifdef ORCART_RENDER_VIEWS_SOFTWARE_VIEW_SHADE_SIMD
#undef ORCART_RENDER_VIEWS_SOFTWARE_VIEW_SHADE_SIMD
#else
#define ORCART_RENDER_VIEWS_SOFTWARE_VIEW_SHADE_SIMD
#endif

#include "render/shaders/wide.hpp"
#include "render/views/software/view_job.hpp"

HWY_BEFORE_NAMESPACE();
namespace orcart::HWY_NAMESPACE {

/// As many pixels of a row as there are lanes, one after the other.
class ShadeRules {
 public:
  explicit ShadeRules(const ShadeJob& job) : job_(job) { u_end_of_ramp = job.end_of_ramp; }

  void shade(const PixelBox& part) {
    const auto lanes = static_cast<int>(hn::Lanes(Reals()));
    for (int y = part.y; y < part.y + part.height; ++y)
      for (int x = part.x / lanes * lanes; x < part.x + part.width; x += lanes) shade(x, y);
  }

 private:
#define COLOUR_BY static_cast<int>(job_.colour_by)
#define uniform
#include "render/shaders/colouring.glsl"
#undef uniform
#include "render/shaders/view.glsl"
#undef COLOUR_BY

  void shade(int x, int y) {
    const PlacePicture& places = job_.places;
    const std::size_t pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(places.stride) + static_cast<std::size_t>(x);
    const Whole light = word(places.light + pixel);
    const truth seen = something(light);
    vec3 colour{kViewGround[0], kViewGround[1], kViewGround[2]};
    if (any(seen)) {
      const Whole place = word(places.place + pixel);
      vec4 paint = paint_at(place);
      if (job_.colour_by != ColourBy::picture) {
        const vec3 known = known_colour(record_at(place)) * paint.w;
        paint = {known.x, known.y, known.z, paint.w};
      }
      constexpr double kScale = 1 / 65535.0;
      const vec3 shown =
          tissue({paint.x, paint.y, paint.z}, paint.w,
                 {from_whole(low_half(light)) * kScale, from_whole(high_half(light)) * kScale});
      colour = mix(colour, shown, pick(seen, outline_cover(empty_beside(x, y, pixel)), 0.0));
    }
    if (job_.shell != nullptr) {
      const Whole shell = word(job_.shell + pixel);
      constexpr double kScale = 1 / 255.0;
      colour = colour * (1.0 - byte_of<24>(shell) * kScale) +
               vec3(byte_of<0>(shell), byte_of<8>(shell), byte_of<16>(shell)) * kScale;
    }
    hn::StoreU(rgba_of(colour.x, colour.y, colour.z, 1.0), Wholes(),
               reinterpret_cast<std::int32_t*>(job_.shown + pixel));
  }

  static Whole word(const std::uint32_t* at) {
    return hn::LoadU(Wholes(), reinterpret_cast<const std::int32_t*>(at));
  }
  static Whole low_half(Whole word) {
    return hn::And(word, hn::Set(Wholes(), 0xFFFF));
  }
  static Whole high_half(Whole word) {
    return low_half(hn::ShiftRight<16>(word));
  }
  static truth something(Whole light) {
    return {hn::RebindMask(Reals(), hn::Ne(low_half(light), hn::Zero(Wholes())))};
  }

  /// How many of the four neighbours show nothing; beyond the picture's edge the pixel itself counts.
  real empty_beside(int x, int y, std::size_t pixel) const {
    const PlacePicture& places = job_.places;
    const std::uint32_t* const at = places.light + pixel;
    const real column = hn::Iota(Reals(), static_cast<float>(x));
    const auto empty = [&](const std::uint32_t* beside, truth within)
                           HWY_ATTR { return pick(without(within, something(word(beside))), 1.0, 0.0); };
    const truth all = column >= 0.0;
    return empty(at - 1, column > 0.0) + empty(at + 1, column < static_cast<float>(places.width - 1)) +
           empty(y > 0 ? at - places.stride : at, all) +
           empty(y + 1 < places.height ? at + places.stride : at, all);
  }

  /// Bilinear, premultiplied. Two channels in each word: 255 times 16 times 16 fits into 16 bits.
  vec4 paint_at(Whole place) const {
    const auto all = [](int number) HWY_ATTR { return hn::Set(Wholes(), number); };
    const Whole last = all(job_.paint.width_texels - 2);
    const Whole x = hn::Max(hn::Sub(low_half(place), all(8)), all(0)),
                y = hn::Max(hn::Sub(high_half(place), all(8)), all(0));
    const Whole left = hn::Min(hn::ShiftRight<4>(x), last), above = hn::Min(hn::ShiftRight<4>(y), last);
    const Whole more_x = hn::Sub(x, hn::ShiftLeft<4>(left)), less_x = hn::Sub(all(16), more_x),
                more_y = hn::Sub(y, hn::ShiftLeft<4>(above)), less_y = hn::Sub(all(16), more_y);
    const Whole index = hn::Add(hn::Mul(above, all(job_.paint.width_texels)), left);
    const auto mix = [](Whole p, Whole less, Whole q, Whole more)
                         HWY_ATTR { return hn::Add(hn::Mul(p, less), hn::Mul(q, more)); };
    Whole red_blue[2], green_alpha[2];
    for (int row = 0; row < 2; ++row) {
      const auto* const texels =
          reinterpret_cast<const std::int32_t*>(job_.paint.colours) + row * job_.paint.width_texels;
      const Whole first = hn::GatherIndex(Wholes(), texels, index),
                  second = hn::GatherIndex(Wholes(), texels + 1, index), two = all(0x00FF00FF);
      red_blue[row] = mix(hn::And(first, two), less_x, hn::And(second, two), more_x);
      green_alpha[row] = mix(hn::And(hn::ShiftRight<8>(first), two), less_x,
                             hn::And(hn::ShiftRight<8>(second), two), more_x);
    }
    const Whole rb = mix(red_blue[0], less_y, red_blue[1], more_y),
                ga = mix(green_alpha[0], less_y, green_alpha[1], more_y);
    constexpr double kScale = 1 / (255.0 * 256.0);
    return {from_whole(low_half(rb)) * kScale, from_whole(low_half(ga)) * kScale,
            from_whole(high_half(rb)) * kScale, from_whole(high_half(ga)) * kScale};
  }

  vec4 record_at(Whole place) const {
    const Whole x = hn::ShiftRight<4>(low_half(place)), y = hn::ShiftRight<4>(high_half(place));
    const Whole index = hn::Add(hn::Mul(y, hn::Set(Wholes(), job_.paint.width_texels)), x);
    const auto* const words = reinterpret_cast<const std::int32_t*>(job_.paint.records);
    const Whole twice = hn::Add(index, index), first = hn::GatherIndex(Wholes(), words, twice),
                second = hn::GatherIndex(Wholes(), words + 1, twice);
    return {from_whole(low_half(first)), from_whole(high_half(first)), from_whole(low_half(second)),
            from_whole(high_half(second))};
  }

  const ShadeJob& job_;
};

}  // namespace orcart::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
