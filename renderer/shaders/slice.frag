// Provides one object's front-most surface for a slice: lit colour and the object's number.
// With WITH_SURFACES, also the number of the triangle among all triangles of the scene.
in vec3 offset;
in vec3 normal;
in vec3 color;
flat in int object;
flat in int channel;  // the number of the object's first triangle

layout(location = 0) out vec4 picture;
#ifdef WITH_SURFACES
layout(location = 1) out float surface;
#endif

void main() {
    picture = vec4(hazed(lit(color, normal, offset), offset), float(object));
#ifdef WITH_SURFACES
    surface = float(channel + gl_PrimitiveID);
#endif
}
