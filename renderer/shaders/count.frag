// Provides one layer, to be added up.
layout(location = 0) out vec4 layers;

void main() {
    layers = vec4(1.0);
}
