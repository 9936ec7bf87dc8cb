// Punctual and virtual point lights: irradiance at a surface point. Twin: src/shading/light.rs.
//
// Sums that must be equal in two methods are `precise`: the compiler may not reorder or fuse them.
#ifndef SHADING_LIGHT_GLSL
#define SHADING_LIGHT_GLSL

const uint LIGHT_DIRECTIONAL = 0u;
const uint LIGHT_POINT = 1u;
const uint LIGHT_SPOT = 2u;
// A patch of a larger light: it shines into the half space of its normal, or both, by the cosine to that.
const uint LIGHT_PATCH = 3u;

// A bit for each kind that is there: what a driver would do for the others, and throw away, is left out.
layout(constant_id = 67) const uint LIGHT_KINDS = 7;

// A punctual light (KHR_lights_punctual).
struct LightBlock {
    // xyz: world space; w: 1 / range^2, 0 without range.
    vec4 position_ws;
    // rgb: candela, or lux where directional; w: range in metres, 0 without range.
    vec4 intensity;
    // xyz: unit vector in which it shines, a patch's normal; w: radius of the sphere that shines, in metres, 0 of a point;
    // of a patch 1 where its back shines too.
    vec4 direction_ws;
    // The cone as clamp(cos * scale + offset, 0, 1)^2.
    float spot_scale;
    float spot_offset;
    // LIGHT_ values.
    uint kind;
    // Its place among the lights of the picture, in whatever list it stands: which shadow maps are its own.
    uint index;
};

// A virtual point light: a small Lambert patch that shines into the half space of its normal.
struct VplBlock {
    vec4 position_ws;
    vec4 normal_ws;
    // rgb: intensity along the normal, W/sr in glTF's photometric sense (candela).
    vec4 intensity;
};

// 1/d^2 of a punctual light ends at a millimetre: a surface inside a lamp stays finite.
const float LEAST_DISTANCE_SQUARED = 1e-6;

// Direction to a punctual light, and the irradiance that it gives a surface that faces it.
struct Incident {
    vec3 direction_ws;
    float distance;
    vec3 irradiance;
};

bool is_kind(LightBlock light, uint kind) {
    return (LIGHT_KINDS & (1u << kind)) != 0u && light.kind == kind;
}

// Whether it shines along one direction, from nowhere.
bool is_directional(LightBlock light) {
    return is_kind(light, LIGHT_DIRECTIONAL);
}

// Irradiance of what faces a point or spot light, where its light comes from `direction_ws`.
vec3 irradiance_along(LightBlock light, float distance_squared, vec3 direction_ws) {
    // glTF's window: clamp(1 - (d/range)^4, 0, 1), exactly 0 from the range on.
    precise float fraction_squared = distance_squared * light.position_ws.w;
    precise float window = clamp(1.0 - fraction_squared * fraction_squared, 0.0, 1.0);
    precise float attenuation = window / max(distance_squared, LEAST_DISTANCE_SQUARED);
    if (is_kind(light, LIGHT_SPOT)) {
        precise float cone = dot(light.direction_ws.xyz, -direction_ws) * light.spot_scale + light.spot_offset;
        cone = clamp(cone, 0.0, 1.0);
        attenuation *= cone * cone;
    }
    if (is_kind(light, LIGHT_PATCH)) {
        precise float cosine = -dot(light.direction_ws.xyz, direction_ws);
        attenuation *= light.direction_ws.w != 0.0 ? abs(cosine) : max(cosine, 0.0);
    }
    return light.intensity.rgb * attenuation;
}

Incident incident_from(LightBlock light, vec3 position_ws) {
    Incident incident;
    if (is_directional(light)) {
        incident.direction_ws = -light.direction_ws.xyz;
        incident.distance = 1e30;
        incident.irradiance = light.intensity.rgb;
        return incident;
    }
    precise vec3 to_light = light.position_ws.xyz - position_ws;
    precise float distance_squared = dot(to_light, to_light);
    incident.distance = sqrt(distance_squared);
    incident.direction_ws = to_light / max(incident.distance, 1e-12);
    incident.irradiance = irradiance_along(light, distance_squared, incident.direction_ws);
    return incident;
}

// Unit vector towards a virtual light, 0 where it is on the spot, and how far it is.
vec3 towards_vpl(VplBlock vpl, vec3 position_ws, out float distance) {
    precise vec3 to_vpl = vpl.position_ws.xyz - position_ws;
    distance = length(to_vpl);
    precise vec3 towards = to_vpl / max(distance, 1e-12);
    return towards;
}

// Irradiance of a surface with normal `normal_ws`. `least_squared`: square of the least distance (--vpl-clamp).
vec3 vpl_irradiance(VplBlock vpl, vec3 position_ws, vec3 normal_ws, float least_squared) {
    precise vec3 to_vpl = vpl.position_ws.xyz - position_ws;
    precise float distance_squared = dot(to_vpl, to_vpl);
    // Both cosines carry one factor 1/d: the division is by d^2 twice over, without a square root.
    precise float facing = max(dot(normal_ws, to_vpl), 0.0) * max(-dot(vpl.normal_ws.xyz, to_vpl), 0.0);
    precise float geometry = facing / (max(distance_squared, 1e-12) * max(distance_squared, least_squared));
    return vpl.intensity.rgb * geometry;
}

#endif
