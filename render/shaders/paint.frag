// One texel: which point of the surface it is, whether the scope sees that point, and what colour it shows there.
uniform usampler2D u_owner;      // triangle number, bit 31: inside its triangle; 0x7FFFFFFF: nothing
uniform sampler2D u_points;      // the point behind the texel, M, mm; its triangle's normal in w
uniform sampler2D u_weights;     // barycentric weights of corners 1 and 2; for paper, as are the next two
uniform usampler2D u_triangles;  // the three vertex numbers
uniform sampler2D u_vertices;    // positions in M, mm
uniform sampler2D u_depth;       // what the scope sees, by a pinhole of tangent u_depth_tangent
uniform usampler2D u_mask;       // paper: one bit per triangle of the cutout

uniform mat3 u_rotation_CM;
uniform vec3 u_translation_CM;
uniform float u_facing;          // +1 seen from outside, -1 from inside
uniform float u_cos_cone, u_far_mm, u_cos_obliquity;
uniform float u_depth_tangent, u_depth_near, u_depth_far;
uniform vec4 u_circle;           // centre x y, radius, soft edge; px
uniform float u_aspect;          // fx / fy
uniform float u_pixel_rad;       // angle of one pixel at the centre
uniform vec4 u_fall_off;         // reference mm (0: none), power of the cosine

uniform int u_paper;
uniform vec3 u_tip, u_view, u_up, u_side;   // M
uniform vec2 u_paper_size;                  // S1, T1
uniform vec4 u_paper_frame;                 // rectified picture: centre x y, half width, half height (tangents)

out vec4 o_paint;

vec3 vertex(uint i) {
  uint width = uint(textureSize(u_vertices, 0).x);
  return texelFetch(u_vertices, ivec2(int(i % width), int(i / width)), 0).xyz;
}

uvec3 corners_of(uint t) {
  uint width = uint(textureSize(u_triangles, 0).x);
  return texelFetch(u_triangles, ivec2(int(t % width), int(t / width)), 0).xyz;
}

float mask_weight(vec2 pixel) {
  vec2 d = (pixel - u_circle.xy) * vec2(1.0, u_aspect);
  return clamp((u_circle.z - length(d)) / u_circle.w, 0.0, 1.0);
}

float depth_mm(vec2 slope) {
  float d = texture(u_depth, slope / u_depth_tangent * 0.5 + 0.5).r;
  return u_depth_near * u_depth_far / (u_depth_far - d * (u_depth_far - u_depth_near));
}

// Where the plane of the texel's own triangle lies along another line of sight; negative where it is not met.
float plane_mm(vec3 normal, float offset, vec2 slope) {
  float along = dot(normal, vec3(slope, 1.0));
  return abs(along) > 0.02 ? offset / along : -1.0;
}

// Hidden when something nearer is seen along this line, or next to it within the reach of the picture's own blur.
bool hidden(vec3 p, vec3 normal) {
  vec2 slope = p.xy / p.z;
  float offset = dot(normal, p);
  float bias = 0.04 + 0.002 * p.z;
  if (depth_mm(slope) < p.z - bias - abs(p.z - plane_mm(normal, offset, slope + vec2(u_pixel_rad * 0.5)))) return true;
  float reach = 1.5 * u_pixel_rad;
  float margin = 0.4 + 0.02 * p.z;
  for (int i = 0; i < 4; ++i) {
    vec2 step_by = i == 0 ? vec2(reach, 0.0) : i == 1 ? vec2(-reach, 0.0) : i == 2 ? vec2(0.0, reach) : vec2(0.0, -reach);
    float own = plane_mm(normal, offset, slope + step_by);
    if (own > 0.0 && depth_mm(slope + step_by) < min(own, p.z + margin) - margin) return true;
  }
  return false;
}

// Dey et al. 2000, equations 2 to 6, with atan2 in place of the cosine alone.
vec2 paper_st(vec3 v) {
  vec3 pv = v - u_tip;
  float r = length(pv);
  float theta = acos(clamp(dot(pv, u_view) / max(r, 1e-6), -1.0, 1.0));
  float phi = atan(dot(pv, u_side), dot(pv, u_up));
  float h = r * sin(theta);
  return vec2(0.5) + vec2(h * sin(phi), h * cos(phi)) / u_paper_size;
}

vec3 unpacked_normal(float packed_normal) {
  vec2 e = vec2(floor(packed_normal / 2048.0), mod(packed_normal, 2048.0)) / 2047.0 * 2.0 - 1.0;
  vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
  float fold = max(-n.z, 0.0);
  n.xy += vec2(n.x >= 0.0 ? -fold : fold, n.y >= 0.0 ? -fold : fold);
  return normalize(n);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  uint owner = texelFetch(u_owner, texel, 0).r & 0x7FFFFFFFu;
  if (owner == 0x7FFFFFFFu) discard;

  if (u_paper == 1) {
    uvec3 c = corners_of(owner);
    vec3 a = vertex(c.x), b = vertex(c.y), d = vertex(c.z);
    vec2 weights = texelFetch(u_weights, texel, 0).rg;
    uint width = uint(textureSize(u_mask, 0).x);
    uint word = texelFetch(u_mask, ivec2(int((owner >> 5) % width), int((owner >> 5) / width)), 0).r;
    if ((word >> (owner & 31u) & 1u) == 0u) discard;
    vec2 sa = paper_st(a), sb = paper_st(b), sd = paper_st(d);
    vec2 st = sa + weights.x * (sb - sa) + weights.y * (sd - sa);
    vec2 slope = u_paper_frame.xy + vec2(2.0 * st.x - 1.0, 1.0 - 2.0 * st.y) * u_paper_frame.zw;
    vec2 pixel = lens_pixel(vec3(slope, 1.0));
    float weight = mask_weight(pixel);
    if (weight <= 0.0) discard;
    o_paint = vec4(picture_at(pixel), weight);
    return;
  }

  vec4 point = texelFetch(u_points, texel, 0);
  vec3 p = u_rotation_CM * point.xyz + u_translation_CM;
  float distance_mm = length(p);
  if (p.z <= 0.05 || distance_mm > u_far_mm || p.z < u_cos_cone * distance_mm) discard;
  vec3 normal = u_rotation_CM * unpacked_normal(point.w) * u_facing;
  if (-dot(normal, p) < u_cos_obliquity * distance_mm) discard;
  vec2 pixel = lens_pixel(p);
  float weight = mask_weight(pixel);
  if (weight <= 0.0 || hidden(p, normal)) discard;
  vec3 colour = picture_at(pixel);
  if (u_fall_off.x > 0.0) {
    float nearness = u_fall_off.x / distance_mm;
    float light = nearness * nearness * pow(p.z / distance_mm, u_fall_off.y);
    colour = min(colour / max(pow(light, 1.0 / 2.2), 0.25), vec3(1.0));
  }
  o_paint = vec4(colour, weight);
}
