// Normals, the light that falls on a point, and the level of the picture that suits a texel; see atlas/paint_settings.hpp.
vec3 unpacked_normal(real packed_normal) {
  vec2 e = vec2(floor(packed_normal / 2048.0), mod(packed_normal, 2048.0)) / 2047.0 * 2.0 - 1.0;
  real z = 1.0 - abs(e.x) - abs(e.y);
  real fold = max(-z, 0.0);
  return normalize(vec3(e.x + pick(e.x >= 0.0, -fold, fold), e.y + pick(e.y >= 0.0, -fold, fold), z));
}

// A texel covers this many pixels, in powers of two: the picture's level in which it covers one.
real picture_level(real distance_mm, real cos_angle) {
  return log2(max(u_texel_mm * sqrt(cos_angle) / (u_pixel_rad * distance_mm), 1.0));
}

// LIGHT: evened out. Light from beside the lens: it falls with the square of the distance and the angle on tissue that
// scatters some of it under its skin (wrapped Lambert); the lens takes the rest. Never brightened more than twofold, for
// that shows noise and the camera's own tone curve. The twin of atlas/view_light.cpp.
vec3 evened_out(vec3 colour, vec3 p, real distance_mm, real cos_angle) {
  if (!LIGHT) return colour;
  real nearness = u_light.x / distance_mm;
  real light = nearness * nearness * pow(p.z / distance_mm, u_light.y) * (cos_angle + 0.2) / 1.2;
  return min(colour / clamp(pow(light / u_light.z, 1.0 / 2.2), 0.5, 3.0), vec3(1.0));
}
