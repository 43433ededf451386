// Unpainted tissue in warm grey under a head-light; paint almost as it was photographed. As a shell: only its rim.
in vec3 v_position, v_normal;
in vec2 v_uv;
uniform sampler2D u_atlas;
uniform int u_shell;
out vec4 o_colour;

void main() {
  vec3 to_eye = normalize(-v_position);
  float facing = abs(dot(normalize(v_normal), to_eye));
  if (u_shell == 1) {
    float rim = 1.0 - facing;
    o_colour = vec4(0.75, 0.80, 0.86, 0.03 + 0.30 * rim * rim * rim);
    return;
  }
  vec3 light = normalize(vec3(-0.35, 0.45, 1.0));
  vec3 normal = normalize(v_normal) * (dot(v_normal, to_eye) < 0.0 ? -1.0 : 1.0);
  float lambert = max(dot(normal, light), 0.0);
  vec3 bare = vec3(0.66, 0.59, 0.54) * (0.16 + 0.84 * lambert * (0.45 + 0.55 * facing));
  vec4 paint = texture(u_atlas, v_uv);
  vec3 painted = paint.rgb * (0.86 + 0.14 * lambert);
  o_colour = vec4(bare * (1.0 - paint.a) + painted, 1.0);
}
