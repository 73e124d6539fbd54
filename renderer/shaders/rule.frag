// Provides what a technique's rule says of a surface: its lit colour where it is kept, nothing where
// it is removed. A template: `rule` is the technique's own GLSL. With PEELED, only the nearest
// surface behind the layer before, and the colour comes times its opacity, which is the alpha. With
// GHOSTS, what is removed instead, without any colour: lines go along its edges. With BLENDED, the
// colour comes times its opacity as well, to go over what is there already. With LISTED, each kept
// surface goes into its pixel's list: the next one, depth, colour times opacity, opacity, object.
// With SOLID, only where it is opaque.
centroid in vec3 offset;
centroid in vec3 normal;
in vec3 color;
flat in int object;
flat in int channel;

uniform vec3 right;    // the camera's axes in the world
uniform vec3 up;
uniform vec3 forward;
uniform vec2 size;     // of the picture, in pixels
uniform float lens;    // pixels for a slope of 1
uniform bool upright;  // whether the first row of pictures is the top one

#ifdef LISTED
layout(early_fragment_tests) in;
layout(std430, binding = 0) writeonly buffer Lists { uint lists[]; };
layout(std430, binding = 1) buffer Heads { uint heads[]; };
layout(std430, binding = 2) buffer Count { uint count; };
uniform int width;  // of the picture, in pixels
uniform uint room;  // for surfaces in `lists`
uniform bool solid; // whether what is opaque was drawn before
#endif
layout(location = 0) out vec4 picture;
#ifdef PEELED
layout(location = 1) out vec4 place;  // the buffer's depth, the object's number + 1, the normal
#elif defined(WITH_IDS)
layout(location = 1) out float id;
#endif

struct Surface {
    vec3 offset;   // from the eye, in the world
    vec3 normal;   // outwards, not of unit length
    float depth;   // view depth
    vec2 slope;    // to the right and up, for each unit of depth
    vec2 place;    // the middle of the pixel: column + 0.5, row + 0.5
    ivec2 texel;   // of the pixel in `pictures`
    bool front;    // whether the outside faces the eye
    int number;    // the technique's own number of the object
};

vec4 tinted = vec4(0.0);  // a rule may set a colour, and how much of it covers the lit one

{{ rule }}

#ifdef PEELED
uniform bool nearest;       // whether this is the first layer
uniform bool lined;         // whether layers get lines along their edges, which covered ones keep
uniform sampler2D above;    // `place` of the layer before
uniform sampler2D below;    // of what is opaque
uniform sampler2D covered;  // colour and opacity of all layers before
#endif

#if defined(PEELED) || defined(LINED)
// A direction in two numbers.
vec2 folded(vec3 normal) {
    vec3 n = normal / (abs(normal.x) + abs(normal.y) + abs(normal.z));
    vec2 turned = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    return n.z >= 0.0 ? n.xy : turned;
}
#endif

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
#ifdef PEELED
    vec2 before = texelFetch(above, texel, 0).xy;
    if (!nearest && (before.y == 0.0 || gl_FragCoord.z <= before.x)) discard;
    if (gl_FragCoord.z >= texelFetch(below, texel, 0).x) discard;
    if (!lined && texelFetch(covered, texel, 0).a >= 0.9999) discard;
#endif
    Surface s;
    s.offset = offset;
    s.normal = normal;
    s.depth = dot(offset, forward);
    s.slope = (gl_FragCoord.xy - 0.5 * size) / lens;
    s.place = vec2(gl_FragCoord.x, size.y - gl_FragCoord.y);
    s.texel = ivec2(texel.x, upright ? int(size.y) - 1 - texel.y : texel.y);
    s.front = gl_FrontFacing;
    s.number = channel;
    float shown = opacity(s);
#ifdef GHOSTS
    if (shown > 0.0 || !s.front) discard;
#else
    if (shown <= 0.0) discard;
    if (!s.front && !opened(s)) discard;
#endif
#ifdef SOLID
    if (shown < 1.0) discard;
#elif defined(LISTED)
    if (solid && shown >= 1.0) discard;
#endif
    vec3 shown_color = lit(color, s.front ? normal : -normal, offset);
    shown_color = hazed(mix(shown_color, tinted.rgb, tinted.a), offset);
#ifdef LISTED
    uint at = atomicAdd(count, 1u);
    if (at >= room) discard;
    uint k = at * WORDS;
    lists[k] = atomicExchange(heads[texel.y * width + texel.x], at + 1u);
    lists[k + 1u] = floatBitsToUint(gl_FragCoord.z);
    lists[k + 2u] = packHalf2x16(shown_color.rg * shown);
    lists[k + 3u] = packHalf2x16(vec2(shown_color.b * shown, shown));
    lists[k + 4u] = uint(object);
#ifdef LINED
    lists[k + 5u] = packSnorm2x16(folded(normal));
#endif
    picture = vec4(0.0);
#elif defined(BLENDED)
    picture = vec4(shown_color * shown, shown);
#elif defined(PEELED)
    picture = vec4(shown_color * shown, shown);
    place = vec4(gl_FragCoord.z, float(object + 1), folded(normal));
#else
    picture = vec4(shown_color, 1.0);
#endif
#if defined(WITH_IDS) && !defined(PEELED)
    id = float(object + 1);
#endif
}
