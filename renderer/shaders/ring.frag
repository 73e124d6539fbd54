// Provides the paper's mask by ring growth: each cell takes the opacity of the nearest ring, by
// the number of cells in the larger of the two directions (004 §V-D, algorithm 2). The grids of
// several targets lie in rows.
uniform sampler2D covers;  // < 0 in a cell on the target
uniform int count;         // rings
uniform int ring_size;
uniform float alpha_target;
uniform float alpha_edge;

layout(location = 0) out float opacity;

void main() {
    ivec2 cell = ivec2(gl_FragCoord.xy);
    ivec2 low = cell / ring_size * ring_size, high = low + ring_size;
    int nearest = count + 1;
    for (int y = -count; y <= count; ++y) {
        if (cell.y + y < low.y || cell.y + y >= high.y) continue;
        for (int x = -count; x <= count; ++x) {
            if (cell.x + x < low.x || cell.x + x >= high.x) continue;
            if (texelFetch(covers, cell + ivec2(x, y), 0).r < 0.0) {
                nearest = min(nearest, max(abs(x), abs(y)));
            }
        }
    }
    opacity = alpha_edge + (1.0 - alpha_edge) * float(nearest - 1) / float(max(count, 1));
    if (nearest == 0) opacity = alpha_target;
    if (nearest > count) opacity = 1.0;
}
