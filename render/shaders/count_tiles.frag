// How many texels of a tile lie in a triangle and carry paint: low byte, high byte.
uniform usampler2D u_owner;
uniform sampler2D u_atlas;
uniform int u_tile_size;
out vec4 o_count;

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * u_tile_size;
  int painted = 0;
  for (int y = 0; y < u_tile_size; ++y)
    for (int x = 0; x < u_tile_size; ++x) {
      uint owner = texelFetch(u_owner, first + ivec2(x, y), 0).r;
      if (owner >> 31 == 1u && texelFetch(u_atlas, first + ivec2(x, y), 0).a > 0.0) ++painted;
    }
  o_count = vec4(float(painted & 255) / 255.0, float(painted >> 8) / 255.0, 0.0, 1.0);
}
