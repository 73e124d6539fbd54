// Provides the finished frame, opaque, for the window.
uniform sampler2D frame;

layout(location = 0) out vec4 picture;

void main() {
    picture = vec4(texelFetch(frame, ivec2(gl_FragCoord.xy), 0).rgb, 1.0);
}
