// The loop over punctual lights that full shading shares: deferred shading, composite, blended surfaces.
//
// The including shader declares: `lights[]`, `frame`, what bvh.glsl needs, and the constants BRDF_KIND and
// DIRECT_SHADOW. With the axis SHADOWS=mapped shadow maps are asked instead of rays. A light beyond its range adds exactly
// 0, so leaving it out changes no bit.
#ifndef SHADING_SHADE_LIGHTS_GLSL
#define SHADING_SHADE_LIGHTS_GLSL

#include "shading/light.glsl"
#include "shading/brdf.glsl"
#ifdef SHADOWS_MAPPED
#include "passes/shadow_maps.glsl"
#endif

// Radiance towards the eye that one punctual light causes. `geometric_ws`: normal of the triangle's plane side, used to
// start shadow rays off the surface.
vec3 shade_light(LightBlock light, Surface surface, vec3 position_ws, vec3 normal_ws, vec3 eye_ws) {
    Incident incident = incident_from(light, position_ws);
    precise float cosine = dot(normal_ws, incident.direction_ws);
    // NaN faces no light: a ray into nowhere would look into every node of the tree.
    if (!(cosine > 0.0) || incident.irradiance == vec3(0.0)) {
        return vec3(0.0);
    }
#ifdef SHADOWS_MAPPED
    float passed = passed_by_shadow_maps(light, position_ws, incident.direction_ws);
    if (passed == 0.0) {
        return vec3(0.0);
    }
    incident.irradiance *= passed;
#endif
    if (DIRECT_SHADOW == SHADOW_RAY || (DIRECT_SHADOW == SHADOW_SUN && is_directional(light))) {
        if (occluded(position_ws, normal_ws, incident.direction_ws, incident.distance)) {
            return vec3(0.0);
        }
    }
    precise vec3 reflected = brdf(BRDF_KIND, surface, normal_ws, incident.direction_ws, eye_ws) * incident.irradiance * cosine;
    return reflected;
}

#endif
