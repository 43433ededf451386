// One texel in paper mode: texture coordinates of its triangle's corners, interpolated; no test but the triangle's own bit.
uniform usampler2D u_owner;      // triangle number, bit 31: inside its triangle; 0x7FFFFFFF: nothing
uniform usampler2D u_triangles;  // the three vertex numbers
uniform sampler2D u_vertices;    // positions in M, mm
uniform usampler2D u_mask;       // one bit per triangle of the cutout

uniform vec3 u_tip, u_view, u_up, u_side;   // M
uniform vec2 u_paper_size;                  // S1, T1
uniform float u_half_width_slope;           // of the rectified picture, a square about the optical axis

vec3 vertex(uint i) {
  uint width = uint(textureSize(u_vertices, 0).x);
  return texelFetch(u_vertices, ivec2(int(i % width), int(i / width)), 0).xyz;
}

bool in_cutout(uint triangle) {
  uint width = uint(textureSize(u_mask, 0).x), word = triangle >> 5;
  return (texelFetch(u_mask, ivec2(int(word % width), int(word / width)), 0).r >> (triangle & 31u) & 1u) == 1u;
}

// Dey et al. 2000, equations 2 to 6, with atan2 in place of the cosine alone.
vec2 paper_st(vec3 v) {
  vec3 pv = v - u_tip;
  float theta = atan(length(cross(pv, u_view)), dot(pv, u_view));
  float phi = atan(dot(pv, u_side), dot(pv, u_up));
  float h = length(pv) * sin(theta);
  return vec2(0.5) + vec2(h * sin(phi), h * cos(phi)) / u_paper_size;
}

// Barycentric weights of corners 1 and 2 of a point in the plane of a triangle (Ericson 2005, section 3.4).
vec2 weights_of(vec3 p, vec3 a, vec3 b, vec3 c) {
  vec3 u = b - a, v = c - a, w = p - a;
  float uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), wu = dot(w, u), wv = dot(w, v);
  return vec2(vv * wu - uv * wv, uu * wv - uv * wu) / (uu * vv - uv * uv);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  uint owner = texelFetch(u_owner, texel, 0).r & 0x7FFFFFFFu;
  if (owner == 0x7FFFFFFFu || !in_cutout(owner)) discard;
  uint width = uint(textureSize(u_triangles, 0).x);
  uvec3 corners = texelFetch(u_triangles, ivec2(int(owner % width), int(owner / width)), 0).xyz;
  vec3 a = vertex(corners.x), b = vertex(corners.y), c = vertex(corners.z);
  vec4 point = texelFetch(u_points, texel, 0);
  vec2 weights = weights_of(point.xyz, a, b, c);
  vec2 sa = paper_st(a);
  vec2 st = sa + weights.x * (paper_st(b) - sa) + weights.y * (paper_st(c) - sa);
  vec2 slope = vec2(2.0 * st.x - 1.0, 1.0 - 2.0 * st.y) * u_half_width_slope;
  vec2 pixel = lens_pixel(vec3(slope, 1.0));
  float weight = mask_weight(pixel);
  if (weight <= 0.0 || any(greaterThan(abs(st - 0.5), vec2(0.5)))) discard;
  vec3 p = u_rotation_CM * point.xyz + u_translation_CM;
  float distance_mm = length(p);
  float cos_angle = clamp(abs(dot(u_rotation_CM * unpacked_normal(point.w), p)) / distance_mm, 0.02, 1.0);
  vec3 colour = picture_at(pixel, picture_level(distance_mm, cos_angle));
  weight *= notch_weight(pixel, colour);
  if (weight <= 0.0) discard;
  put(evened_out(colour, p, distance_mm, cos_angle), weight, 1.0, record_of(distance_mm, cos_angle));
}
