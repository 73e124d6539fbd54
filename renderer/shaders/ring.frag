// Provides the paper's mask by ring growth: each cell takes the opacity of the nearest ring, by
// the number of cells in the larger of the two directions (004 §V-D, algorithm 2).
uniform sampler2D covers;  // −1 in a cell on the target
uniform int count;         // rings
uniform int ring_size;
uniform float alpha_target;
uniform float alpha_edge;

layout(location = 0) out vec4 opacity;

void main() {
    ivec2 cell = ivec2(gl_FragCoord.xy);
    int low = cell.y / ring_size * ring_size;
    vec4 nearest = vec4(float(count + 1));
    for (int y = -count; y <= count; ++y) {
        if (cell.y + y < low || cell.y + y >= low + ring_size) continue;
        for (int x = -count; x <= count; ++x) {
            if (cell.x + x < 0 || cell.x + x >= ring_size) continue;
            vec4 on = step(texelFetch(covers, cell + ivec2(x, y), 0), vec4(0.0));
            nearest = min(nearest, mix(vec4(float(count + 1)), vec4(float(max(abs(x), abs(y)))), on));
        }
    }
    vec4 rising = alpha_edge + (1.0 - alpha_edge) * (nearest - 1.0) / float(max(count, 1));
    opacity = mix(mix(rising, vec4(1.0), greaterThan(nearest, vec4(float(count)))), vec4(alpha_target), equal(nearest, vec4(0.0)));
}
