// Provides the Euclidean distance in pixels to a segment.
in vec2 place;
flat in vec4 segment;

layout(location = 0) out float pixels;

void main() {
    vec2 along = segment.zw - segment.xy;
    vec2 from = place - segment.xy;
    float t = clamp(dot(from, along) / max(dot(along, along), 1e-20), 0.0, 1.0);
    pixels = length(from - t * along);
}
