// Provides a corner of an outline's triangles, in pixels.
uniform vec2 size;  // of the window

in vec2 in_place;  // y down

void main() {
    gl_Position = vec4(2.0 * in_place.x / size.x - 1.0, 1.0 - 2.0 * in_place.y / size.y, 0.0, 1.0);
}
