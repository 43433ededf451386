// A square around the round inset; row 0 of the framebuffer is the top.
uniform vec4 u_box;      // x y width height, px
uniform vec2 u_panel_size;
out vec2 v_place;        // -1..1, y down

void main() {
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
  v_place = corner * 2.0 - 1.0;
  gl_Position = vec4((u_box.xy + corner * u_box.zw) / u_panel_size * 2.0 - 1.0, 0.0, 1.0);
}
