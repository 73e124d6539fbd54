// Provides the view depth of a surface, for what a technique has to know of the targets.
in vec3 offset;
uniform vec3 forward;
layout(location = 0) out float picture;

void main() {
    picture = dot(offset, forward);
}
