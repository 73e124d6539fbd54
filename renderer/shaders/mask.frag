// Provides a target's alpha mask, to be multiplied into the frame's alpha (004 §V-D).
// What only some masks need is left out of the others' programs, for a software rasteriser executes
// every branch: PICTURED (looked up, else by offset), ELLIPSES, RINGS, SEARCHLIGHT, COUNTED.
// With AT_DEPTH a mask lies at a depth, on its target and beside it, and may be divided out again.
// With CELLS instead a mask's entry for the exact picture: opacity, depth, the cap on the opacity
// of what lies in front, and 1 where the mask is at its core. A depth of 0: no mask.
uniform sampler2D distances;  // Euclidean, in pixels, −1 on the target, in tiles
uniform sampler2D rings;      // the paper's masks, grids in rows
uniform sampler2D counts;     // penetrable fragments in front of the farthest target
uniform float alpha_target;
uniform float alpha_edge;
uniform float width;
uniform vec2 size;       // of the frame
uniform int ring_size;   // 0: no rings
uniform float tau;       // least transmittance, 0: no guarantee
uniform vec4 searchlight;  // x, y in pixels (y up), radius, softness; radius < 0: light everywhere
uniform ivec2 shift;     // from this picture's pixels to the frame's
#ifdef AT_DEPTH
uniform float own, beside;  // as the depth buffer has it, 0 nearest
uniform float strength;      // 1: all of it
uniform bool divided;
#endif
#ifdef CELLS
uniform sampler2D depths;  // of the objects' fragments, in cells (exact.frag)
uniform float beside;      // depth where the target does not show
uniform vec4 extents;      // where the target itself can be: x, y (down), x, y
uniform ivec2 way;         // from the frame's pixels to the target's cell
#ifdef WITH_CAPS
uniform sampler2D colors;
uniform sampler2D parts;
uniform int target;
uniform ivec2 cell;
uniform ivec2 first_way;   // from the frame's pixels to the part's first cell
uniform int row_end;
uniform int slices;
uniform bool per_pixel;
uniform bool additive;
#endif
#endif

in vec2 offset;
flat in int kind;
flat in vec2 extra;

layout(location = 0) out vec4 picture;
#ifdef WITH_IDS
layout(location = 1) out float id;
#endif

#ifdef RINGS
float ring(ivec2 pixel) {
    int n = ring_size;
    vec2 cell = clamp((vec2(pixel) + 0.5) * n / size - 0.5, 0.0, n - 1.0);
    ivec2 low = min(ivec2(cell), n - 2);
    vec2 t = cell - vec2(low);
    int columns = textureSize(rings, 0).x / n;
    low += ivec2(kind % columns, kind / columns) * n;
    float a = texelFetch(rings, low, 0).r, b = texelFetch(rings, low + ivec2(1, 0), 0).r;
    float d = texelFetch(rings, low + ivec2(0, 1), 0).r, e = texelFetch(rings, low + 1, 0).r;
    return mix(mix(a, b, t.x), mix(d, e, t.x), t.y);
}

#endif

#ifdef SEARCHLIGHT
float light(ivec2 pixel) {
    float beyond = length(vec2(pixel) + 0.5 - searchlight.xy) - searchlight.z;
    if (searchlight.w == 0.0) return beyond <= 0.0 ? 1.0 : 0.0;
    return clamp(1.0 - beyond / searchlight.w, 0.0, 1.0);
}

#endif

#ifdef WITH_CAPS
// The highest opacity of the penetrable fragments in front of the target.
float cap(ivec2 pixel, float place) {
    int layers = 0;
    ivec2 at = pixel + first_way;
    for (int k = 0; k < slices; ++k) {
        float z = texelFetch(depths, at, 0).r;
        int i = int(texelFetch(colors, at, 0).a);
        bool before = z < place || (z == place && i > target);
        bool hard = texelFetch(parts, ivec2(i & 1023, i >> 10), 0).x != 0.0;
        if (z < 1.0 && before && !hard) ++layers;
        at.x += cell.x;
        if (at.x >= row_end) at = ivec2(at.x - row_end, at.y + cell.y);
    }
    float n = float(max(layers, 1));
    float share = additive ? (1.0 - tau) / n : 1.0 - pow(tau, 1.0 / n);
    return layers == 0 ? 1.0 : share;
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) + shift;
#ifdef PICTURED
    float d = texelFetch(distances, pixel + ivec2(extra), 0).r;
#else
#ifdef ELLIPSES
    float r = length(offset / extra);
    float d = r > 1.0 ? length(offset) * (1.0 - 1.0 / r) : 0.0;
#else
    float d = length(vec2(offset.x - clamp(offset.x, 0.0, extra.x), offset.y));
#endif
#endif
#ifdef RINGS
    float outside = ring(pixel);
#else
    float outside = width > 0.0 ? min(alpha_edge + (1.0 - alpha_edge) * d / width, 1.0) : 1.0;
#endif
    float alpha = d > 0.0 ? outside : alpha_target;
#ifdef SEARCHLIGHT
    alpha = 1.0 - light(pixel) * (1.0 - alpha);
#endif
#ifdef CELLS
    vec2 place = vec2(pixel.x, size.y - 1.0 - pixel.y) + 0.5;
    bool near = all(greaterThan(place, extents.xy)) && all(lessThan(place, extents.zw));
    float own = near ? texelFetch(depths, pixel + way, 0).r : 1.0;
    float most = 1.0;
#ifdef WITH_CAPS
    most = own < 1.0 ? cap(pixel, own) : 1.0;
    if (per_pixel) alpha = min(alpha, most);
#endif
    picture = vec4(alpha, own < 1.0 ? own : beside, most, d > 0.0 ? 0.0 : 1.0);
#else
#ifdef COUNTED
    float count = texelFetch(counts, pixel, 0).r;
    if (d <= 0.0 && count > 0.0) alpha = min(alpha, 1.0 - pow(tau, 1.0 / count));
#endif
#ifdef AT_DEPTH
    gl_FragDepth = d > 0.0 ? beside : own;
    alpha = 1.0 - strength * (1.0 - alpha);
    if (divided) alpha = 1.0 / alpha;
#endif
    picture = vec4(0.0, 0.0, 0.0, alpha);
#endif
#ifdef WITH_IDS
    id = 0.0;
#endif
}
