// The near wall as a glass shell: only its rim, premultiplied.
in vec3 v_position, v_normal;
in vec2 v_texel;
out vec4 o_colour;

void main() {
  float rim = 1.0 - abs(dot(normalize(v_normal), normalize(-v_position)));
  float alpha = 0.03 + 0.30 * rim * rim * rim;
  o_colour = vec4(vec3(0.75, 0.80, 0.86) * alpha, alpha);
}
