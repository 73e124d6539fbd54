// Provides the exact picture of one pixel: the fragments of all objects, one each, from front to
// back, with the targets' masks as entries in the same list (renderer/reference.py).
// What it gives depends on OUTPUT_PICTURE, OUTPUT_NEAREST, OUTPUT_SHARES or OUTPUT_LIGHT.
//
// A software rasteriser executes both sides of every branch, for a group of pixels at once, and
// leaves a loop only when the last of them does. So nothing is sorted: the next fragment is looked
// for again and again until nothing shines through, and what is rare is a loop or a define. Of the
// cells, only those are looked at that hold anything here: bits that come with each rectangle.
const int MOST = 64;  // cells with fragments, and with masks

uniform sampler2D colors;   // cells: rgb, object
uniform sampler2D depths;   // cells
uniform sampler2D masks;    // cells: opacity, depth, cap, at its core (mask.frag)
uniform sampler2D parts;    // one texel each object: impenetrable, opacity where not per pixel
uniform int slices;         // of this part
uniform ivec2 cell;         // width and height
uniform int columns;        // of cells with fragments
uniform int mask_columns;
uniform int slice_base;     // the first cell of this part
uniform int mask_base;
uniform ivec2 origin;       // of the cells in the frame
uniform bool every;           // draw pixels without a mask too
uniform vec3 background;
uniform bool per_pixel;     // else opacities come from `parts` or `surfaces`
uniform bool least;         // of the masks that line up, else their product
uniform bool additive;
uniform int limit;          // layers that may turn transparent
uniform float tau;
#ifdef WITH_SURFACES
uniform sampler2D numbers;  // cells: triangle
uniform sampler2D surfaces; // one texel each triangle: its opacity
#endif

#ifdef PLACED
flat in uvec4 which;  // the cells of this part that matter: 64 bits for fragments, 64 for masks
#else
uniform uvec4 which;
#endif

// The number of the lowest bit, which is taken away.
int pop(inout uvec2 bits) {
    bool low = bits.x != 0u;
    uint word = low ? bits.x : bits.y;
    uint bit = word & (~word + 1u);
    bits = low ? uvec2(bits.x ^ bit, bits.y) : uvec2(0u, bits.y ^ bit);
    return (floatBitsToInt(float(bit)) >> 23) - (low ? 127 : 95);
}

bool any_of(uvec2 bits) {
    return (bits.x | bits.y) != 0u;
}

// Where cell k begins, of so many in a row; whole numbers divide slowly in software.
ivec2 corner(int k, int many) {
    int row = int((float(k) + 0.5) / float(many));
    return ivec2(k - row * many, row) * cell;
}

#ifdef OUTPUT_NEAREST
layout(location = 0) out vec4 picture;

// Where no mask is.
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) - origin;
    bool kept = all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, cell));
    ivec2 chosen = ivec2(0);
    float nearest = 1.0;
    for (uvec2 bits = which.xy; any_of(bits);) {
        ivec2 at = corner(slice_base + pop(bits), columns) + pixel;
        float z = texelFetch(depths, at, 0).r;
        chosen = z <= nearest ? at : chosen;
        nearest = min(z, nearest);
    }
    if (!kept || nearest >= 1.0) discard;
    picture = vec4(texelFetch(colors, chosen, 0).rgb, 1.0);
}
#elif defined(OUTPUT_LIGHT)
layout(location = 0) out float picture;

// Drawn over all cells at once: how strongly a mask's core behind this fragment is lit.
void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    ivec2 mine = here / cell;
    ivec2 pixel = here - mine * cell;
    picture = 0.0;
    float z = texelFetch(depths, here, 0).r;
    if (mine.x + mine.y * columns >= slices || z >= 1.0) return;
    for (uvec2 bits = which.zw; any_of(bits);) {
        vec4 mask = texelFetch(masks, corner(mask_base + pop(bits), mask_columns) + pixel, 0);
        // The mask's opacity is 1 − light · (1 − α_T); `tau` holds 1 − α_T here.
        if (mask.w != 0.0 && z < mask.y) picture = max(picture, (1.0 - mask.x) / tau);
    }
}
#else

int count = 0;
float places[MOST];
float opacities[MOST];

// Fills the list of masks; false where none of them lets anything through.
bool read_masks(ivec2 pixel) {
    bool masked = false;
    for (uvec2 bits = which.zw; any_of(bits);) {
        vec4 mask = texelFetch(masks, corner(mask_base + pop(bits), mask_columns) + pixel, 0);
        masked = masked || (mask.y > 0.0 && mask.x < 1.0);
        places[count] = mask.y;
        opacities[count++] = per_pixel ? mask.x : mask.z;
    }
    return masked;
}

float opacity(float z, int object, ivec2 at) {
    vec2 part = texelFetch(parts, ivec2(object & 1023, object >> 10), 0).xy;
    float a = per_pixel ? 1.0 : part.y;
#ifdef WITH_SURFACES
    int t = int(texelFetch(numbers, at, 0).r);
    a = texelFetch(surfaces, ivec2(t & 4095, t >> 12), 0).r;
#endif
    for (int m = 0; m < count; ++m) {
        float mine = z < places[m] ? opacities[m] : 1.0;
        a = least || !per_pixel ? min(a, mine) : a * mine;
    }
    return part.x != 0.0 ? 1.0 : a;
}

#ifdef OUTPUT_SHARES
uniform int from;  // the first of eight fragments to give, from the front
layout(location = 0) out vec4 first;
layout(location = 1) out vec4 second;
layout(location = 2) out vec4 third;
layout(location = 3) out vec4 fourth;
#else
layout(location = 0) out vec4 picture;
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) - origin;
    // With several samples a pixel, some drivers let a few beyond the scissor pass.
    bool kept = all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, cell));
    bool masked = read_masks(pixel);
#ifdef OUTPUT_PICTURE
    // Where no mask is, the depth buffer has drawn the picture already, unless that is left to us.
    if (per_pixel && !every) kept = kept && masked;
#endif
#ifdef OUTPUT_SHARES
    vec2 given[8] = vec2[8](vec2(0), vec2(0), vec2(0), vec2(0), vec2(0), vec2(0), vec2(0), vec2(0));
#endif
    float depth[MOST];
    int place[MOST], number = 0;
    for (uvec2 bits = which.xy; any_of(bits); ++number) {
        ivec2 at = corner(slice_base + pop(bits), columns) + pixel;
        depth[number] = texelFetch(depths, at, 0).r;
        place[number] = at.x | at.y << 16;
    }
    float left = kept ? 1.0 : 0.0, z = -1.0;
    int clear = 0, ties = 0, last = 0;
    vec3 color = vec3(0.0);
    for (int n = 0; left > 0.0; ++n) {
        // The next depth, how many fragments have it, and one of them.
        int chosen = 0;
        float nearest = 1.0;
        int same = 0;
        for (int k = 0; k < number; ++k) {
            bool better = depth[k] > z && depth[k] < nearest;
            same = better ? 1 : same + int(depth[k] == nearest);
            chosen = better ? place[k] : chosen;
            nearest = better ? depth[k] : nearest;
        }
        if (ties == 0) {
            z = nearest;
            ties = same;
            last = 1 << 30;
        }
        if (z >= 1.0) break;
        // At one depth the later object is in front.
        int best = -1;
        for (int k = last < (1 << 30) || ties > 1 ? 0 : number; k < number; ++k) {
            int i = int(texelFetch(colors, ivec2(place[k] & 0xffff, place[k] >> 16), 0).a);
            bool better = depth[k] == z && i < last && i > best;
            chosen = better ? place[k] : chosen;
            best = better ? i : best;
        }
        ivec2 at = ivec2(chosen & 0xffff, chosen >> 16);
        vec4 found = texelFetch(colors, at, 0);
        int object = int(found.a);
        last = object;
        --ties;
        float a = opacity(z, object, at);
        clear += int(a < 1.0);
        a = clear > limit ? 1.0 : a;
        float share = additive ? min(a, left) : a * left;
        left = additive ? max(left - a, 0.0) : left * (1.0 - a);
        color += share * found.rgb;
#ifdef OUTPUT_SHARES
        if (n >= from && n < from + 8) given[n - from] = vec2(float(object + 1), share);
#endif
    }
#ifdef OUTPUT_SHARES
    first = vec4(given[0], given[1]);
    second = vec4(given[2], given[3]);
    third = vec4(given[4], given[5]);
    fourth = vec4(given[6], given[7]);
#else
    if (!kept) discard;
    picture = vec4(color + left * background, 1.0);
#endif
}
#endif
