// What is kept of a texel besides its colour, and how a new picture meets what was there; see atlas/texel_record.hpp.
// BEST: the picture in which a pixel covers least of the surface wins, else the newest. YIELD: highlights give way.
// A record, whose whole numbers are reals here: x capture, y angle, z footprint, w predicted error.
real in_16_bits(real value) { return floor(clamp(value + 0.5, 0.0, 65534.0)); }

// Of a texel at this distance whose normal makes this cosine with the line of sight.
vec4 record_of(real distance_mm, real cos_angle) {
  real across_mm = u_pixel_rad * distance_mm;
  vec3 parts = u_view_error * vec3(1.0, distance_mm, across_mm);
  return vec4(u_capture, in_16_bits(degrees(acos(min(cos_angle, 1.0))) * 100.0), in_16_bits(1000.0 * across_mm / cos_angle),
              in_16_bits(1000.0 * length(parts) * sqrt(0.5 + 0.5 / (cos_angle * cos_angle))));
}

// Mirrored light is white, whatever the tissue.
real highlight(vec3 colour) {
  if (!YIELD) return 0.0;
  return smoothstep(0.78, 0.93, min(colour.x, min(colour.y, colour.z)));
}

// Blends over what was there, and says whose texel it is now. `core` is how good this part of the picture is: it counts
// where there is something else. A highlight counts as a picture four times as coarse.
void put(vec3 colour, real weight, real core, vec4 record) {
  vec4 before = record_before();
  truth bare = before.x == 0.0;
  real shine = highlight(colour);
  record.z = min(record.z + floor(3.0 * shine * record.z), 65534.0);
  real over = BEST ? smoothstep(0.87, 1.15, before.z / max(record.z, 1.0)) : 1.0 - shine;
  weight *= pick(bare, 1.0, core * over);
  GIVE_UP_WHERE(weight < 0.004);  // below 1/255: whether it changes a byte is left to each driver
  keep(colour, weight, pick(either(bare, weight >= 0.5), record, before));
}
