// Provides the distance in pixels from the nearest piece of an outline.
in vec2 offset;

layout(location = 0) out float pixels;

void main() {
    pixels = length(offset);
}
