// Square tiles from one picture to another, one per instance.
layout(location = 0) in vec4 a_tile;  // from x y, to x y; texels
uniform float u_target_size, u_tile_size;
flat out ivec2 v_shift;

void main() {
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
  v_shift = ivec2(a_tile.xy) - ivec2(a_tile.zw);
  gl_Position = vec4((a_tile.zw + corner * u_tile_size) / u_target_size * 2.0 - 1.0, 0.0, 1.0);
}
