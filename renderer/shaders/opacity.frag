// Provides an opacity alone, to be multiplied into the frame's alpha.
uniform float opacity;

layout(location = 0) out vec4 picture;
#ifdef WITH_IDS
layout(location = 1) out float id;
#endif

void main() {
    picture = vec4(0.0, 0.0, 0.0, opacity);
#ifdef WITH_IDS
    id = 0.0;
#endif
}
