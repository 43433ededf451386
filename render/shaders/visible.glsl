// What the scope sees of the surface: nothing nearer on the line of sight, and no edge beside it.

// The reciprocal depth of what the scope sees along the line of sight of the depth texel that holds `slope` (x), and of the
// texel's own plane along the same line (y). Reciprocal depths are linear in the picture and in the slopes.
vec2 seen_and_own(vec2 slope, vec3 plane) {
  real half_size = 0.5 * u_depth_size, texels_per_slope = half_size / u_depth_tangent;
  vec2 at = floor(slope * texels_per_slope + half_size);
  vec2 centre = (at + 0.5 - half_size) / texels_per_slope;
  return vec2(seen_at(at), max(dot(plane, vec3(centre, 1.0)), 1e-6));
}

// Whether a is nearer than b by more than that: 1/b - 1/a > mm, of reciprocal depths and without dividing.
truth nearer(real a, real b, real mm) { return a - b > mm * a * b; }

// Whether something nearer, or farther, is seen within `pixels` beside the point: a picture that is blurred that far mixes
// its colour in. A steep plane is no edge: nearer counts from no farther than a margin behind the point.
truth beside_an_edge(vec3 p, vec3 plane, real pixels) {
  vec2 slope = vec2(p) / p.z;
  real reach = pixels * u_pixel_rad * (1.0 + dot(slope, slope));  // a barrel's pixels grow towards its edge
  real margin = 0.25 + 0.015 * p.z;
  real farthest_own = 1.0 / (p.z + margin);
  vec2 step_by = vec2(reach, 0.0);
  truth edge = reach < 0.0;
  for (int i = 0; i < 8; ++i) {
    vec2 r = seen_and_own(slope + step_by, plane);
    edge = either(edge, either(nearer(r.x, max(r.y, farthest_own), margin), nearer(r.y, r.x, margin)));
    step_by = vec2(step_by.x - step_by.y, step_by.x + step_by.y) * 0.70710678;
  }
  return edge;
}
