// Provides a vertex of a mask in pixels, y down, with what the fragment needs to find its distance.
uniform vec2 size;

in vec2 in_place;
in vec2 in_offset;  // along an edge of a hull and off it; or from an ellipse's centre, by its axes
in float in_kind;   // from 0: the ring's grid
in vec2 in_extra;   // the edge's length; semi-axes; or the way from the window's pixels to the tile

out vec2 offset;
flat out int kind;
flat out vec2 extra;

void main() {
    offset = in_offset;
    kind = int(in_kind);
    extra = in_extra;
    gl_Position = vec4(2.0 * in_place.x / size.x - 1.0, 1.0 - 2.0 * in_place.y / size.y, 0.0, 1.0);
}
