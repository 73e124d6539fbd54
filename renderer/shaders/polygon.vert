// Provides a translucent polygon's corner: colour, texture coordinates, and its depth along the
// view, in world units, so that depths compare as they are.
uniform mat4 clip_from_world;
uniform vec4 depth_from_world;
in vec3 position;
in vec4 color;
in vec3 texturing;  // u, v, and 1 where the texture counts
out vec4 tint;
out vec3 texel;
out float depth;
flat out int triangle;

void main() {
    tint = color;
    texel = texturing;
    depth = dot(depth_from_world, vec4(position, 1.0));
    triangle = gl_VertexID / 3;
    gl_Position = clip_from_world * vec4(position, 1.0);
}
