// The newest camera picture, whatever its format; pixel (0,0) is the centre of the top-left one.
uniform int u_picture_format;    // 0 RGBA, 1 NV12, 2 YUYV, 3 UYVY, 4 grey
uniform sampler2D u_luma;        // RGBA, or the plane that holds luma
uniform sampler2D u_chroma;
uniform vec2 u_picture_size;

// BT.601, limited range.
vec3 rgb_of(float y, vec2 cbcr) {
  float l = 1.16438356 * (y - 0.0627451);
  vec2 c = cbcr - 0.50196078;
  return clamp(vec3(l + 1.59602679 * c.y, l - 0.39176229 * c.x - 0.81296765 * c.y, l + 2.01723214 * c.x), 0.0, 1.0);
}

// Chroma is sited with the left luma sample of its pair, and between the two rows it belongs to. Level 0 is the picture,
// each further one half as fine; chroma starts at half.
vec3 picture_at(vec2 pixel, float level) {
  vec2 uv = (pixel + 0.5) / u_picture_size;
  vec4 luma = textureLod(u_luma, uv, level);
  if (u_picture_format == 0) return luma.rgb;
  if (u_picture_format == 4) return luma.rrr;
  vec4 chroma = textureLod(u_chroma, vec2((pixel.x + 1.0) / u_picture_size.x, uv.y), max(level - 1.0, 0.0));
  if (u_picture_format == 1) return rgb_of(luma.r, chroma.rg);
  if (u_picture_format == 2) return rgb_of(luma.r, chroma.ga);
  return rgb_of(luma.g, chroma.rb);
}
