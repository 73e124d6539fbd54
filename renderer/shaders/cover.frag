// Provides −1 for a pixel that lies on the target; as an opacity of 8 bits that is 0.
layout(location = 0) out float mark;

void main() {
    mark = -1.0;
}
