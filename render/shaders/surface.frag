// What a pixel shows, before paint: its place in the atlas and how much light falls on it; light 0: nothing here.
in vec4 v_seen;
out uvec4 o_seen;

void main() { o_seen = uvec4(v_seen); }
