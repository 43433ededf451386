// How much of a pixel's colour counts: all within the circle that shows something, fading to nothing at its rim.
uniform vec4 u_circle;   // centre x y, radius, soft edge; px
uniform float u_aspect;  // fx / fy

float mask_weight(vec2 pixel) {
  vec2 d = (pixel - u_circle.xy) * vec2(1.0, u_aspect);
  return clamp((u_circle.z - length(d)) / u_circle.w, 0.0, 1.0);
}

// Less than 1 in the outer fifth, where scopes are dim and blurred: what was there before shows through.
float core_weight(vec2 pixel) {
  vec2 d = (pixel - u_circle.xy) * vec2(1.0, u_aspect);
  return smoothstep(0.0, 0.2, 1.0 - length(d) / u_circle.z);
}
