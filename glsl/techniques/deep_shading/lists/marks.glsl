// Which triangles stand in lists: a bit each, by their ids. Set by insert.comp; the including shader declares `marks`.
#ifndef DEEP_SHADING_LISTS_MARKS_GLSL
#define DEEP_SHADING_LISTS_MARKS_GLSL

uint mark_word(uint primitive) {
    return primitive >> 5u;
}

uint mark_bit(uint primitive) {
    return 1u << (primitive & 31u);
}

bool is_marked(uint primitive) {
    return (marks[mark_word(primitive)] & mark_bit(primitive)) != 0u;
}

#endif
