// Where the rules look on a GPU, and where they leave what they found.
uniform sampler2D u_points;   // the point behind the texel, M, mm, out of all reach where there is none; its normal in w
uniform sampler2D u_depth;    // what the scope sees, by a pinhole of tangent u_depth_tangent
uniform usampler2D u_before;  // the records before this view
layout(location = 0) out vec4 o_paint;
layout(location = 1) out uvec4 o_record;

float seen_at(vec2 at) {
  return 1.0 / u_depth_near - texelFetch(u_depth, ivec2(at), 0).r * (1.0 / u_depth_near - 1.0 / u_depth_far);
}
vec4 record_before() { return vec4(texelFetch(u_before, ivec2(gl_FragCoord.xy), 0)); }

void keep(vec3 colour, float weight, vec4 record) {
  o_paint = vec4(colour, weight);
  o_record = uvec4(record);
}
