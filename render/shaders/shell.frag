// The near wall as a glass shell: only its rim, premultiplied.
in float v_facing;
out vec4 o_colour;

void main() {
  float rim = 1.0 - min(abs(v_facing), 1.0);
  float alpha = 0.03 + 0.30 * rim * rim * rim;
  o_colour = vec4(vec3(0.75, 0.80, 0.86) * alpha, alpha);
}
