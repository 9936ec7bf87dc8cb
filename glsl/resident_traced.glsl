// The scene for rays that may meet anything, as src/resident/traced.rs lays it out.
#ifndef RESIDENT_TRACED_GLSL
#define RESIDENT_TRACED_GLSL

#include "resident.glsl"

// A scene without textures, vertex tangents or a third vertex stream pays for none.
layout(constant_id = 62) const uint HAS_TEXTURES = 1;
layout(constant_id = 63) const uint HAS_TANGENTS = 1;
layout(constant_id = 64) const uint HAS_EXTENDED = 1;
// Texel buffers that hold anything.
layout(constant_id = 65) const uint TEXEL_BUFFERS = 1;
// 0: buffers hold the finest level of a picture alone. Else they hold every level, and rays read the one that their cone's width
// asks for, so many times along its longer axis at most (--anisotropy).
layout(constant_id = 68) const uint TEXTURE_CONE = 0;

// 1: rays read occlusion maps.
layout(constant_id = 69) const uint HAS_OCCLUSION = 0;

// Where a material finds one of its textures.
struct TexelsBlock {
    // As PlacementBlock's: coordinates on the picture; u.w: 1 for the second UV set, else 0.
    vec4 u;
    vec4 v;
    // Word of the first texel in its buffer.
    uint first;
    // Width and height of the finest level in pixels; 0: there is no texture, which is white.
    uint width_px;
    uint height_px;
    // TEXELS_ bits.
    uint flags;
};

// Bits 0 and 1: the buffer. Two bits each from here on: how u is wrapped, and how v is (WRAP_).
const uint TEXELS_WRAP_U_SHIFT = 2u;
const uint TEXELS_WRAP_V_SHIFT = 4u;
const uint TEXELS_NEAREST = 64u;
const uint TEXELS_SRGB = 128u;
// The sampler chooses among levels, blends two of them, takes the nearest texel of a level that is not the finest.
const uint TEXELS_LEVELS = 256u;
const uint TEXELS_BETWEEN_LEVELS = 512u;
const uint TEXELS_NEAREST_SMALL = 1024u;

const uint WRAP_REPEAT = 0u;
const uint WRAP_MIRRORED = 1u;
const uint WRAP_CLAMP = 2u;

// What the corners of one triangle carry, in the tree's order, in world space.
struct TracedTriangleBlock {
    // xyz: normals, not unit length; w: u of each corner.
    vec4 corners[3];
    // xyz: v of each corner; w as bits: the material.
    vec4 v_material;
};

struct TracedTangentsBlock {
    vec4 corners[3];
};

// Where a triangle's normals and tangents are turned to by the time the shutter closes.
struct TracedClosingBlock {
    vec4 normals[3];
    vec4 tangents[3];
};

struct TracedExtendedBlock {
    vec4 colors[3];
    // uv_1 of the first two corners, and of the third.
    vec4 uvs_01;
    vec4 uv_2;
};

struct TracedMaterialBlock {
    MaterialBlock material;
    TexelsBlock base_color;
    TexelsBlock metallic_roughness;
    TexelsBlock normal;
    TexelsBlock emissive;
    TexelsBlock occlusion;
    // How likely an emitter's point is chosen, per square metre; 0: it is none.
    float emitter_density;
    // ALPHA_IS_ values.
    uint alpha;
    uint _unused[2];
};

const uint ALPHA_IS_OPAQUE = 0u;
const uint ALPHA_IS_MASK = 1u;
const uint ALPHA_IS_BLEND = 2u;

#endif
