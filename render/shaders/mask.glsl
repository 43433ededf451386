// How much of a pixel's colour counts: all within the circle that shows something, fading to nothing at its rim.
uniform vec4 u_circle;   // centre x y, radius, soft edge; px
uniform float u_aspect;  // fx / fy
uniform vec2 u_notch;    // where it is from the centre, pixels made square, unit; 0 0: none

float mask_weight(vec2 pixel) {
  vec2 d = (pixel - u_circle.xy) * vec2(1.0, u_aspect);
  return clamp((u_circle.z - length(d)) / u_circle.w, 0.0, 1.0);
}

// Nothing of what is black about the notch. How deep and wide a maker cuts it is in no passport, and some let it stick
// out: so within the outer eighth of the radius, 6 degrees to each side, darkness decides.
float notch_weight(vec2 pixel, vec3 colour) {
  vec2 d = (pixel - u_circle.xy) * vec2(1.0, u_aspect);
  float along = dot(d, u_notch);
  float aside = abs(d.x * u_notch.y - d.y * u_notch.x);
  if (along < 0.875 * u_circle.z || aside > 0.1 * along) return 1.0;
  return smoothstep(0.05, 0.15, max(colour.r, max(colour.g, colour.b)));
}

// Less than 1 in the outer fifth, where scopes are dim and blurred: what was there before shows through.
float core_weight(vec2 pixel) {
  vec2 d = (pixel - u_circle.xy) * vec2(1.0, u_aspect);
  return smoothstep(0.0, 0.2, 1.0 - length(d) / u_circle.z);
}
