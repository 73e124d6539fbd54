// Provides a rectangle in pixels (y down) at one depth.
uniform vec2 size;
uniform float depth;  // in clip space, −1 nearest

in vec2 in_place;

void main() {
    gl_Position = vec4(2.0 * in_place.x / size.x - 1.0, 1.0 - 2.0 * in_place.y / size.y, depth, 1.0);
}
