// Provides a rectangle in pixels (y down), and which cells matter in it.
uniform vec2 size;

in vec2 in_place;
in uvec4 in_which;

flat out uvec4 which;

void main() {
    which = in_which;
    gl_Position = vec4(2.0 * in_place.x / size.x - 1.0, 1.0 - 2.0 * in_place.y / size.y, 0.0, 1.0);
}
