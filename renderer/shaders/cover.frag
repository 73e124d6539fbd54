// Provides a mark: this pixel (or cell) lies on the target.
layout(location = 0) out float turn;

void main() {
    turn = 1.0;
}
