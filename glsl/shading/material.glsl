// A material at one fragment: factors times textures, the normal map applied. Fragment stages only.
//
// Set 1 belongs to the material: src/resident.rs makes one set each, with a white pixel where a texture is missing.
// The including shader reads the material's block: from its push constants, or from `materials[]`.
#ifndef SHADING_MATERIAL_GLSL
#define SHADING_MATERIAL_GLSL

#include "resident.glsl"

layout(set = 1, binding = 0) uniform sampler2D base_color_texture;
layout(set = 1, binding = 1) uniform sampler2D metallic_roughness_texture;
layout(set = 1, binding = 2) uniform sampler2D normal_texture;
layout(set = 1, binding = 3) uniform sampler2D emissive_texture;

layout(location = 0) in vec3 in_position_ws;
layout(location = 1) in vec3 in_normal_ws;
layout(location = 2) in vec4 in_tangent_ws;
layout(location = 3) in vec2 in_uv;
layout(location = 4) flat in uint in_material;

vec4 base_color_at(MaterialBlock material) {
    vec4 color = material.base_color;
    if ((material.flags & MATERIAL_BASE_COLOR_TEXTURE) != 0u) {
        color *= texture(base_color_texture, in_uv);
    }
    return color;
}

// x: metallic, y: roughness.
vec2 metallic_roughness_at(MaterialBlock material) {
    vec2 value = vec2(material.metallic, material.roughness);
    if ((material.flags & MATERIAL_METALLIC_ROUGHNESS_TEXTURE) != 0u) {
        value *= texture(metallic_roughness_texture, in_uv).bg;
    }
    return value;
}

vec3 emissive_at(MaterialBlock material) {
    vec3 radiance = material.emissive.rgb;
    if ((material.flags & MATERIAL_EMISSIVE_TEXTURE) != 0u) {
        radiance *= texture(emissive_texture, in_uv).rgb;
    }
    return radiance;
}

// Unit shading normal, on the viewer's side where the material is double-sided.
vec3 normal_at(MaterialBlock material) {
    vec3 normal = normalize(in_normal_ws);
    if ((material.flags & MATERIAL_NORMAL_TEXTURE) != 0u && in_tangent_ws.xyz != vec3(0.0)) {
        vec3 tangent = normalize(in_tangent_ws.xyz);
        vec3 bitangent = cross(normal, tangent) * in_tangent_ws.w;
        vec3 mapped = texture(normal_texture, in_uv).xyz * 2.0 - 1.0;
        mapped.xy *= material.emissive.a;
        vec3 bent = tangent * mapped.x + bitangent * mapped.y + normal * mapped.z;
        // A map that points nowhere leaves the surface as it is.
        normal = dot(bent, bent) > 1e-12 ? normalize(bent) : normal;
    }
    bool turned = (material.flags & MATERIAL_DOUBLE_SIDED) != 0u && !gl_FrontFacing;
    return turned ? -normal : normal;
}

#endif
