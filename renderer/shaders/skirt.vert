// Provides a vertex of an outline's skirt with its offset from the outline, in pixels.
// Pieces inside the target are left out: where it covers both probes and the middle between them.
uniform vec2 size;        // of the window, in pixels
uniform ivec2 shift;      // from the window's pixels (y up) to the tile
uniform ivec4 tile;       // left, bottom, right, top in the texture
uniform sampler2D turns;  // not 0 on the target

in vec2 in_place;   // y down
in vec2 in_offset;
in vec4 in_probes;

out vec2 offset;

bool covered(vec2 place) {
    ivec2 texel = ivec2(floor(vec2(place.x, size.y - place.y))) + shift;
    if (any(lessThan(texel, tile.xy)) || any(greaterThanEqual(texel, tile.zw))) return false;
    return abs(texelFetch(turns, texel, 0).r) > 0.5;
}

void main() {
    offset = in_offset;
    gl_Position = vec4(2.0 * in_place.x / size.x - 1.0, 1.0 - 2.0 * in_place.y / size.y, 0.0, 1.0);
    vec2 from = in_probes.xy, to = in_probes.zw;
    if (distance(from, to) < 4.0 && covered(from) && covered(to) && covered((from + to) / 2.0)) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // outside the picture
    }
}
