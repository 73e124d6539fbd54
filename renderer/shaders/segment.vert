// Provides a rectangle round a segment of an outline, `width` pixels larger on all sides.
uniform vec2 size;  // of the window, in pixels
uniform float width;

in vec4 in_segment;  // ends: x, y, x, y in pixels, y down

out vec2 place;
flat out vec4 segment;

void main() {
    vec2 a = in_segment.xy, b = in_segment.zw;
    float span = length(b - a);
    vec2 along = span > 0.0 ? (b - a) / span : vec2(1.0, 0.0);
    vec2 across = vec2(-along.y, along.x);
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    place = a + along * mix(-width, span + width, corner.x) + across * mix(-width, width, corner.y);
    segment = in_segment;
    gl_Position = vec4(2.0 * place.x / size.x - 1.0, 1.0 - 2.0 * place.y / size.y, 0.0, 1.0);
}
