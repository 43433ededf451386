// One instance per tile to be counted; a fragment per 8 x 8 of its texels, so that many are counted side by side.
layout(location = 0) in vec4 a_tile;  // tile x y
uniform float u_grid_size;            // tiles in a row

void main() {
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
  gl_Position = vec4((a_tile.xy + corner) / u_grid_size * 2.0 - 1.0, 0.0, 1.0);
}
