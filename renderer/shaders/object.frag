// Provides the lit colour of an object, opaque: the frame's own alpha says how strongly it shows.
// With WITH_IDS, also the object's number + 1 into a second picture.
in vec3 offset;
in vec3 normal;
in vec3 color;
flat in int object;

layout(location = 0) out vec4 picture;
#ifdef WITH_IDS
layout(location = 1) out float id;
#endif

void main() {
    picture = vec4(hazed(lit(color, normal, offset), offset), 1.0);
#ifdef WITH_IDS
    id = float(object + 1);
#endif
}
