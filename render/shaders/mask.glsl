// How much of a pixel's colour counts: all within the circle that shows something, fading to nothing at its rim and at
// the notch.
uniform vec4 u_circle;   // centre x y, radius, soft edge; px
uniform float u_aspect;  // fx / fy
uniform vec2 u_notch;    // where it is from the centre, pixels made square, unit; 0 0: none

// How deep and how wide a maker cuts the notch is in no passport: the outer eighth of the radius, 6 degrees to each side.
float beside_notch(vec2 d) {
  float along = dot(d, u_notch);
  float aside = abs(d.x * u_notch.y - d.y * u_notch.x);
  return max(0.875 * u_circle.z - along, aside - 0.1 * along);
}

float mask_weight(vec2 pixel) {
  vec2 d = (pixel - u_circle.xy) * vec2(1.0, u_aspect);
  return clamp(min(u_circle.z - length(d), beside_notch(d)) / u_circle.w, 0.0, 1.0);
}

// Less than 1 in the outer fifth, where scopes are dim and blurred: what was there before shows through.
float core_weight(vec2 pixel) {
  vec2 d = (pixel - u_circle.xy) * vec2(1.0, u_aspect);
  return smoothstep(0.0, 0.2, 1.0 - length(d) / u_circle.z);
}
