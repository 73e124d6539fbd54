// Provides depth alone: the pre-pass that leaves an object's front-most surface.
layout(location = 0) out vec4 picture;
#ifdef WITH_IDS
layout(location = 1) out float id;
#endif

void main() {
    picture = vec4(0.0);
#ifdef WITH_IDS
    id = 0.0;
#endif
}
