// paint_texel.glsl on a GPU.
void main() {
  vec4 point = texelFetch(u_points, ivec2(gl_FragCoord.xy), 0);
  paint_texel(point.xyz, point.w);
}
