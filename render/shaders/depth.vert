// The cutout as the scope's pinhole sees it.
layout(location = 0) in vec3 a_position;  // M, mm
uniform mat3 u_rotation_CM;
uniform vec3 u_translation_CM;
uniform float u_depth_tangent, u_depth_near, u_depth_far;

void main() {
  vec3 p = u_rotation_CM * a_position + u_translation_CM;
  float range = u_depth_far - u_depth_near;
  float z = p.z * (u_depth_far + u_depth_near) / range - 2.0 * u_depth_far * u_depth_near / range;
  gl_Position = vec4(p.xy / u_depth_tangent, z, p.z);
}
