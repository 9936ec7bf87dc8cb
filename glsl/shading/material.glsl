// A material at one fragment: factors times textures, the normal map applied. Fragment stages only.
//
// With the axis VERTEX=extended vertices have colours, and textures placements: `placements[]` is the including shader's.
// Set 1 belongs to the material: src/resident/textures.rs makes one set each, with a white pixel where a texture is
// missing. The including shader reads the material's block: from its push constants, or from `materials[]`. Where
// pixels may have several samples it has the axis SHADED. Once a pixel: at a place on the triangle, because a pixel whose middle
// it does not cover must not be shaded beyond its edge. Once a sample: there; that its inputs are a sample's makes it so.
// Where it shades another place than its own it defines MATERIAL_PLACE, and writes what is otherwise interpolated
// before it calls anything, with the changes of texture coordinates that choose levels.
#ifndef SHADING_MATERIAL_GLSL
#define SHADING_MATERIAL_GLSL

#include "resident.glsl"
#include "shading/extras.glsl"
#include "shading/slanted.glsl"

layout(set = 1, binding = 0) uniform sampler2D base_color_texture;
layout(set = 1, binding = 1) uniform sampler2D metallic_roughness_texture;
layout(set = 1, binding = 2) uniform sampler2D normal_texture;
layout(set = 1, binding = 3) uniform sampler2D emissive_texture;
layout(set = 1, binding = 4) uniform sampler2D occlusion_texture;

#if defined(SHADED_SAMPLE)
#define INTERPOLATION sample
#elif defined(SHADED_PIXEL)
#define INTERPOLATION centroid
#else
#define INTERPOLATION
#endif

#ifdef MATERIAL_PLACE

vec3 in_position_ws;
vec3 in_normal_ws;
vec4 in_tangent_ws;
vec2 in_uv;
// By how much in_uv changes a pixel to the right, and down.
vec2 in_uv_right;
vec2 in_uv_down;
uint in_material;
bool in_front_facing;
#ifdef VERTEX_EXTENDED
vec4 in_color;
vec2 in_uv_1;
vec2 in_uv_1_right;
vec2 in_uv_1_down;
#endif

#ifdef VERTEX_EXTENDED
#define UV_CHANGE(which, way) uv_change(which, in_uv_##way, in_uv_1_##way)
#else
#define UV_CHANGE(which, way) uv_change(which, in_uv_##way, in_uv_##way)
#endif
#define ISOTROPIC(name, which) textureGrad(name, uv_of(which), UV_CHANGE(which, right), UV_CHANGE(which, down))

#else

layout(location = 1) INTERPOLATION in vec3 in_normal_ws;
layout(location = 2) INTERPOLATION in vec4 in_tangent_ws;
layout(location = 4) flat in uvec2 in_ids;
#if defined(SHADED_SAMPLE) || defined(SHADED_PIXEL)
// Elsewhere than in the middle lavapipe (of centroids and samples) and SwiftShader (of samples) divide by the depth in the middle, so
// that positions lie off their triangles, behind what casts shadows. A corner's 1 comes out by the same factor.
layout(location = 0) INTERPOLATION in vec4 in_position_and_one;
layout(location = 3) INTERPOLATION in vec2 in_uv_by_one;
#define in_position_ws (in_position_and_one.xyz / in_position_and_one.w)
#define in_uv (in_uv_by_one / in_position_and_one.w)
#ifdef VERTEX_EXTENDED
layout(location = 5) INTERPOLATION in vec4 in_color_by_one;
layout(location = 6) INTERPOLATION in vec2 in_uv_1_by_one;
#define in_color (in_color_by_one / in_position_and_one.w)
#define in_uv_1 (in_uv_1_by_one / in_position_and_one.w)
#endif
#else
layout(location = 0) in vec3 in_position_ws;
layout(location = 3) in vec2 in_uv;
#ifdef VERTEX_EXTENDED
layout(location = 5) in vec4 in_color;
layout(location = 6) in vec2 in_uv_1;
#endif
#endif

#define in_material in_ids.x
#define in_front_facing gl_FrontFacing

// Parts of a fragment's step, to the right and down, that levels of textures are chosen for: below 1 where the fragments drawn
// are only some of the picture's pixels.
layout(constant_id = 75) const float LEVEL_STEP_X = 1.0;
layout(constant_id = 76) const float LEVEL_STEP_Y = 1.0;
#define STEP_right(in_coordinates) (dFdx(in_coordinates) * LEVEL_STEP_X)
#define STEP_down(in_coordinates) (dFdy(in_coordinates) * LEVEL_STEP_Y)
#ifdef VERTEX_EXTENDED
// Changes are those of what is interpolated, which a quad's helper lanes have too. What they read of a buffer, as the placement
// is, may be 0 (lavapipe), and changes of what is made of it nonsense along each triangle's edge.
#define UV_CHANGE(which, way) uv_change(which, STEP_##way(in_uv), STEP_##way(in_uv_1))
#define ISOTROPIC(name, which) textureGrad(name, uv_of(which), UV_CHANGE(which, right), UV_CHANGE(which, down))
#else
#define UV_CHANGE(which, way) STEP_##way(in_uv)
#define ISOTROPIC(name, which) \
    (LEVEL_STEP_X == 1.0 && LEVEL_STEP_Y == 1.0 ? texture(name, in_uv) : textureGrad(name, in_uv, STEP_right(in_uv), STEP_down(in_uv)))
#endif

#endif

// Where on its picture a texture (TEXTURE_) is read.
vec2 uv_of(uint which) {
#ifdef VERTEX_EXTENDED
    PlacementBlock placement = placements[in_material * TEXTURE_COUNT + which];
    vec2 uv = placement.u.w > 0.5 ? in_uv_1 : in_uv;
    return vec2(dot(placement.u.xy, uv) + placement.u.z, dot(placement.v.xy, uv) + placement.v.z);
#else
    return in_uv;
#endif
}

// By how much it changes where the two sets of coordinates change so.
vec2 uv_change(uint which, vec2 change, vec2 change_1) {
#ifdef VERTEX_EXTENDED
    PlacementBlock placement = placements[in_material * TEXTURE_COUNT + which];
    vec2 chosen = placement.u.w > 0.5 ? change_1 : change;
    return vec2(dot(placement.u.xy, chosen), dot(placement.v.xy, chosen));
#else
    return change;
#endif
}

// 0: no material of the scene is read along a slant, and compilers need not see how.
layout(constant_id = 79) const uint READS_ALONG = 1;

// `most`: readings along the longer axis of what the pixel shows.
vec4 texel_along(sampler2D picture, vec2 uv, vec2 right, vec2 down, uint most) {
    Readings readings = readings_of(right, down, vec2(textureSize(picture, 0)), most);
    vec4 sum = vec4(0.0);
    for (float index = 0.0; index < readings.count; index++) {
        sum += textureGrad(picture, uv + place_of(readings, index), readings.longest / readings.count, vec2(0.0));
    }
    return sum / readings.count;
}

#define TEXEL(name, which) (READS_ALONG == 0u || material.flags >> MATERIAL_ANISOTROPY_SHIFT == 0u \
    ? ISOTROPIC(name, which) \
    : texel_along(name, uv_of(which), UV_CHANGE(which, right), UV_CHANGE(which, down), 1u + (material.flags >> MATERIAL_ANISOTROPY_SHIFT)))

vec4 base_color_at(MaterialBlock material) {
    vec4 color = material.base_color;
#ifdef VERTEX_EXTENDED
    color *= in_color;
#endif
    if ((material.flags & MATERIAL_BASE_COLOR_TEXTURE) != 0u) {
        color *= TEXEL(base_color_texture, TEXTURE_BASE_COLOR);
    }
    return color;
}

// x: metallic, y: roughness.
vec2 metallic_roughness_at(MaterialBlock material) {
    vec2 value = vec2(material.metallic, material.roughness);
    if ((material.flags & MATERIAL_METALLIC_ROUGHNESS_TEXTURE) != 0u) {
        value *= TEXEL(metallic_roughness_texture, TEXTURE_METALLIC_ROUGHNESS).bg;
    }
    return value;
}

vec3 emissive_at(MaterialBlock material) {
    vec3 radiance = material.emissive.rgb;
    if ((material.flags & MATERIAL_EMISSIVE_TEXTURE) != 0u) {
        radiance *= TEXEL(emissive_texture, TEXTURE_EMISSIVE).rgb;
    }
    return radiance;
}

// What travels in the spare bits of the G-buffer.
uint extras_at(MaterialBlock material) {
    float openness = 1.0;
    if ((material.flags & MATERIAL_OCCLUSION_TEXTURE) != 0u) {
        float strength = float((material.flags >> MATERIAL_OCCLUSION_SHIFT) & 0xffu) / 255.0;
        openness += strength * (TEXEL(occlusion_texture, TEXTURE_OCCLUSION).r - 1.0);
    }
    return pack_extras((material.flags >> MATERIAL_F0_SHIFT) & 0xffu, openness);
}

// Unit shading normal, on the viewer's side where the material is double-sided. What has none, as a mesh in the moment that a
// scale turns it inside out, faces the eye: compilers may take it that no number is NaN, and would light NaN as they like.
vec3 normal_at(MaterialBlock material, vec3 to_eye_ws) {
    bool is_known = dot(in_normal_ws, in_normal_ws) > 0.0;
    vec3 normal = normalize(in_normal_ws);
    if ((material.flags & MATERIAL_NORMAL_TEXTURE) != 0u && in_tangent_ws.xyz != vec3(0.0)) {
        vec3 tangent = normalize(in_tangent_ws.xyz);
        vec3 bitangent = cross(normal, tangent) * in_tangent_ws.w;
        vec3 mapped = TEXEL(normal_texture, TEXTURE_NORMAL).xyz * 2.0 - 1.0;
        mapped.xy *= material.emissive.a;
        vec3 bent = tangent * mapped.x + bitangent * mapped.y + normal * mapped.z;
        // A map that points nowhere leaves the surface as it is.
        normal = dot(bent, bent) > 1e-12 ? normalize(bent) : normal;
    }
    bool turned = (material.flags & MATERIAL_DOUBLE_SIDED) != 0u && !in_front_facing;
    vec3 front = turned ? -normal : normal;
    return is_known ? front : to_eye_ws;
}

#endif
