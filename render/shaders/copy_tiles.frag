// The exact bytes.
uniform sampler2D u_source;
flat in ivec2 v_shift;
out vec4 o_texel;

void main() { o_texel = texelFetch(u_source, ivec2(gl_FragCoord.xy) + v_shift, 0); }
