// Provides the exact picture of one pixel: the fragments of all objects, one each, sorted from
// front to back, with the targets' masks as entries in the same list (renderer/reference.py).
// What it gives depends on OUTPUT_PICTURE, OUTPUT_SHARES or OUTPUT_LIGHT.
const int MOST = 64;  // slices, and masks

uniform sampler2D colors;   // cells: rgb, object
uniform sampler2D depths;   // cells
uniform sampler2D masks;    // cells: opacity, depth beside the target, target + 1, at its core
uniform sampler2D parts;    // one texel each object: impenetrable, opacity where not per pixel
uniform int slice_base;     // the first cell of this part
uniform int slices;
uniform int mask_base;
uniform int mask_count;
uniform ivec2 cell;         // width and height
uniform int columns;        // of cells with fragments
uniform int mask_columns;   // of cells with masks
uniform ivec2 origin;       // of the cells in the frame
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

ivec2 texel(int k, ivec2 pixel) {
    k += slice_base;
    return ivec2(k % columns, k / columns) * cell + pixel;
}

ivec2 mask_texel(int m, ivec2 pixel) {
    m += mask_base;
    return ivec2(m % mask_columns, m / mask_columns) * cell + pixel;
}

int count = 0;
float depth[MOST];
int object[MOST];
int source[MOST];

void gather(ivec2 pixel) {
    for (int k = 0; k < slices; ++k) {
        float z = texelFetch(depths, texel(k, pixel), 0).r;
        if (z >= 1.0) continue;
        int i = int(texelFetch(colors, texel(k, pixel), 0).a);
        int at = count++;
        // At one depth the later object is in front.
        while (at > 0 && (depth[at - 1] > z || (depth[at - 1] == z && object[at - 1] < i))) {
            depth[at] = depth[at - 1];
            object[at] = object[at - 1];
            source[at] = source[at - 1];
            --at;
        }
        depth[at] = z;
        object[at] = i;
        source[at] = k;
    }
}

// The depth of a mask at this pixel; `layers` are the penetrable fragments in front of its target.
float place_of(vec4 mask, out int layers) {
    int owner = int(mask.z) - 1, before = 0;
    layers = 0;
    for (int k = 0; k < count; ++k) {
        if (object[k] == owner) {
            layers = before;
            return depth[k];
        }
        if (tau == 0.0) continue;  // nobody asks how many
        if (texelFetch(parts, ivec2(object[k] % 1024, object[k] / 1024), 0).x == 0.0) ++before;
    }
    return mask.y;
}

float cap(int layers) {
    if (tau == 0.0 || layers == 0) return 1.0;
    return additive ? (1.0 - tau) / float(layers) : 1.0 - pow(tau, 1.0 / float(layers));
}

#ifdef OUTPUT_LIGHT
layout(location = 0) out float picture;

// Drawn over all cells at once: how strongly a mask's core behind this fragment is lit.
void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    ivec2 which = here / cell;
    ivec2 pixel = here - which * cell;
    picture = 0.0;
    float z = texelFetch(depths, here, 0).r;
    if (which.x + which.y * columns >= slices || z >= 1.0) return;
    gather(pixel);
    for (int m = 0; m < mask_count; ++m) {
        vec4 mask = texelFetch(masks, mask_texel(m, pixel), 0);
        int layers;
        if (mask.z == 0.0 || mask.w == 0.0) continue;
        // The mask's opacity is 1 − light · (1 − α_T); `tau` holds 1 − α_T here.
        if (z < place_of(mask, layers)) picture = max(picture, (1.0 - mask.x) / tau);
    }
}
#else

float places[MOST];
float opacities[MOST];
float caps[MOST];

void read_masks(ivec2 pixel) {
    for (int m = 0; m < mask_count; ++m) {
        vec4 mask = texelFetch(masks, mask_texel(m, pixel), 0);
        int layers = 0;
        places[m] = mask.z == 0.0 ? -1e9 : place_of(mask, layers);
        opacities[m] = mask.x;
        caps[m] = cap(layers);
    }
}

float opacity(int k, ivec2 pixel) {
    vec2 part = texelFetch(parts, ivec2(object[k] % 1024, object[k] / 1024), 0).xy;
    if (part.x != 0.0) return 1.0;
    float a = 1.0;
#ifdef WITH_SURFACES
    int t = int(texelFetch(numbers, texel(source[k], pixel), 0).r);
    a = texelFetch(surfaces, ivec2(t % 4096, t / 4096), 0).r;
#else
    if (!per_pixel) a = part.y;
#endif
    for (int m = 0; m < mask_count; ++m) {
        if (depth[k] >= places[m]) continue;
        float mine = per_pixel ? min(opacities[m], caps[m]) : 1.0;
        if (!per_pixel) a = min(a, caps[m]);
        a = least ? min(a, mine) : a * mine;
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
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, cell))) discard;
#ifdef OUTPUT_PICTURE
    // Where no mask is, the depth buffer has drawn the picture already.
    if (per_pixel) {
        bool masked = false;
        for (int m = 0; m < mask_count && !masked; ++m) {
            vec4 mask = texelFetch(masks, mask_texel(m, pixel), 0);
            masked = mask.z != 0.0 && mask.x < 1.0;
        }
        if (!masked) discard;
    }
#endif
    gather(pixel);
    if (count > 0) read_masks(pixel);
    float left = 1.0, sum = 0.0;
    int clear = 0;
    vec3 color = vec3(0.0);
#ifdef OUTPUT_SHARES
    vec2 given[8] = vec2[8](vec2(0), vec2(0), vec2(0), vec2(0), vec2(0), vec2(0), vec2(0), vec2(0));
#endif
    for (int k = 0; k < count && left > 0.0; ++k) {
        float a = opacity(k, pixel);
        if (a < 1.0 && ++clear > limit) a = 1.0;
        float share = additive ? min(a, left) : a * left;
        left = additive ? max(left - a, 0.0) : left * (1.0 - a);
        color += share * texelFetch(colors, texel(source[k], pixel), 0).rgb;
#ifdef OUTPUT_SHARES
        if (k >= from && k < from + 8) given[k - from] = vec2(float(object[k] + 1), share);
#endif
    }
#ifdef OUTPUT_SHARES
    first = vec4(given[0], given[1]);
    second = vec4(given[2], given[3]);
    third = vec4(given[4], given[5]);
    fourth = vec4(given[6], given[7]);
#else
    picture = vec4(color + left * background, 1.0);
#endif
}
#endif
