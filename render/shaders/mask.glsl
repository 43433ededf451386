// How much of a pixel's colour counts: all within the circle that shows something, fading to nothing at its rim and, where
// the circle reaches beyond the picture, at the picture's edge.
vec2 from_circle_centre(vec2 pixel) {
  return (pixel - vec2(u_circle.x, u_circle.y)) * vec2(1.0, u_aspect);
}

real mask_weight(vec2 pixel) {
  return clamp(min(u_circle.z - length(from_circle_centre(pixel)), within_picture(pixel)) / u_circle.w, 0.0, 1.0);
}

// Nothing of what is black about the notch. How deep and wide a maker cuts it is in no passport, and some let it stick
// out: so within the outer eighth of the radius, 6 degrees to each side, darkness decides.
real notch_weight(vec2 pixel, vec3 colour) {
  vec2 d = from_circle_centre(pixel);
  real along = dot(d, u_notch);
  real aside = abs(d.x * u_notch.y - d.y * u_notch.x);
  truth elsewhere = either(along < 0.875 * u_circle.z, aside > 0.1 * along);
  return pick(elsewhere, 1.0, smoothstep(0.05, 0.15, max(colour.x, max(colour.y, colour.z))));
}

// Less than 1 in the outer fifth, where scopes are dim and blurred: what was there before shows through.
real core_weight(vec2 pixel) {
  return smoothstep(0.0, 0.2, 1.0 - length(from_circle_centre(pixel)) / u_circle.z);
}
