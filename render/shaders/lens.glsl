// Direction in the camera frame to pixel; the twin of realtime/optics/lens.cpp. LENS_MODEL: 0 brown, 1 poly4, 2 fisheye.
vec2 brown_pixel(vec3 d) {
  vec2 n = vec2(d) / d.z;
  real r2 = dot(n, n);
  real k1 = u_coefficients[0], k2 = u_coefficients[1], p1 = u_coefficients[2], p2 = u_coefficients[3],
       k3 = u_coefficients[4];
  real radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  vec2 tangential = vec2(2.0 * p1 * n.x * n.y + p2 * (r2 + 2.0 * n.x * n.x),
                         p1 * (r2 + 2.0 * n.y * n.y) + 2.0 * p2 * n.x * n.y);
  return vec2(u_intrinsics.x, u_intrinsics.y) * (n * radial + tangential) + vec2(u_intrinsics.z, u_intrinsics.w);
}

// Corrected radius = r + a2 r^2 + a3 r^3 + a4 r^4, solved for r by a bounded Newton iteration.
real distorted_radius(real corrected) {
  real a2 = u_coefficients[0], a3 = u_coefficients[1], a4 = u_coefficients[2];
  real r = corrected;
  for (int i = 0; i < 8; ++i) {
    real value = r * (1.0 + r * (a2 + r * (a3 + r * a4))) - corrected;
    real slope = 1.0 + r * (2.0 * a2 + r * (3.0 * a3 + r * 4.0 * a4));
    r -= value / max(slope, 1e-3);
  }
  return r;
}

vec2 poly4_pixel(vec3 d) {
  vec2 to_square = vec2(1.0, u_intrinsics.x / u_intrinsics.y);
  vec2 straight = vec2(u_intrinsics.x, u_intrinsics.y) * vec2(d) / d.z + vec2(u_intrinsics.z, u_intrinsics.w);
  vec2 from_centre = (straight - u_distortion_centre) * to_square;
  real corrected = length(from_centre);
  real scale = pick(corrected > 1e-6, distorted_radius(corrected) / corrected, 1.0);
  return from_centre * scale / to_square + u_distortion_centre;
}

vec2 fisheye_pixel(vec3 d) {
  real r = length(vec2(d));
  real theta = atan(r, d.z);
  real t2 = theta * theta;
  real distorted = theta * (1.0 + t2 * (u_coefficients[0] + t2 * (u_coefficients[1] +
                                  t2 * (u_coefficients[2] + t2 * u_coefficients[3]))));
  real scale = pick(r > 1e-9, distorted / r, 0.0);
  return vec2(u_intrinsics.x, u_intrinsics.y) * (vec2(d) * scale) + vec2(u_intrinsics.z, u_intrinsics.w);
}

vec2 lens_pixel(vec3 d) {
  if (LENS_MODEL == 0) return brown_pixel(d);
  if (LENS_MODEL == 1) return poly4_pixel(d);
  return fisheye_pixel(d);
}
