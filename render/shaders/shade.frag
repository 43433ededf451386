// What is seen at each pixel, by its place in the atlas and its light; the glass shell over it.
uniform usampler2D u_seen;
uniform sampler2D u_atlas, u_shell;
uniform usampler2D u_records;
uniform vec3 u_ground;
out vec4 o_colour;

// 1 where something is seen, less at the outline.
float cover_at(ivec2 at, uint light) {
  ivec2 last = textureSize(u_seen, 0) - 1;
  uvec4 beside = uvec4(texelFetch(u_seen, min(at + ivec2(1, 0), last), 0).b, texelFetch(u_seen, max(at - ivec2(1, 0), ivec2(0)), 0).b,
                       texelFetch(u_seen, min(at + ivec2(0, 1), last), 0).b, texelFetch(u_seen, max(at - ivec2(0, 1), ivec2(0)), 0).b);
  return light == 0u ? 0.0 : outline_cover(dot(vec4(equal(beside, uvec4(0u))), vec4(1.0)));
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  uvec4 seen = texelFetch(u_seen, at, 0);
  vec4 paint = texture(u_atlas, vec2(seen.rg) / (16.0 * vec2(textureSize(u_atlas, 0))));
#if COLOUR_BY
  paint.rgb = known_colour(vec4(texelFetch(u_records, ivec2(seen.rg / 16u), 0))) * paint.a;
#endif
  vec3 colour = mix(u_ground, tissue(paint.rgb, paint.a, vec2(seen.ba) / 65535.0), cover_at(at, seen.b));
#if SHELL
  vec4 shell = texelFetch(u_shell, at, 0);
  colour = colour * (1.0 - shell.a) + shell.rgb;
#endif
  o_colour = vec4(colour, 1.0);
}
