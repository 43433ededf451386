// Unpainted tissue in warm grey, paint almost as it was photographed; outer edges softened; the glass shell over it.
uniform usampler2D u_seen;
uniform sampler2D u_atlas, u_shell;
uniform vec3 u_ground;
out vec4 o_colour;

// 1 where something is seen, less at the outline.
float cover_at(ivec2 at, uint light) {
  ivec2 last = textureSize(u_seen, 0) - 1;
  uvec4 beside = uvec4(texelFetch(u_seen, min(at + ivec2(1, 0), last), 0).b, texelFetch(u_seen, max(at - ivec2(1, 0), ivec2(0)), 0).b,
                       texelFetch(u_seen, min(at + ivec2(0, 1), last), 0).b, texelFetch(u_seen, max(at - ivec2(0, 1), ivec2(0)), 0).b);
  float empty = dot(vec4(equal(beside, uvec4(0u))), vec4(1.0));
  return light == 0u ? 0.0 : 1.0 - 0.27 * min(empty, 3.0);
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  uvec4 seen = texelFetch(u_seen, at, 0);
  vec4 paint = texture(u_atlas, vec2(seen.rg) / (16.0 * vec2(textureSize(u_atlas, 0))));
#if COLOUR_BY
  paint.rgb = known_colour(vec2(seen.rg) / 16.0) * paint.a;
#endif
  vec2 light = vec2(seen.ba) / 65535.0;
  vec3 tissue = vec3(0.66, 0.59, 0.54) * light.x * (1.0 - paint.a) + paint.rgb * light.y;
  vec3 colour = mix(u_ground, tissue, cover_at(at, seen.b));
#if SHELL
  vec4 shell = texelFetch(u_shell, at, 0);
  colour = colour * (1.0 - shell.a) + shell.rgb;
#endif
  o_colour = vec4(colour, 1.0);
}
