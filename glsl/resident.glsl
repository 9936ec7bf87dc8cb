// The scene in device memory, as src/resident/ lays it out: where each draw stands and what each material is.
#ifndef RESIDENT_GLSL
#define RESIDENT_GLSL

struct DrawBlock {
    mat4 world_from_object;
    // Columns of the inverse transpose, for normals; not unit length.
    vec4 normal_x;
    vec4 normal_y;
    vec4 normal_z;
    uint material;
    // 0 to 255: different from those of draws that it touches.
    uint object_id;
    uint _unused[2];
};

// The id, 0 to 255, of the part of a mesh with continuous normals, which travels in its tangents' fourth component: that
// is the side of the bitangent times one more than the id (Kircher 2009, section 3.1).
uint normal_group(vec4 tangent) {
    return uint(max(abs(tangent.w) - 1.0, 0.0) + 0.5);
}

const uint MATERIAL_BASE_COLOR_TEXTURE = 1u;
const uint MATERIAL_METALLIC_ROUGHNESS_TEXTURE = 2u;
const uint MATERIAL_NORMAL_TEXTURE = 4u;
const uint MATERIAL_EMISSIVE_TEXTURE = 8u;
const uint MATERIAL_DOUBLE_SIDED = 16u;
const uint MATERIAL_OCCLUSION_TEXTURE = 32u;
const uint MATERIAL_UNLIT = 64u;
// Above the bits, a byte each: the code of the dielectric F0, the strength of occlusion, and readings of a texture along a slant,
// at most, less one.
const uint MATERIAL_F0_SHIFT = 8u;
const uint MATERIAL_OCCLUSION_SHIFT = 16u;
const uint MATERIAL_ANISOTROPY_SHIFT = 24u;

struct MaterialBlock {
    vec4 base_color;
    // rgb: radiance; a: scale of the normal map.
    vec4 emissive;
    float metallic;
    float roughness;
    // MASK: drawn where alpha is at least this.
    float alpha_cutoff;
    // MATERIAL_ bits; from bit 8 on the code of F0 (shading/extras.glsl), from bit 16 on 255ths of the occlusion's
    // strength.
    uint flags;
};

// Which of a material's textures, as its placements and set 1 are ordered.
const uint TEXTURE_BASE_COLOR = 0u;
const uint TEXTURE_METALLIC_ROUGHNESS = 1u;
const uint TEXTURE_NORMAL = 2u;
const uint TEXTURE_EMISSIVE = 3u;
const uint TEXTURE_OCCLUSION = 4u;
const uint TEXTURE_COUNT = 5u;

// Where a texture is read: coordinates on the picture as rows of an affine map.
struct PlacementBlock {
    // xy: factors of the mesh's coordinates; z: shift; w: 1 for the second UV set, else 0.
    vec4 u;
    // The same without w.
    vec4 v;
};

#endif
