// What a pixel shows, before paint: its place in the atlas and how much light falls on it. A head-light, a little from
// the upper left, so that shape reads.
in vec3 v_position, v_normal;
in vec2 v_texel;
out uvec4 o_seen;  // atlas x y in 1/16 texel, light on bare tissue (0: nothing here), light on paint

void main() {
  vec3 to_eye = normalize(-v_position);
  vec3 normal = normalize(v_normal);
  float facing = dot(normal, to_eye);
  normal = facing < 0.0 ? -normal : normal;
  float lambert = max(dot(normal, normalize(vec3(-0.35, 0.45, 1.0))), 0.0);
  float bare = 0.16 + 0.84 * lambert * (0.45 + 0.55 * abs(facing));
  o_seen = uvec4(vec4(v_texel * 16.0, bare * 65535.0, (0.86 + 0.14 * lambert) * 65535.0));
}
