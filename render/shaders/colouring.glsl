// What is known of a texel as a colour; the twin of atlas/colouring.cpp. COLOUR_BY: 1 capture, 2 angle, 3 resolution, 4 error.
uniform usampler2D u_records;
uniform float u_end_of_ramp;

vec3 on_ramp(float share) {
  const vec3 ramp[5] = vec3[5](vec3(0.993, 0.906, 0.144), vec3(0.369, 0.789, 0.383), vec3(0.128, 0.567, 0.551),
                               vec3(0.229, 0.322, 0.546), vec3(0.267, 0.005, 0.329));
  float at = 4.0 * clamp(share, 0.0, 1.0);
  int first = min(3, int(at));
  return mix(ramp[first], ramp[first + 1], at - float(first));
}

vec3 known_colour(vec2 texel) {
  uvec4 record = texelFetch(u_records, ivec2(texel), 0);
#if COLOUR_BY == 1
  float hue = fract(float(record.r) * 0.618034);
  return 0.35 + 0.6 * clamp(abs(fract(hue + vec3(0.0, 1.0, 2.0) / 3.0) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
#elif COLOUR_BY == 2
  return on_ramp(float(record.g) / 100.0 / u_end_of_ramp);
#elif COLOUR_BY == 3
  return on_ramp(float(record.b) / 1000.0 / u_end_of_ramp);
#else
  return on_ramp(float(record.a) / 1000.0 / u_end_of_ramp);
#endif
}
