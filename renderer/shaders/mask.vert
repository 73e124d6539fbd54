// Provides a vertex of a mask in pixels, y down, with what the fragment needs to find its distance.
uniform vec2 size;

in vec2 in_place;
in vec3 in_data;  // offset from the outline (x, y) and −1; or 0, 0 and a channel

out vec2 offset;
flat out int channel;

void main() {
    offset = in_data.xy;
    channel = int(in_data.z);
    gl_Position = vec4(2.0 * in_place.x / size.x - 1.0, 1.0 - 2.0 * in_place.y / size.y, 0.0, 1.0);
}
