// The scene in device memory, as src/resident.rs lays it out: where each draw stands and what each material is.
#ifndef RESIDENT_GLSL
#define RESIDENT_GLSL

struct DrawBlock {
    mat4 world_from_object;
    // Columns of the inverse transpose, for normals; not unit length.
    vec4 normal_x;
    vec4 normal_y;
    vec4 normal_z;
    uint material;
    uint _unused[3];
};

const uint MATERIAL_BASE_COLOR_TEXTURE = 1u;
const uint MATERIAL_METALLIC_ROUGHNESS_TEXTURE = 2u;
const uint MATERIAL_NORMAL_TEXTURE = 4u;
const uint MATERIAL_EMISSIVE_TEXTURE = 8u;
const uint MATERIAL_DOUBLE_SIDED = 16u;

struct MaterialBlock {
    vec4 base_color;
    // rgb: radiance; a: scale of the normal map.
    vec4 emissive;
    float metallic;
    float roughness;
    // MASK: drawn where alpha is at least this.
    float alpha_cutoff;
    // MATERIAL_ bits.
    uint flags;
};

#endif
