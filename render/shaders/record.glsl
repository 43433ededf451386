// What is kept of a texel besides its colour, and how a new picture meets what was there; see atlas/texel_record.hpp.
// BEST: the picture in which a pixel covers least of the surface wins, else the newest. YIELD: highlights give way.
uniform usampler2D u_before;   // the records before this view
uniform uint u_capture;
uniform vec3 u_view_error;     // mm, rad, pixels
uniform float u_pixel_rad;     // angle of one pixel at the centre
layout(location = 0) out vec4 o_paint;
layout(location = 1) out uvec4 o_record;

uint as_16_bits(float value) { return uint(clamp(value + 0.5, 0.0, 65534.0)); }

// Of a texel at this distance whose normal makes this cosine with the line of sight.
uvec4 record_of(float distance_mm, float cos_angle) {
  float across_mm = u_pixel_rad * distance_mm;
  vec3 parts = u_view_error * vec3(1.0, distance_mm, across_mm);
  return uvec4(u_capture, as_16_bits(degrees(acos(min(cos_angle, 1.0))) * 100.0), as_16_bits(1000.0 * across_mm / cos_angle),
               as_16_bits(1000.0 * length(parts) * sqrt(0.5 + 0.5 / (cos_angle * cos_angle))));
}

// Mirrored light is white, whatever the tissue.
float highlight(vec3 colour) {
#if YIELD
  return smoothstep(0.78, 0.93, min(colour.r, min(colour.g, colour.b)));
#else
  return 0.0;
#endif
}

// Blends over what was there, and says whose texel it is now. `core` is how good this part of the picture is: it counts
// where there is something else. A highlight counts as a picture four times as coarse.
void put(vec3 colour, float weight, float core, uvec4 record) {
  uvec4 before = texelFetch(u_before, ivec2(gl_FragCoord.xy), 0);
  float shine = highlight(colour);
  record.b = min(record.b + uint(3.0 * shine * float(record.b)), 65534u);
  if (before.r != 0u) {
    weight *= core;
#if BEST
    weight *= smoothstep(0.87, 1.15, float(before.b) / float(max(record.b, 1u)));
#else
    weight *= 1.0 - shine;
#endif
  }
  if (weight < 0.004) discard;  // below 1/255: whether it changes a byte is left to each driver
  o_paint = vec4(colour, weight);
  o_record = before.r == 0u || weight >= 0.5 ? record : before;
}
