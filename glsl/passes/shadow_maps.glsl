// How much of a punctual light gets past what its shadow maps hold. Maps and blocks: src/passes/shadow_maps/.
//
// Included where the axis SHADOWS is mapped; it declares what it reads at bindings 10 and 11 of set 0.
#ifndef PASSES_SHADOW_MAPS_GLSL
#define PASSES_SHADOW_MAPS_GLSL

#include "shading/light.glsl"

// The shadow maps of one light.
struct ShadowMapBlock {
    // Clip space of the one map of a spot or a directional light, depth reversed.
    mat4 clip_from_world;
    uint first_layer;
    // 1, or 6: the faces of a cube around the light, +x -x +y -y +z -z.
    uint layer_count;
    // Depth of a face is `depth_far + depth_over / distance`, the distance along the face's axis in metres.
    float depth_far;
    float depth_over;
    // Part of a face's half that 45 degrees fill. The rest is seen by its neighbours too, so that filters find texels
    // beyond an edge.
    float face_scale;
    uint _unused[3];
};

layout(std430, set = 0, binding = 10) readonly buffer ShadowMaps { ShadowMapBlock shadow_map_blocks[]; };
layout(set = 0, binding = 11) uniform sampler2DArrayShadow shadow_maps;

// Metres by which a point asks from nearer to the light.
layout(constant_id = 80) const float SHADOW_BIAS = 0.0;
// SHADOW_FILTER_ values.
layout(constant_id = 81) const uint SHADOW_FILTER = 0;

// One question to the sampler, which compares once or filters four comparisons.
const uint SHADOW_FILTER_SAMPLER = 0u;
// Four comparisons, filtered here.
const uint SHADOW_FILTER_GATHER = 1u;

// 0 to 1. `place`: x and y from -1 to 1 over the map, z the depth.
float shadow_map_at(vec3 place, uint layer) {
    vec2 uv = place.xy * 0.5 + 0.5;
    // What lies on the far plane or behind it is not behind what a map was cleared to.
    float depth = max(place.z, 0.0);
    if (SHADOW_FILTER == SHADOW_FILTER_GATHER) {
        vec2 extent = vec2(textureSize(shadow_maps, 0).xy);
        vec2 texel = uv * extent - 0.5;
        vec2 least = floor(texel);
        vec2 weight = texel - least;
        // Asked at the corner where the four meet, no rounding gives others.
        vec4 passed = textureGather(shadow_maps, vec3((least + 1.0) / extent, float(layer)), depth);
        vec2 across = mix(passed.wx, passed.zy, weight.x);
        return mix(across.x, across.y, weight.y);
    }
    // Loops over lights have no derivatives; the maps have one level.
    return textureGrad(shadow_maps, vec4(uv, float(layer), depth), vec2(0.0), vec2(0.0));
}

// The part of the light that arrives, 0 to 1; read only where it gives irradiance at all. `direction_ws`: towards it.
float passed_by_shadow_maps(LightBlock light, vec3 position_ws, vec3 direction_ws) {
    ShadowMapBlock map = shadow_map_blocks[light.index];
    vec3 at_ws = position_ws + direction_ws * SHADOW_BIAS;
    if (map.layer_count == 1u) {
        vec4 clip = map.clip_from_world * vec4(at_ws, 1.0);
        return shadow_map_at(clip.xyz / clip.w, map.first_layer);
    }
    vec3 away = at_ws - light.position_ws.xyz;
    vec3 size = abs(away);
    // x: along the axis of the face, with its sign; y and z: along the next two.
    vec3 turned = away.xyz;
    uint face = 0u;
    if (size.y > size.x) {
        turned = away.yzx;
        face = 2u;
    }
    if (size.z > max(size.x, size.y)) {
        turned = away.zxy;
        face = 4u;
    }
    float along = abs(turned.x);
    if (turned.x < 0.0) {
        turned.z = -turned.z;
        face += 1u;
    }
    // In the middle of a lamp there is nothing between.
    along = max(along, 1e-12);
    vec3 place = vec3(turned.yz * (map.face_scale / along), map.depth_far + map.depth_over / along);
    return shadow_map_at(place, map.first_layer + face);
}

#endif
