in vec2 v_place;
uniform float u_radius_px; // of the inset on the panel
out vec4 o_colour;

void main() {
  float cover = inset_cover(v_place, u_radius_px);
  if (cover <= 0.0) discard;
  o_colour = vec4(inset_colour(v_place, u_radius_px), cover);
}
