// Provides what a pixel's list adds up to, from the front: colour times opacity, and opacity. The
// nearest SOME of it are put in order and added up, then the nearest of those behind, until none is
// left: a list may be of any length. If it `takes`, the list is taken away: the next frame finds none.
layout(std430, binding = 0) readonly buffer Lists { uint lists[]; };
layout(std430, binding = 1) buffer Heads { uint heads[]; };

uniform int width;     // of the picture, in pixels
uniform int most;      // layers that count
uniform float enough;  // opacity behind which nothing is seen
uniform bool takes;

layout(location = 0) out vec4 picture;

const int SOME = 16;

{{ before }}

void main() {
    int here = int(gl_FragCoord.y) * width + int(gl_FragCoord.x);
    uint head = heads[here];
    if (head == 0u) discard;
    if (takes) heads[here] = 0u;
    uvec3 near[SOME];
    uvec3 last = uvec3(0u);
    bool first = true;
    vec4 total = vec4(0.0);
    int left = most;
    while (left > 0 && total.a < enough) {
        int count = 0;
        uint at = head;
        while (at != 0u) {
            uint k = (at - 1u) * WORDS;
            uvec3 own = uvec3(lists[k + 1u], lists[k + 4u], k);
            if (first || before(last, own)) {
                int i = count;
                while (i > 0) {
                    if (!before(own, near[i - 1])) break;
                    if (i < SOME) near[i] = near[i - 1];
                    i--;
                }
                if (i < SOME) near[i] = own;
                count = min(count + 1, SOME);
            }
            at = lists[k];
        }
        for (int i = 0; i < count && left > 0 && total.a < enough; i++, left--) {
            uint k = near[i].z;
            vec4 layer = vec4(unpackHalf2x16(lists[k + 2u]), unpackHalf2x16(lists[k + 3u]));
            total += (1.0 - total.a) * layer;
        }
        if (count < SOME) break;
        last = near[SOME - 1];
        first = false;
    }
    picture = total;
}
