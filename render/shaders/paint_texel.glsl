// One texel: whether the scope sees its point of the surface (M, mm), and what colour it shows there.
void paint_texel(vec3 point, real packed_normal) {
  vec3 p = u_rotation_CM * point + u_translation_CM;
  real distance_mm = length(p);
  GIVE_UP_WHERE(either(p.z <= 0.05, either(distance_mm > u_far_mm, p.z < u_cos_cone * distance_mm)));
  vec3 normal = u_rotation_CM * unpacked_normal(packed_normal) * u_facing;
  real cos_angle = -dot(normal, p) / distance_mm;
  GIVE_UP_WHERE(cos_angle < u_cos_obliquity);
  vec2 pixel = lens_pixel(p);
  real weight = mask_weight(pixel);
  GIVE_UP_WHERE(weight <= 0.0);
  vec3 plane = normal / dot(normal, p);  // dot(plane, ray) is the reciprocal depth of the plane along a ray of depth 1
  vec2 r = seen_and_own(vec2(p) / p.z, plane);
  GIVE_UP_WHERE(nearer(r.x, r.y, 0.04 + 0.002 * p.z));  // hidden
  GIVE_UP_WHERE(beside_an_edge(p, plane, 1.5));
  real level = picture_level(distance_mm, cos_angle);
  WHERE_ANY(level > 0.0)  // rather grainy than of two colours
    level = pick(both(level > 0.0, beside_an_edge(p, plane, 1.5 * exp2(level))), 0.0, level);
  vec3 colour = picture_at(pixel, level);
  weight *= notch_weight(pixel, colour);
  GIVE_UP_WHERE(weight <= 0.0);
  weight *= clamp((cos_angle - u_cos_obliquity) * 10.0, 0.004, 1.0);  // no jagged edge from triangle to triangle
  put(evened_out(colour, p, distance_mm, cos_angle), weight, core_weight(pixel), record_of(distance_mm, cos_angle));
}
