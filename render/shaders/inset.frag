// The live picture, its circle filling the inset.
in vec2 v_place;
uniform float u_radius_px; // of the inset on the panel
out vec4 o_colour;

void main() {
  float r = length(v_place);
  float cover = clamp((1.0 - r) * u_radius_px, 0.0, 1.0);
  if (cover <= 0.0) discard;
  vec2 pixel = u_circle.xy + v_place * vec2(1.0, 1.0 / u_aspect) * u_circle.z;
  float level = floor(log2(max(u_circle.z / u_radius_px, 1.0)) + 0.5);  // one of them: two cost a software driver twice
  o_colour = vec4(picture_at(pixel, level), cover);
}
