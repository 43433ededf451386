// The picture's planes on a GPU; shaders/picture.glsl makes colours of them.
uniform int u_picture_format;
uniform sampler2D u_luma;    // RGBA, or the plane that holds luma
uniform sampler2D u_chroma;
#define PICTURE_FORMAT u_picture_format

vec4 luma_at(vec2 uv, float level) { return textureLod(u_luma, uv, level); }
vec4 chroma_at(vec2 uv, float level) { return textureLod(u_chroma, uv, level); }
