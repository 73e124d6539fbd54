// Provides an object's vertex: clip position, world normal, world offset from the eye, colour.
// Objects are instances; `sequence` says which object an instance is and where it stands.
uniform sampler2D table;     // one row each object: three rows of its matrix, its colour and whether it is a floor
uniform sampler2D sequence;  // one row each instance: (centre − eye, object), (channel, 0, 0, 0)
uniform int first;           // the first row of this draw
uniform mat4 clip_from_offset;  // clip ← (world − eye)

in vec3 in_position;
in vec3 in_normal;
in vec3 in_color;

// A rule goes by where a surface is: of a pixel with several samples, on the surface, not beside it.
#ifndef RULED
#define centroid
#endif
centroid out vec3 offset;
centroid out vec3 normal;
out vec3 color;
flat out int object;
flat out int channel;
#ifdef FLOOR
flat out float on_floor;
#endif
#ifdef FLOOR_FLAT
uniform vec3 eye;
uniform vec4 shadows_place;
flat out vec3 floor_color;
flat out vec4 floor_light;
centroid out vec2 shadows_at;
#endif

void main() {
    int row = first + gl_InstanceID;
    vec4 place = texelFetch(sequence, ivec2(0, row), 0);
    object = int(place.w);
    channel = int(texelFetch(sequence, ivec2(1, row), 0).x);
    vec3 x = texelFetch(table, ivec2(0, object), 0).xyz;
    vec3 y = texelFetch(table, ivec2(1, object), 0).xyz;
    vec3 z = texelFetch(table, ivec2(2, object), 0).xyz;
    offset = place.xyz + vec3(dot(x, in_position), dot(y, in_position), dot(z, in_position));
    // Normals go by the cofactors of the matrix, so that stretched objects are lit rightly.
    vec3 a = cross(y, z), b = cross(z, x), c = cross(x, y);
    normal = vec3(dot(a, in_normal), dot(b, in_normal), dot(c, in_normal)) * sign(dot(a, x));
    color = in_color * texelFetch(table, ivec2(3, object), 0).rgb;
#ifdef FLOOR
    on_floor = texelFetch(table, ivec2(3, object), 0).a;
#endif
#ifdef FLOOR_FLAT
    vec3 unit = normalize(normal);
    floor_color = color;
    floor_light = vec4(unit, steady(unit));
    on_floor = on_floor > 0.0 && unit.y > FLOOR_FLAT ? 1.0 : 0.0;
    shadows_at = (offset.xz + eye.xz - shadows_place.xy) * shadows_place.zw;
#endif
    gl_Position = clip_from_offset * vec4(offset, 1.0);
}
