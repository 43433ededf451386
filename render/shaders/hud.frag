// Coverage of one pixel by a letter, a rounded box, its outline, or a stroke with round ends. Colour is premultiplied.
uniform sampler2D u_letters;
flat in vec4 v_rect, v_detail, v_colour, v_shape;
in vec2 v_at;
out vec4 o_colour;

// Distance to the edge of a box with round corners, negative inside.
float rounded_box(vec2 from_centre, vec2 half_size, float radius) {
  vec2 d = abs(from_centre) - half_size + radius;
  return length(max(d, 0.0)) + min(max(d.x, d.y), 0.0) - radius;
}

float stroke(vec2 at, vec2 from, vec2 to, float half_width, float dash) {
  vec2 along = to - from;
  float span = max(length(along), 1e-3);
  float s = clamp(dot(at - from, along) / (span * span), 0.0, 1.0);
  float gap = dash > 0.0 && fract(s * span / (2.0 * dash)) > 0.5 ? 1.0 : 0.0;
  return distance(at, from + s * along) - half_width + gap * 1e3;
}

void main() {
  int kind = int(v_shape.x);
  float cover = 0.0;
  if (kind == 0) {
    cover = texelFetch(u_letters, ivec2(v_detail.xy + v_at - v_rect.xy), 0).r;
  } else if (kind == 3) {
    cover = clamp(0.5 - stroke(v_at, v_detail.xy, v_detail.zw, v_shape.y, v_shape.z), 0.0, 1.0);
  } else {
    float edge = rounded_box(v_at - v_rect.xy - 0.5 * v_rect.zw, 0.5 * v_rect.zw - 1.0, v_shape.y);
    if (kind == 2) edge = abs(edge + 0.5 * v_shape.z) - 0.5 * v_shape.z;
    cover = clamp(0.5 - edge, 0.0, 1.0);
  }
  float alpha = v_colour.a * cover;
  o_colour = vec4(v_colour.rgb * alpha, alpha);
}
