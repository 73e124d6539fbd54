// Provides a target's alpha mask, to be multiplied into the frame's alpha (004 §V-D).
uniform sampler2D distances;  // Euclidean, in pixels; −1 on the target; one channel each target
uniform float alpha_target;
uniform float alpha_edge;
uniform float width;
uniform int rows;  // of the frame: the pictures of channels 4, 8, … lie above the first

in vec2 offset;
flat in int channel;

layout(location = 0) out vec4 picture;
#ifdef WITH_IDS
layout(location = 1) out float id;
#endif

void main() {
    float d = length(offset);
    if (channel >= 0) {
        ivec2 texel = ivec2(gl_FragCoord.xy) + ivec2(0, channel / 4 * rows);
        d = texelFetch(distances, texel, 0)[channel % 4];
    }
    float alpha = alpha_target;
    if (d > 0.0) {
        alpha = width > 0.0 ? min(alpha_edge + (1.0 - alpha_edge) * d / width, 1.0) : 1.0;
    }
    picture = vec4(0.0, 0.0, 0.0, alpha);
#ifdef WITH_IDS
    id = 0.0;
#endif
}
