// The exact bytes. RECORDS: of a picture of integers.
#if RECORDS
uniform usampler2D u_source;
out uvec4 o_texel;
#else
uniform sampler2D u_source;
out vec4 o_texel;
#endif
flat in ivec2 v_shift;

void main() { o_texel = texelFetch(u_source, ivec2(gl_FragCoord.xy) + v_shift, 0); }
