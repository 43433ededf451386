// One rectangle of the atlas per instance.
layout(location = 0) in vec4 a_rect;  // x y width height, texels
uniform float u_atlas_size;

void main() {
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
  gl_Position = vec4((a_rect.xy + corner * a_rect.zw) / u_atlas_size * 2.0 - 1.0, 0.0, 1.0);
}
