// Entries: what is shaded once, a triangle at a pixel of shading space, or where a stray sees it. An entry waits in the place that
// its colour takes then, two words: where, and which triangle.
//
// After space.glsl.
#ifndef DEEP_SHADING_WAITING_GLSL
#define DEEP_SHADING_WAITING_GLSL

// Beside the triangle: a sample's index says where, not a pixel of shading space. Ids of triangles are shorter (primitives.rs).
const uint ENTRY_STRAY = 0x80000000u;
// Where nothing waits: no place is called so, and as a colour it has no alpha, so that it is missing.
const uvec2 NO_ENTRY = uvec2(NO_SHADING_PIXEL, 0u);

uvec2 entry_in_list(uint packed_pixel, uint primitive) {
    return uvec2(packed_pixel, primitive);
}

uvec2 entry_of_stray(uint own, uint primitive) {
    return uvec2(own, primitive | ENTRY_STRAY);
}

// A sample's own entry, by its SPID.
uvec2 entry_of_sample(uvec2 spid, uint own) {
    return spid.y == NO_SHADING_PIXEL ? entry_of_stray(own, spid.x) : entry_in_list(spid.y, spid.x);
}

bool is_entry(uvec2 words) {
    return words.x != NO_SHADING_PIXEL;
}

bool is_stray(uvec2 entry) {
    return (entry.y & ENTRY_STRAY) != 0u;
}

uint entry_primitive(uvec2 entry) {
    return entry.y & ~ENTRY_STRAY;
}

#endif
