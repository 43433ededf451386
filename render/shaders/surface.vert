// The surface as the eye sees it.
layout(location = 0) in vec3 a_position;  // M, mm
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec2 a_texel;
uniform mat4 u_view, u_projection;
out vec3 v_position, v_normal;
out vec2 v_texel;

void main() {
  vec4 p = u_view * vec4(a_position, 1.0);
  v_position = p.xyz;
  v_normal = mat3(u_view) * a_normal;
  v_texel = a_texel;
  gl_Position = u_projection * p;
}
