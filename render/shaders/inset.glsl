// The live picture in its round inset, the camera's circle filling it. `place`: -1 to 1 across the inset, y down.
vec2 inset_pixel(vec2 place) { return vec2(u_circle.x, u_circle.y) + place * vec2(1.0, 1.0 / u_aspect) * u_circle.z; }

// One level of the picture, not two: a software driver would pay for both.
real inset_level(real radius_px) { return floor(log2(max(u_circle.z / radius_px, 1.0)) + 0.5); }

// Black beside the picture, where the circle reaches beyond it.
vec3 inset_colour(vec2 place, real radius_px) {
  vec2 pixel = inset_pixel(place);
  return picture_at(pixel, inset_level(radius_px)) * clamp(within_picture(pixel) + 0.5, 0.0, 1.0);
}

real inset_cover(vec2 place, real radius_px) { return clamp((1.0 - length(place)) * radius_px, 0.0, 1.0); }
