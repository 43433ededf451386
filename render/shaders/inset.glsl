// The live picture in its round inset, the camera's circle filling it. `place`: -1 to 1 across the inset, y down.
vec2 inset_pixel(vec2 place) { return vec2(u_circle.x, u_circle.y) + place * vec2(1.0, 1.0 / u_aspect) * u_circle.z; }

// One level of the picture, not two: a software driver would pay for both.
real inset_level(real radius_px) { return floor(log2(max(u_circle.z / radius_px, 1.0)) + 0.5); }

real inset_cover(vec2 place, real radius_px) { return clamp((1.0 - length(place)) * radius_px, 0.0, 1.0); }
