// Provides what exact.frag does where more objects or masks overlap than its bits and arrays hold:
// every cell of the part is read again for each layer, so that any number may overlap.
// What it gives depends on OUTPUT_PICTURE, OUTPUT_SHARES or OUTPUT_LIGHT.
uniform sampler2D colors;   // cells: rgb, object
uniform sampler2D depths;   // cells
uniform sampler2D masks;    // cells: opacity, depth, cap, at its core (mask.frag)
uniform sampler2D parts;    // one texel each object: impenetrable, opacity where not per pixel
uniform int slices;         // of this part
uniform int mask_count;
uniform ivec2 cell;         // width and height
uniform int columns;        // of cells with fragments
uniform int mask_columns;
uniform int slice_base;     // the first cell of this part
uniform int mask_base;
uniform ivec2 origin;       // of the cells in the frame
uniform bool every;         // draw pixels without a mask too
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

// What shines through less than this changes no step of 8 bits, nor of 16-bit floats.
const float NOTHING = 1.0 / 65536.0;

ivec2 slice_at(int k, ivec2 pixel) {
    k += slice_base;
    return ivec2(k % columns, k / columns) * cell + pixel;
}

vec4 mask_at(int m, ivec2 pixel) {
    m += mask_base;
    return texelFetch(masks, ivec2(m % mask_columns, m / mask_columns) * cell + pixel, 0);
}

#ifdef OUTPUT_LIGHT
layout(location = 0) out float picture;

// Drawn over all cells at once: how strongly a mask's core behind this fragment is lit.
void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    ivec2 mine = here / cell;
    ivec2 pixel = here - mine * cell;
    picture = 0.0;
    float z = texelFetch(depths, here, 0).r;
    if (mine.x + mine.y * columns >= slices || z >= 1.0) return;
    for (int m = 0; m < mask_count; ++m) {
        vec4 mask = mask_at(m, pixel);
        // The mask's opacity is 1 − light · (1 − α_T); `tau` holds 1 − α_T here.
        if (mask.w != 0.0 && z < mask.y) picture = max(picture, (1.0 - mask.x) / tau);
    }
}
#else

float opacity(float z, int object, ivec2 at, ivec2 pixel) {
    vec2 part = texelFetch(parts, ivec2(object & 1023, object >> 10), 0).xy;
    if (part.x != 0.0) return 1.0;
    float a = per_pixel ? 1.0 : part.y;
#ifdef WITH_SURFACES
    int t = int(texelFetch(numbers, at, 0).r);
    a = texelFetch(surfaces, ivec2(t & 4095, t >> 12), 0).r;
#endif
    for (int m = 0; m < mask_count; ++m) {
        vec4 mask = mask_at(m, pixel);
        float mine = z < mask.y ? (per_pixel ? mask.x : mask.z) : 1.0;
        a = least || !per_pixel ? min(a, mine) : a * mine;
    }
    return a;
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
#ifdef OUTPUT_PICTURE
    if (kept && per_pixel && !every) {
        // Where no mask is, the depth buffer has drawn the picture already.
        kept = false;
        for (int m = 0; m < mask_count && !kept; ++m) {
            vec4 mask = mask_at(m, pixel);
            kept = mask.y > 0.0 && mask.x < 1.0;
        }
    }
#endif
#ifdef OUTPUT_SHARES
    vec2 given[8] = vec2[8](vec2(0), vec2(0), vec2(0), vec2(0), vec2(0), vec2(0), vec2(0), vec2(0));
#endif
    float left = kept ? 1.0 : 0.0, z = -1.0;
    int clear = 0, last = -1;  // the fragment before this one
    vec3 color = vec3(0.0);
    for (int n = 0; n < slices && left > NOTHING; ++n) {
        // The next fragment: the nearest behind the last, and at one depth the later object first.
        ivec2 chosen = ivec2(0);
        float nearest = 1.0;
        int object = -1;
        for (int k = 0; k < slices; ++k) {
            ivec2 at = slice_at(k, pixel);
            float other = texelFetch(depths, at, 0).r;
            if (other < z || other > nearest || other >= 1.0) continue;
            int i = int(texelFetch(colors, at, 0).a);
            if (other == z && i >= last) continue;
            if (other == nearest && i <= object) continue;
            nearest = other;
            object = i;
            chosen = at;
        }
        if (object < 0) break;
        z = nearest;
        last = object;
        float a = opacity(z, object, chosen, pixel);
        clear += int(a < 1.0);
        a = clear > limit ? 1.0 : a;
        float share = additive ? min(a, left) : a * left;
        left = additive ? max(left - a, 0.0) : left * (1.0 - a);
        color += share * texelFetch(colors, chosen, 0).rgb;
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
