// Provides the picture from what a pass gathered: SORTED (the exact picture, from each pixel's
// list), UNDER (a share of another picture, blended or added) or AVERAGE (of weighted sums).
out vec4 result;

#ifdef SORTED
struct Entry { vec4 color; float depth; int triangle; uint next; uint unused; };
layout(binding = 0, std430) buffer Counter { uint used; uint heads[]; };
layout(binding = 1, std430) buffer Entries { Entry entries[]; };
uniform int width;
void main() {
    uint head = heads[int(gl_FragCoord.y) * width + int(gl_FragCoord.x)];
    vec3 light = vec3(0.0);
    float through = 1.0;
    float last_depth = -1e30;
    int last_triangle = 1 << 30;
    // From front to back, the next one each time: no list is too long. Equal depths: the later
    // triangle lies in front, as a painter who keeps the input order has it.
    while (true) {
        uint best = 0u;
        for (uint at = head; at != 0u; at = entries[at - 1u].next) {
            Entry e = entries[at - 1u];
            bool after = e.depth > last_depth || (e.depth == last_depth && e.triangle < last_triangle);
            if (!after) continue;
            if (best != 0u) {
                Entry b = entries[best - 1u];
                if (e.depth > b.depth || (e.depth == b.depth && e.triangle < b.triangle)) continue;
            }
            best = at;
        }
        if (best == 0u) break;
        Entry chosen = entries[best - 1u];
        light += through * chosen.color.a * chosen.color.rgb;
        through *= 1.0 - chosen.color.a;
        last_depth = chosen.depth;
        last_triangle = chosen.triangle;
    }
    result = vec4(light, 1.0 - through);
}
#endif

#ifdef UNDER
uniform sampler2D layer;
uniform float share;
void main() {
    result = share * texelFetch(layer, ivec2(gl_FragCoord.xy), 0);
}
#endif

#ifdef AVERAGE
uniform sampler2D sums;
uniform sampler2D weights;
void main() {
    vec4 s = texelFetch(sums, ivec2(gl_FragCoord.xy), 0);
    float w = texelFetch(weights, ivec2(gl_FragCoord.xy), 0).r;
    float cover = 1.0 - s.a;
    result = vec4(s.rgb / max(w, 1e-6) * cover, cover);
}
#endif
