// The surface as the eye sees it. A head-light, a little from the upper left, so that shape reads; worked out here and
// not a pixel, since a surface has fewer vertices than the panel has pixels.
layout(location = 0) in vec3 a_position;  // M, mm
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec2 a_texel;
uniform mat4 u_view, u_projection;
out vec4 v_seen;      // atlas x y in 1/16 texel, light on bare tissue and on paint in 1/65535
out float v_facing;   // cosine between normal and line of sight

void main() {
  vec4 p = u_view * vec4(a_position, 1.0);
  vec3 normal = normalize(mat3(u_view) * a_normal);
  v_facing = dot(normal, normalize(-p.xyz));
  normal = v_facing < 0.0 ? -normal : normal;
  float lambert = max(dot(normal, normalize(vec3(-0.35, 0.45, 1.0))), 0.0);
  float bare = 0.16 + 0.84 * lambert * (0.45 + 0.55 * abs(v_facing));
  v_seen = vec4(a_texel * 16.0, bare * 65535.0, (0.86 + 0.14 * lambert) * 65535.0);
  gl_Position = u_projection * p;
}
