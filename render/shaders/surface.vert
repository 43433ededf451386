// The surface as the eye sees it, lit at its vertices, not pixels: it has fewer of them than the panel.
layout(location = 0) in vec3 a_position;  // M, mm
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec2 a_texel;
uniform mat4 u_view, u_projection;
out vec4 v_seen;      // atlas x y in 1/16 texel, light on bare tissue and on paint in 1/65535
out float v_facing;   // cosine between normal and line of sight

void main() {
  vec4 p = u_view * vec4(a_position, 1.0);
  vec3 light = head_light(p.xyz, mat3(u_view) * a_normal);
  v_seen = vec4(a_texel * 16.0, light.xy * 65535.0);
  v_facing = light.z;
  gl_Position = u_projection * p;
}
