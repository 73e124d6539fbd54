// Provides a layer's colour, times its opacity, and its opacity: to be put under or over others.
uniform sampler2D layer;
layout(location = 0) out vec4 picture;

void main() {
    picture = texelFetch(layer, ivec2(gl_FragCoord.xy), 0);
}
