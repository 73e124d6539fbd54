// Provides what a pixel's list adds up to, from the front: colour times opacity, and opacity. The
// nearest four of it are put in order and added up, then the nearest of those behind, until none is
// left: a list may be of any length. It is taken away: the next frame finds none. A template.
layout(std430, binding = 0) readonly buffer Lists { uint lists[]; };
layout(std430, binding = 1) buffer Heads { uint heads[]; };

uniform int width;     // of the picture, in pixels
uniform int most;      // layers that count
uniform float enough;  // opacity behind which nothing is seen

layout(location = 0) out vec4 picture;

{{ before }}

const uvec3 NONE = uvec3(0xffffffffu, 0u, 0u);

vec4 total = vec4(0.0);

// A surface behind those that were added, unless `count`, those before it at once, were all.
void add(uvec3 own, int count, int left) {
    if (own.x == NONE.x || count >= left || total.a >= enough) return;
    uint k = own.z;
    vec4 layer = vec4(unpackHalf2x16(lists[k + 2u]), unpackHalf2x16(lists[k + 3u]));
    total += (1.0 - total.a) * layer;
}

void main() {
    int here = int(gl_FragCoord.y) * width + int(gl_FragCoord.x);
    uint head = heads[here];
    if (head == 0u) discard;
    heads[here] = 0u;
    uvec3 last = uvec3(0u);
    bool first = true;
    int left = most;
    while (left > 0 && total.a < enough && last.x != NONE.x) {
        // By name: a field of them would be looked up in memory.
        uvec3 a = NONE, b = NONE, c = NONE, d = NONE;
        uint at = head;
        while (at != 0u) {
            uint k = (at - 1u) * WORDS;
            uvec3 own = uvec3(lists[k + 1u], lists[k + 4u], k);
            if ((first || before(last, own)) && before(own, d)) {
                d = own;
                if (before(d, c)) { uvec3 t = c; c = d; d = t; }
                if (before(c, b)) { uvec3 t = b; b = c; c = t; }
                if (before(b, a)) { uvec3 t = a; a = b; b = t; }
            }
            at = lists[k];
        }
        add(a, 0, left);
        add(b, 1, left);
        add(c, 2, left);
        add(d, 3, left);
        left -= 4;
        last = d;
        first = false;
    }
    picture = total;
}
