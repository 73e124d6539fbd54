// Provides a block of pixels as a point, and which cells matter in it.
uniform vec2 size;  // of whole blocks

in vec2 in_place;  // left, top, y down
in uvec4 in_which;

flat out uvec4 which;

void main() {
    which = in_which;
    vec2 middle = in_place + 4.0;
    gl_Position = vec4(2.0 * middle.x / size.x - 1.0, 1.0 - 2.0 * middle.y / size.y, 0.0, 1.0);
    gl_PointSize = 8.0;
}
