// Provides the Euclidean distance in pixels to a segment, in its target's channel.
in vec2 place;
flat in vec4 segment;
flat in int channel;

layout(location = 0) out vec4 distances;

void main() {
    vec2 along = segment.zw - segment.xy;
    vec2 from = place - segment.xy;
    float t = clamp(dot(from, along) / max(dot(along, along), 1e-20), 0.0, 1.0);
    distances = vec4(60000.0);
    distances[channel] = length(from - t * along);
}
