// Provides what exact.frag gives as OUTPUT_PICTURE and OUTPUT_NEAREST, where no more than `slices`
// objects and `masks` masks can show. A template (renderer/gpu/few_sorter.py): lines that begin
// with % repeat others, for compilers leave loops over arrays as they are, at twice the time.
//
// Nothing is sorted: what a fragment's share of the pixel is, each of the others says by itself,
// for it lies in front or it does not.
uniform sampler2D colors;   // cells: rgb, object
uniform sampler2D depths;   // cells
% if looked_up
uniform sampler2D distances;  // from the outlines of targets, in pixels, in tiles (mask.frag)
uniform float width;
uniform float alpha_target;
uniform float alpha_edge;
% else
uniform sampler2D masks;    // cells: opacity, depth (mask.frag)
% endif
uniform sampler2D parts;    // one texel each object: impenetrable
uniform ivec2 cell;         // width and height
uniform ivec2 origin;       // of the cells in the frame
uniform bool every;         // draw pixels without a mask too
uniform vec3 background;
uniform bool least;         // of the masks that line up, else their product

% for group in groups
flat in uvec4 {{ group }};  // where cells begin, 16 bits each: x, y; all bits set for none
% endfor

layout(location = 0) out vec4 picture;

const uint NONE = 0xffffffffu;
// One surface has not quite the same depth in two cells, for they lie in different places of one
// picture: what is nearer to another than this is where it is.
const float SAME = 2.0 / 16777216.0;

ivec2 place_of(uint corner, ivec2 pixel) {
    return ivec2(corner & 0xffffu, corner >> 16) + pixel;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) - origin;
    // With several samples a pixel, some drivers let a few beyond the scissor pass.
    bool kept = all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, cell));
% if masks
% for k in range(slices)
    ivec2 at{{ k }} = place_of({{ slice_at[k] }}, pixel);
    float depth{{ k }} = texelFetch(depths, at{{ k }}, 0).r;
    vec4 color{{ k }} = texelFetch(colors, at{{ k }}, 0);
    if ({{ slice_at[k] }} == NONE || depth{{ k }} >= 1.0) {
        depth{{ k }} = 1.0;
        color{{ k }} = vec4(0.0, 0.0, 0.0, -1.0);  // nothing was drawn here: it may hold anything
    }
% endfor
    bool masked = false;
% for m in range(masks)
% if looked_up
    // The target's number in the place of a corner, and how to get to its tile.
    uint way{{ m }} = {{ words[0][m] }};
    float target{{ m }} = float({{ words[1][m] }});
    float place{{ m }} = uintBitsToFloat({{ words[2][m] }});
% for k in range(slices)
    place{{ m }} = color{{ k }}.a == target{{ m }} ? depth{{ k }} : place{{ m }};
% endfor
    ivec2 tile{{ m }} = ivec2(int(way{{ m }} << 16) >> 16, int(way{{ m }}) >> 16);
    float d{{ m }} = texelFetch(distances, ivec2(gl_FragCoord.xy) + tile{{ m }}, 0).r;
    float outside{{ m }} =
        width > 0.0 ? min(alpha_edge + (1.0 - alpha_edge) * d{{ m }} / width, 1.0) : 1.0;
    float through{{ m }} = d{{ m }} > 0.0 ? outside{{ m }} : alpha_target;
    if ({{ words[1][m] }} == NONE) place{{ m }} = 0.0;
% else
    vec2 mask{{ m }} = texelFetch(masks, place_of({{ words[0][m] }}, pixel), 0).xy;
    float place{{ m }} = {{ words[0][m] }} != NONE ? mask{{ m }}.y : 0.0;
    float through{{ m }} = mask{{ m }}.x;
% endif
    masked = masked || (place{{ m }} > 0.0 && through{{ m }} < 1.0);
% endfor
    // Where no mask is, the depth buffer has drawn the picture already, unless that is left to us.
    kept = kept && (every || masked);
% for k in range(slices)
    float a{{ k }} = depth{{ k }} < 1.0 ? 1.0 : 0.0;
% for m in range(masks)
    float mine{{ k }}_{{ m }} = depth{{ k }} < place{{ m }} - SAME ? through{{ m }} : 1.0;
    a{{ k }} = least ? min(a{{ k }}, mine{{ k }}_{{ m }}) : a{{ k }} * mine{{ k }}_{{ m }};
% endfor
% if hard
    int object{{ k }} = int(max(color{{ k }}.a, 0.0));
    if (texelFetch(parts, ivec2(object{{ k }} & 1023, object{{ k }} >> 10), 0).x != 0.0)
        a{{ k }} = depth{{ k }} < 1.0 ? 1.0 : 0.0;
% endif
    float share{{ k }} = a{{ k }};
% endfor
    bool front;
% for k in range(slices)
% for j in range(k)
    // At one depth the later object is in front.
    front = depth{{ k }} < depth{{ j }} - SAME
        || (depth{{ k }} <= depth{{ j }} + SAME && color{{ k }}.a > color{{ j }}.a);
    share{{ j }} *= front ? 1.0 - a{{ k }} : 1.0;
    share{{ k }} *= front ? 1.0 : 1.0 - a{{ j }};
% endfor
% endfor
    float left = 1.0;
    vec3 total = vec3(0.0);
% for k in range(slices)
    left *= 1.0 - a{{ k }};
    total += share{{ k }} * color{{ k }}.rgb;
% endfor
    if (!kept) discard;
    picture = vec4(total + left * background, 1.0);
% else
    ivec2 at, chosen = ivec2(0);
    float z, nearest = 1.0;
% for k in range(slices)
    at = place_of({{ slice_at[k] }}, pixel);
    z = {{ slice_at[k] }} != NONE ? texelFetch(depths, at, 0).r : 1.0;
    chosen = z < 1.0 && z <= nearest + SAME ? at : chosen;
    nearest = min(z, nearest);
% endfor
    if (!kept || nearest >= 1.0) discard;
    picture = vec4(texelFetch(colors, chosen, 0).rgb, 1.0);
% endif
}
