// Where triangles lie in their draw's texture, and how fine they are shaded there. A texture is a buffer with all its levels, one
// after the other. Written by src/techniques/deep_shading/baseline/texture_space/atlases.rs.
//
// After scene_buffers.glsl.
#ifndef DEEP_SHADING_ATLAS_GLSL
#define DEEP_SHADING_ATLAS_GLSL

// A side of the finest level has two to the power of this many texels.
layout(constant_id = 101) const uint TEXTURE_SIDE_BITS = 11;

// Two numbers a vertex, 0 to 1.
layout(std430, set = 0, binding = 40) readonly buffer Atlas { float atlas[]; };
// A word a triangle of the index buffer: its chart above CHART_LEVEL_BITS of the coarsest level at which that is a texel wide.
layout(std430, set = 0, binding = 41) readonly buffer Charts { uint charts[]; };

const uint CHART_LEVEL_BITS = 4u;

// A word of an owner: OWNER_RANK_BITS of how near the triangle comes to the texel's middle, the nearest greatest, above one more than
// the triangle; 0: no owner.
const uint OWNER_RANK_BITS = 5u;
const uint OWNER_TRIANGLE = 0xffffffffu >> OWNER_RANK_BITS;

uint chart_of(uint triangle) {
    return charts[triangle] >> CHART_LEVEL_BITS;
}

// Texels of a side.
uint level_side(uint level) {
    return 1u << (TEXTURE_SIDE_BITS - level);
}

// The index of a level's texel: finer levels come before it, each four times as long as the next.
uint texel_index(uint level, uvec2 texel) {
    uint all = 1u << (2u * (TEXTURE_SIDE_BITS + 1u));
    return (all - (all >> (2u * level))) / 3u + texel.y * level_side(level) + texel.x;
}

// Corners of a triangle of the index buffer in the atlas, in texels of a level.
struct Charted {
    vec2 corners[3];
};

Charted charted_at(uint triangle, uint level) {
    Charted at;
    for (uint corner = 0u; corner < 3u; corner++) {
        uint vertex = vertex_of(3u * triangle + corner);
        precise vec2 texels = vec2(atlas[2u * vertex], atlas[2u * vertex + 1u]) * float(level_side(level));
        at.corners[corner] = texels;
    }
    return at;
}

// The determinant of corners' x, y and w: twice the area on the screen times the three w. Taken from a corner on: products of places
// on the screen would lose a small triangle in rounding.
float spanned(vec4 a, vec4 b, vec4 c) {
    precise vec2 from_b = b.xy * a.w - a.xy * b.w;
    precise vec2 from_c = c.xy * a.w - a.xy * c.w;
    precise float twice = (from_b.x * from_c.y - from_b.y * from_c.x) / a.w;
    return twice;
}

// The level whose texels are about as large as pixels of canonical shading space where these are densest on the triangle, no
// coarser than its chart allows: the same for all that claim, shade and look up. `canonical`: its corners.
//
// At a place of homogeneous w there are 2 A w^3 / det texels a pixel, A the triangle's area in texels: fewest at the nearest
// corner. What reaches behind the near plane has no such corner, and the finest level.
uint level_of(uint triangle, vec4 canonical[3]) {
    float nearest = min(canonical[0].w, min(canonical[1].w, canonical[2].w));
    for (uint corner = 0u; corner < 3u; corner++) {
        if (!(canonical[corner].w > 0.0) || canonical[corner].z > canonical[corner].w) {
            return 0u;
        }
    }
    Charted at = charted_at(triangle, 0u);
    precise vec2 from_b = at.corners[1] - at.corners[0];
    precise vec2 from_c = at.corners[2] - at.corners[0];
    precise float twice_area = abs(from_b.x * from_c.y - from_b.y * from_c.x);
    precise float cube = nearest * nearest * nearest;
    precise float density = twice_area * cube / abs(spanned(canonical[0], canonical[1], canonical[2]));
    // The nearest whole number to log4: half of log2 of twice the density, rounded down. An exponent is a log2 rounded down, and needs
    // no function that drivers compute in their own ways; edge-on it is greater than any level.
    precise float twice_density = 2.0 * density;
    int exponent = int((floatBitsToUint(twice_density) & 0x7fffffffu) >> 23) - 127;
    uint coarsest = charts[triangle] & ((1u << CHART_LEVEL_BITS) - 1u);
    return uint(clamp(exponent >> 1, 0, int(min(coarsest, TEXTURE_SIDE_BITS))));
}

// The corners of a triangle in canonical shading space.
vec4[3] canonical_corners(uint triangle) {
    uint first = 3u * triangle;
    return vec4[3](canonical_corner(first), canonical_corner(first + 1u), canonical_corner(first + 2u));
}

#endif
