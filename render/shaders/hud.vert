// A rectangle of the panel per instance: a letter, a box or a stroke.
layout(location = 0) in vec4 a_rect;    // x y width height; panel px, y down
layout(location = 1) in vec4 a_detail;  // letter: x y in the letters' picture; stroke: its two ends
layout(location = 2) in vec4 a_colour;
layout(location = 3) in vec4 a_shape;   // kind, radius or half width, width of the outline or length of a dash

uniform vec2 u_panel_size;
flat out vec4 v_rect, v_detail, v_colour, v_shape;
out vec2 v_at;

void main() {
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
  v_rect = a_rect;
  v_detail = a_detail;
  v_colour = a_colour;
  v_shape = a_shape;
  v_at = a_rect.xy + corner * a_rect.zw;
  if (int(a_shape.x) == 3) {  // a stroke lies along its two ends, one pixel larger all round
    vec2 along = normalize(a_detail.zw - a_detail.xy + vec2(1e-6, 0.0));
    float reach = a_shape.y + 1.0;
    v_at = mix(a_detail.xy - along * reach, a_detail.zw + along * reach, corner.x) +
           vec2(-along.y, along.x) * reach * (2.0 * corner.y - 1.0);
  }
  vec2 clip = v_at / u_panel_size * 2.0 - 1.0;
  gl_Position = vec4(clip, 0.0, 1.0);
}
