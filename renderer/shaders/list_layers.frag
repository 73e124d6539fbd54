// Provides the nearest four surfaces of a pixel's list behind those that were taken before, and takes
// them. Takes the list away where nothing is left of it, or no more is wanted: the next frame finds
// none. A template.
layout(std430, binding = 0) readonly buffer Lists { uint lists[]; };
layout(std430, binding = 1) buffer Heads { uint heads[]; };
layout(std430, binding = 3) buffer Last { uint taken[]; };  // each pixel's last one, from 1

uniform int width;  // of the picture, in pixels
uniform int most;   // layers that are wanted, 4 or fewer
uniform bool last;  // whether none is wanted after these

layout(location = 0) out vec4 colors[4];   // times opacity, and opacity
layout(location = 4) out uvec2 places[4];  // the object's number + 1, the normal; 0 where nothing is

{{ before }}

uvec3 key(uint at) {
    uint k = (at - 1u) * WORDS;
    return uvec3(lists[k + 1u], lists[k + 4u], at);
}

vec4 color_of(uint at) {
    uint k = (at - 1u) * WORDS;
    return at == 0u ? vec4(0.0) : vec4(unpackHalf2x16(lists[k + 2u]), unpackHalf2x16(lists[k + 3u]));
}

uvec2 place_of(uvec3 own) {
    return own.z == 0u ? uvec2(0u) : uvec2(own.y + 1u, lists[(own.z - 1u) * WORDS + 5u]);
}

void main() {
    int here = int(gl_FragCoord.y) * width + int(gl_FragCoord.x);
    uint at = heads[here], before_these = taken[here];
    uvec3 behind = before_these == 0u ? uvec3(0u) : key(before_these);
    // The nearest four by name: a field of them would be looked up in memory.
    const uvec3 NONE = uvec3(0xffffffffu, 0u, 0u);
    uvec3 a = NONE, b = NONE, c = NONE, d = NONE;
    while (at != 0u) {
        uvec3 own = key(at);
        if ((before_these == 0u || before(behind, own)) && before(own, d)) {
            d = own;
            if (before(d, c)) { uvec3 t = c; c = d; d = t; }
            if (before(c, b)) { uvec3 t = b; b = c; c = t; }
            if (before(b, a)) { uvec3 t = a; a = b; b = t; }
        }
        at = lists[(at - 1u) * WORDS];
    }
    if (most < 4) d = NONE;
    if (most < 3) c = NONE;
    if (most < 2) b = NONE;
    if (last || d.z == 0u) {
        heads[here] = 0u;
        taken[here] = 0u;
    } else {
        taken[here] = d.z;
    }
    colors[0] = color_of(a.z);
    colors[1] = color_of(b.z);
    colors[2] = color_of(c.z);
    colors[3] = color_of(d.z);
    places[0] = place_of(a);
    places[1] = place_of(b);
    places[2] = place_of(c);
    places[3] = place_of(d);
}
