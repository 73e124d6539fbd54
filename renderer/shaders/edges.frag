// Provides a layer with lines along its edges: where a neighbour in it is another object, nothing,
// or turned away. Colours come times their opacity.
uniform sampler2D layer;
uniform sampler2D place;  // depth, the object's number + 1, the normal folded into two numbers
uniform vec4 line;
uniform float crease;     // the cosine from which on neighbours are turned away
layout(location = 0) out vec4 picture;

vec3 unfolded(vec2 e) {
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    vec2 turned = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    if (n.z < 0.0) n.xy = turned;
    return normalize(n);
}

bool differs(vec4 here, ivec2 texel, ivec2 size) {
    if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, size))) return false;
    vec4 there = texelFetch(place, texel, 0);
    if (there.y != here.y) return true;
    return dot(unfolded(here.zw), unfolded(there.zw)) < crease;
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy), size = textureSize(place, 0);
    vec4 here = texelFetch(place, texel, 0);
    picture = texelFetch(layer, texel, 0);
    if (here.y == 0.0) return;
    if (differs(here, texel + ivec2(1, 0), size) || differs(here, texel - ivec2(1, 0), size)
        || differs(here, texel + ivec2(0, 1), size) || differs(here, texel - ivec2(0, 1), size))
        picture = vec4(line.rgb * line.a, line.a);
}
