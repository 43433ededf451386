// How many of 8 x 8 texels lie in a triangle and carry paint.
uniform usampler2D u_owner;
uniform sampler2D u_atlas;
out vec4 o_count;

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * 8;
  int painted = 0;
  for (int i = 0; i < 64; ++i) {
    ivec2 at = first + ivec2(i & 7, i >> 3);
    bool own = texelFetch(u_owner, at, 0).r >> 31 == 1u;
    painted += own && texelFetch(u_atlas, at, 0).a > 0.0 ? 1 : 0;
  }
  o_count = vec4(float(painted) / 255.0);
}
