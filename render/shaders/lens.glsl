// Direction in the camera frame to pixel; the twin of realtime/optics/lens.cpp. LENS_MODEL: 0 brown, 1 poly4, 2 fisheye;
// chosen when compiled, because a software driver goes through every branch that could be taken.
uniform vec4 u_intrinsics;  // fx fy cx cy
uniform float u_coefficients[5];

#if LENS_MODEL == 0
vec2 lens_pixel(vec3 d) {
  vec2 n = d.xy / d.z;
  float r2 = dot(n, n);
  float k1 = u_coefficients[0], k2 = u_coefficients[1], p1 = u_coefficients[2], p2 = u_coefficients[3],
        k3 = u_coefficients[4];
  float radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  vec2 tangential = vec2(2.0 * p1 * n.x * n.y + p2 * (r2 + 2.0 * n.x * n.x),
                         p1 * (r2 + 2.0 * n.y * n.y) + 2.0 * p2 * n.x * n.y);
  return u_intrinsics.xy * (n * radial + tangential) + u_intrinsics.zw;
}
#elif LENS_MODEL == 1
uniform vec2 u_distortion_centre;

// Corrected radius = r + a2 r^2 + a3 r^3 + a4 r^4, solved for r by a bounded Newton iteration.
float distorted_radius(float corrected) {
  float a2 = u_coefficients[0], a3 = u_coefficients[1], a4 = u_coefficients[2];
  float r = corrected;
  for (int i = 0; i < 8; ++i) {
    float value = r * (1.0 + r * (a2 + r * (a3 + r * a4))) - corrected;
    float slope = 1.0 + r * (2.0 * a2 + r * (3.0 * a3 + r * 4.0 * a4));
    r -= value / max(slope, 1e-3);
  }
  return r;
}

vec2 lens_pixel(vec3 d) {
  vec2 to_square = vec2(1.0, u_intrinsics.x / u_intrinsics.y);
  vec2 square = (u_intrinsics.xy * d.xy / d.z + u_intrinsics.zw - u_distortion_centre) * to_square;
  float corrected = length(square);
  float scale = corrected > 1e-6 ? distorted_radius(corrected) / corrected : 1.0;
  return square * scale / to_square + u_distortion_centre;
}
#else
vec2 lens_pixel(vec3 d) {
  float r = length(d.xy);
  float theta = atan(r, d.z);
  float t2 = theta * theta;
  float distorted = theta * (1.0 + t2 * (u_coefficients[0] + t2 * (u_coefficients[1] +
                                   t2 * (u_coefficients[2] + t2 * u_coefficients[3]))));
  return u_intrinsics.xy * (r > 1e-9 ? d.xy * (distorted / r) : vec2(0.0)) + u_intrinsics.zw;
}
#endif
