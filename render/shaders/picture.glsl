// The newest camera picture, whatever its format; pixel (0,0) is the centre of the top-left one.
// PICTURE_FORMAT: 0 RGBA, 1 NV12, 2 YUYV, 3 UYVY, 4 grey.

// BT.601, limited range.
vec3 rgb_of(real y, vec2 cbcr) {
  real l = 1.16438356 * (y - 0.0627451);
  vec2 c = cbcr - 0.50196078;
  return clamp(vec3(l + 1.59602679 * c.y, l - 0.39176229 * c.x - 0.81296765 * c.y, l + 2.01723214 * c.x), 0.0, 1.0);
}

// From the pixel to the nearest edge of the picture, pixels made square; negative beside it.
real within_picture(vec2 pixel) {
  return min(min(pixel.x + 0.5, u_picture_size.x - 0.5 - pixel.x),
             min(pixel.y + 0.5, u_picture_size.y - 0.5 - pixel.y) * u_aspect);
}

// Chroma is sited with the left luma sample of its pair, and between the two rows it belongs to. Level 0 is the picture,
// each further one half as fine; chroma starts at half.
vec3 picture_at(vec2 pixel, real level) {
  vec2 uv = (pixel + 0.5) / u_picture_size;
  vec4 luma = luma_at(uv, level);
  if (PICTURE_FORMAT == 0) return vec3(luma.x, luma.y, luma.z);
  if (PICTURE_FORMAT == 4) return vec3(luma.x, luma.x, luma.x);
  vec4 chroma = chroma_at(vec2((pixel.x + 1.0) / u_picture_size.x, uv.y), max(level - 1.0, 0.0));
  if (PICTURE_FORMAT == 1) return rgb_of(luma.x, vec2(chroma.x, chroma.y));
  if (PICTURE_FORMAT == 2) return rgb_of(luma.x, vec2(chroma.y, chroma.w));
  return rgb_of(luma.y, vec2(chroma.x, chroma.z));
}
