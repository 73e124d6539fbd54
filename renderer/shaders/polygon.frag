// Provides one fragment of a translucent polygon, for the way of blending that is defined:
// PAINT (over what is there), LIST (into the pixel's list), PEEL (the nearest beyond the last),
// WEIGHTED (McGuire and Bavoil's sums) or STOCHASTIC (kept by chance).
uniform sampler2D surface;
uniform bool use_texture;
in vec4 tint;
in vec3 texel;
in float depth;
flat in int triangle;

// Without its texture a polygon is plain glass.
const vec4 GLASS = vec4(1.0, 1.0, 1.0, 0.5);

vec4 fragment_color() {
    vec4 picture = use_texture ? texture(surface, texel.xy) : GLASS;
    return tint * mix(vec4(1.0), picture, texel.z);
}

#ifdef PAINT
uniform bool unblended;
out vec4 result;
void main() {
    vec4 c = fragment_color();
    if (unblended) c.a = 1.0;
    result = vec4(c.rgb * c.a, c.a);
}
#endif

#ifdef LIST
layout(early_fragment_tests) in;
struct Entry { vec4 color; float depth; int triangle; uint next; uint unused; };
layout(binding = 0, std430) buffer Counter { uint used; uint heads[]; };
layout(binding = 1, std430) buffer Entries { Entry entries[]; };
uniform int width;
uniform uint room;
out vec4 result;
void main() {
    uint at = atomicAdd(used, 1u);
    if (at < room) {
        uint pixel = uint(int(gl_FragCoord.y) * width + int(gl_FragCoord.x));
        uint next = atomicExchange(heads[pixel], at + 1u);
        entries[at] = Entry(fragment_color(), depth, triangle, next, 0u);
    }
    result = vec4(0.0);
}
#endif

#ifdef PEEL
uniform sampler2D last;
uniform sampler2D solid;  // depth of what is opaque
out vec4 result;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    if (gl_FragCoord.z <= texelFetch(last, at, 0).r) discard;
    if (gl_FragCoord.z >= texelFetch(solid, at, 0).r) discard;
    vec4 c = fragment_color();
    result = vec4(c.rgb * c.a, c.a);
}
#endif

#ifdef WEIGHTED
uniform vec2 range;  // nearest and farthest depth of the scene
layout(location = 0) out vec4 sums;
layout(location = 1) out vec4 weights;
void main() {
    vec4 c = fragment_color();
    float z = clamp((depth - range.x) / max(range.y - range.x, 1e-6), 0.0, 1.0);
    float weight = c.a * clamp(0.03 / (1e-5 + pow(z, 4.0)), 1e-2, 3e3);
    sums = vec4(c.rgb * weight, c.a);
    weights = vec4(weight, 0.0, 0.0, c.a);
}
#endif

#ifdef STOCHASTIC
uniform int draw;
out vec4 result;
uint scramble(uint x) {
    x ^= x >> 16; x *= 0x7feb352du; x ^= x >> 15; x *= 0x846ca68bu; x ^= x >> 16;
    return x;
}
void main() {
    vec4 c = fragment_color();
    uint key = scramble(uint(gl_FragCoord.x) + 4099u * scramble(uint(gl_FragCoord.y)
        + 4099u * scramble(uint(triangle) + 8191u * uint(draw))));
    if (float(key) / 4294967296.0 >= c.a) discard;
    result = vec4(c.rgb, 1.0);
}
#endif
