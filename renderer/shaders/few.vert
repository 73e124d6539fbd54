// Provides a block of pixels as a point, and what exact_few.frag has to know of it; programs over
// lists (list_blocks.py) know nothing of theirs. A template.
uniform vec2 size;  // of whole blocks

in vec2 in_place;  // left, top, y down
% for group in groups
in uvec4 in_{{ group }};
% endfor

% for group in groups
flat out uvec4 {{ group }};
% endfor

void main() {
% for group in groups
    {{ group }} = in_{{ group }};
% endfor
    vec2 middle = in_place + 4.0;
    gl_Position = vec4(2.0 * middle.x / size.x - 1.0, 1.0 - 2.0 * middle.y / size.y, 0.0, 1.0);
    gl_PointSize = 8.0;
}
