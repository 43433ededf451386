// One texel: which point of the surface it is, whether the scope sees that point, and what colour it shows there.
uniform sampler2D u_points;  // the point behind the texel, M, mm, out of all reach where there is none; its normal in w
uniform sampler2D u_depth;   // what the scope sees, by a pinhole of tangent u_depth_tangent

uniform mat3 u_rotation_CM;
uniform vec3 u_translation_CM;
uniform float u_facing;      // +1 seen from outside, -1 from inside
uniform float u_cos_cone, u_far_mm, u_cos_obliquity;
uniform float u_depth_tangent, u_depth_near, u_depth_far;

// The reciprocal depth of what the scope sees along the line of sight of the depth texel that holds `slope` (x), and of the
// texel's own plane along the same line (y). Reciprocal depths are linear in what the texture holds and in the slopes.
vec2 seen_and_own(vec2 slope, vec3 plane) {
  float half_size = 0.5 * float(textureSize(u_depth, 0).x), texels_per_slope = half_size / u_depth_tangent;
  ivec2 at = ivec2(slope * texels_per_slope + half_size);
  vec2 centre = (vec2(at) + 0.5 - half_size) / texels_per_slope;
  float seen = 1.0 / u_depth_near - texelFetch(u_depth, at, 0).r * (1.0 / u_depth_near - 1.0 / u_depth_far);
  return vec2(seen, max(dot(plane, vec3(centre, 1.0)), 1e-6));
}

// Whether a is nearer than b by more than that: 1/b - 1/a > mm, of reciprocal depths and without dividing.
bool nearer(float a, float b, float mm) { return a - b > mm * a * b; }

// Whether something nearer, or farther, is seen within `pixels` beside the point: a picture that is blurred that far mixes
// its colour in. A steep plane is no edge: nearer counts from no farther than a margin behind the point.
bool beside_an_edge(vec3 p, vec3 plane, float pixels) {
  vec2 slope = p.xy / p.z;
  float reach = pixels * u_pixel_rad * (1.0 + dot(slope, slope));  // a barrel's pixels grow towards its edge
  float margin = 0.25 + 0.015 * p.z;
  float farthest_own = 1.0 / (p.z + margin);
  vec2 step_by = vec2(reach, 0.0);
  for (int i = 0; i < 8; ++i) {
    vec2 r = seen_and_own(slope + step_by, plane);
    if (nearer(r.x, max(r.y, farthest_own), margin) || nearer(r.y, r.x, margin)) return true;
    step_by = 0.70710678 * vec2(step_by.x - step_by.y, step_by.x + step_by.y);
  }
  return false;
}

void main() {
  vec4 point = texelFetch(u_points, ivec2(gl_FragCoord.xy), 0);
  vec3 p = u_rotation_CM * point.xyz + u_translation_CM;
  float distance_mm = length(p);
  if (p.z <= 0.05 || distance_mm > u_far_mm || p.z < u_cos_cone * distance_mm) discard;
  vec3 normal = u_rotation_CM * unpacked_normal(point.w) * u_facing;
  if (-dot(normal, p) < u_cos_obliquity * distance_mm) discard;
  vec2 pixel = lens_pixel(p);
  float weight = mask_weight(pixel);
  float cos_angle = -dot(normal, p) / distance_mm;
  if (weight <= 0.0) discard;
  vec3 plane = normal / dot(normal, p);  // dot(plane, ray) is the reciprocal depth of the plane along a ray of depth 1
  vec2 r = seen_and_own(p.xy / p.z, plane);
  if (nearer(r.x, r.y, 0.04 + 0.002 * p.z)) discard;  // hidden
  if (beside_an_edge(p, plane, 1.5)) discard;
  float level = picture_level(distance_mm, cos_angle);
  if (level > 0.0 && beside_an_edge(p, plane, 1.5 * exp2(level))) level = 0.0;  // rather grainy than of two colours
  vec3 colour = picture_at(pixel, level);
  weight *= notch_weight(pixel, colour);
  if (weight <= 0.0) discard;
  weight *= clamp((cos_angle - u_cos_obliquity) * 10.0, 0.004, 1.0);  // no jagged edge from triangle to triangle
  put(evened_out(colour, p, distance_mm, cos_angle), weight, core_weight(pixel), record_of(distance_mm, cos_angle));
}
