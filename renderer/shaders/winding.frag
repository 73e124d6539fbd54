// Provides one turn of an outline round this pixel, to be added up.
layout(location = 0) out float turn;

void main() {
    turn = gl_FrontFacing ? 1.0 : -1.0;
}
