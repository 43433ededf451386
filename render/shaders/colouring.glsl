// What is known of a texel as a colour; the twin of atlas/colouring.cpp. COLOUR_BY: 1 capture, 2 angle, 3 resolution, 4 error.
uniform real u_end_of_ramp;

vec3 on_ramp(real share) {
  real at = 4.0 * clamp(share, 0.0, 1.0);
  vec3 colour = mix(vec3(0.993, 0.906, 0.144), vec3(0.369, 0.789, 0.383), clamp(at, 0.0, 1.0));
  colour = mix(colour, vec3(0.128, 0.567, 0.551), clamp(at - 1.0, 0.0, 1.0));
  colour = mix(colour, vec3(0.229, 0.322, 0.546), clamp(at - 2.0, 0.0, 1.0));
  return mix(colour, vec3(0.267, 0.005, 0.329), clamp(at - 3.0, 0.0, 1.0));
}

// A third of a turn apart for red, green and blue.
real of_hue(real hue) { return 0.35 + 0.6 * clamp(abs(fract(hue) * 6.0 - 3.0) - 1.0, 0.0, 1.0); }

vec3 known_colour(vec4 record) {
  real hue = fract(record.x * 0.618034);
  if (COLOUR_BY == 1) return vec3(of_hue(hue), of_hue(hue + 0.33333333), of_hue(hue + 0.66666667));
  if (COLOUR_BY == 2) return on_ramp(record.y / 100.0 / u_end_of_ramp);
  if (COLOUR_BY == 3) return on_ramp(record.z / 1000.0 / u_end_of_ramp);
  return on_ramp(record.w / 1000.0 / u_end_of_ramp);
}
