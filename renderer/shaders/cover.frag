// Provides −1 in the object's channel of the distance picture: this pixel lies on the target.
flat in int channel;

layout(location = 0) out vec4 distances;

void main() {
    distances = vec4(60000.0);
    distances[channel % 4] = -1.0;
}
