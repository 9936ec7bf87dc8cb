// Virtual point lights that solid surfaces hide, by the shadow map of each light that is held now.
// Pass: src/techniques/interleaved_deferred/vpl_shadow/maps.rs; which face lies where: unrolled.rs.
// variants: POSITION=half|unorm16|depth|float MAPS=hemicube|cube|layers|indexed
#version 460
#include "passes/gbuffer_read.glsl"
#include "techniques/interleaved_deferred/vpl_shadow/find.glsl"

// A light's map: the frame in which it looks along its normal, and the depth of its faces, `depth_far + depth_over / distance`, the
// distance along the face's axis in metres.
struct VplMapBlock {
    // w: depth_far.
    vec4 right_ws;
    // w: depth_over.
    vec4 up_ws;
};

layout(std430, set = 0, binding = 4) readonly buffer VplMaps { VplMapBlock vpl_maps[]; };
#ifdef MAPS_LAYERS
layout(set = 0, binding = 5) uniform sampler2DArray atlas;
#else
layout(set = 0, binding = 5) uniform sampler2D atlas;
#endif

#ifdef MAPS_INDEXED
// Where in an unrolled map a direction of its light's frame lies, in texels.
layout(set = 0, binding = 6) uniform usamplerCube map_index;

// What a map takes of the atlas.
layout(constant_id = 116) const int MAP_TILE_X = 1;
layout(constant_id = 117) const int MAP_TILE_Y = 1;
#else
// Texels across a face, an even number.
layout(constant_id = 112) const int MAP_SIZE = 2;
#endif
// Maps beside each other in the atlas.
layout(constant_id = 113) const int MAP_COLUMNS = 1;
// Metres by which a point asks from nearer to its light.
layout(constant_id = 114) const float MAP_BIAS = 0.0;

#ifdef MAPS_INDEXED
// Depth that the map in `slot` holds there; the distance along the face's axis.
float held_towards(int slot, vec3 away, out float along) {
    vec3 size = abs(away);
    along = max(max(size.x, max(size.y, size.z)), 1e-12);
    ivec2 tile = ivec2(slot % MAP_COLUMNS, slot / MAP_COLUMNS) * ivec2(MAP_TILE_X, MAP_TILE_Y);
    return texelFetch(atlas, tile + ivec2(textureLod(map_index, away, 0.0).xy), 0).r;
}
#else
// Where a direction lies: the face (+z, +x, -x, +y, -y, -z; z is the light's normal), the place in it from -1 to 1, and the distance
// along its axis.
struct MapPlace {
    uint face;
    vec2 inside;
    float along;
};

MapPlace map_place(vec3 away) {
    vec3 size = abs(away);
    bool is_z = size.z >= max(size.x, size.y);
    bool is_x = size.x >= size.y;
    float axis = is_z ? away.z : is_x ? away.x : away.y;
    vec2 across = is_z ? away.xy : is_x ? away.yz : away.xz;
    uint face = (is_z ? 0u : is_x ? 1u : 3u) + (axis < 0.0 ? (is_z ? 5u : 1u) : 0u);
    float along = max(abs(axis), 1e-12);
    return MapPlace(face, across / along, along);
}

// Depth that the map in `slot` holds there.
float held_at(int slot, MapPlace place) {
    const int half_size = MAP_SIZE / 2;
    int face = int(place.face);
    ivec2 at = ivec2(floor(place.inside * float(half_size)));
#if defined(MAPS_LAYERS)
    at = clamp(at + half_size, 0, MAP_SIZE - 1);
    return texelFetch(atlas, ivec3(at, slot * 6 + face), 0).r;
#elif defined(MAPS_CUBE)
    ivec2 tile = ivec2(slot % MAP_COLUMNS, slot / MAP_COLUMNS) * ivec2(3, 2) * MAP_SIZE;
    at = clamp(at + half_size, 0, MAP_SIZE - 1);
    return texelFetch(atlas, tile + ivec2(face % 3, face / 3) * MAP_SIZE + at, 0).r;
#else
    // The whole face has two halves beside it and two below.
    ivec2 tile = ivec2(slot % MAP_COLUMNS, slot / MAP_COLUMNS) * ivec2(2 * MAP_SIZE, 3 * half_size);
    bool is_half = face > 0;
    at.x = clamp(at.x + half_size, 0, MAP_SIZE - 1);
    at.y = is_half ? clamp(at.y, 0, half_size - 1) : clamp(at.y + half_size, 0, MAP_SIZE - 1);
    bool is_right = face == 1 || face == 2 || face == 4;
    at.x += is_right ? MAP_SIZE : 0;
    at.y += face == 2 ? half_size : face > 2 ? MAP_SIZE : 0;
    return texelFetch(atlas, tile + at, 0).r;
#endif
}

float held_towards(int slot, vec3 away, out float along) {
    MapPlace place = map_place(away);
    along = place.along;
    return held_at(slot, place);
}
#endif

bool is_hidden(uint vpl_index, VplBlock vpl, vec3 position_ws, vec3 normal_ws) {
    VplMapBlock map = vpl_maps[vpl_index];
    vec3 away_ws = position_ws - vpl.position_ws.xyz;
    away_ws *= max(1.0 - MAP_BIAS / max(length(away_ws), 1e-12), 0.0);
    vec3 away = vec3(dot(away_ws, map.right_ws.xyz), dot(away_ws, map.up_ws.xyz), dot(away_ws, vpl.normal_ws.xyz));
    float along;
    float held = held_towards(int(vpl_index - params.light_first), away, along);
    // Light passes where a point is as near to it as what the map holds, or nearer.
    return map.right_ws.w + map.up_ws.w / along < held;
}

void main() {
    find_hidden();
}
