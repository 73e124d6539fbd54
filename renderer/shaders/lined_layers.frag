// Provides what four layers add up to, each with lines along its edges: where a neighbour in it is
// another object, nothing, or turned away. Colours come times their opacity. A template.
uniform sampler2D colors[4];
uniform usampler2D places[4];  // the object's number + 1, the normal; 0 where nothing is
uniform vec4 line;
uniform float crease;          // the cosine from which on neighbours are turned away
layout(location = 0) out vec4 picture;

vec3 unfolded(uint word) {
    vec2 e = unpackSnorm2x16(word);
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    vec2 turned = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    if (n.z < 0.0) n.xy = turned;
    return normalize(n);
}

bool differs(usampler2D place, uvec2 here, ivec2 texel, ivec2 size) {
    if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, size))) return false;
    uvec2 there = texelFetch(place, texel, 0).xy;
    if (there.x != here.x) return true;
    return there.y != here.y && dot(unfolded(here.y), unfolded(there.y)) < crease;
}

vec4 lined(sampler2D layer, usampler2D place) {
    ivec2 texel = ivec2(gl_FragCoord.xy), size = textureSize(place, 0);
    uvec2 here = texelFetch(place, texel, 0).xy;
    if (here.x == 0u) return vec4(0.0);
    if (differs(place, here, texel + ivec2(1, 0), size)
        || differs(place, here, texel - ivec2(1, 0), size)
        || differs(place, here, texel + ivec2(0, 1), size)
        || differs(place, here, texel - ivec2(0, 1), size))
        return vec4(line.rgb * line.a, line.a);
    return texelFetch(layer, texel, 0);
}

void main() {
    picture = lined(colors[0], places[0]);
    if (picture.a == 0.0 && texelFetch(places[0], ivec2(gl_FragCoord.xy), 0).x == 0u) discard;
    picture += (1.0 - picture.a) * lined(colors[1], places[1]);
    picture += (1.0 - picture.a) * lined(colors[2], places[2]);
    picture += (1.0 - picture.a) * lined(colors[3], places[3]);
}
