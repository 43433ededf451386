in float v_facing;
out vec4 o_colour;

void main() { o_colour = glass(v_facing); }
