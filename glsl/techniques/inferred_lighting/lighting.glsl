// One light's part of the L-buffer. Kircher 2009, section 2.2.
//
// The including shader has included surface.glsl and bvh_walk.glsl.
#ifndef INFERRED_LIGHTING_LIGHTING_GLSL
#define INFERRED_LIGHTING_LIGHTING_GLSL

#include "techniques/inferred_lighting/highlight.glsl"

Lighting no_lighting() {
    return Lighting(vec3(0.0), vec3(0.0));
}

Lighting lighting_by(LightBlock light, LitSurface surface) {
    Incident incident = incident_from(light, surface.position_ws);
    precise float cosine = dot(surface.normal_ws, incident.direction_ws);
    // NaN faces no light: a ray into nowhere would look into every node of the tree.
    if (!(cosine > 0.0) || incident.irradiance == vec3(0.0)) {
        return no_lighting();
    }
    if (DIRECT_SHADOW == SHADOW_RAY || (DIRECT_SHADOW == SHADOW_SUN && is_directional(light))) {
        if (occluded(surface.position_ws, surface.normal_ws, incident.direction_ws, incident.distance)) {
            return no_lighting();
        }
    }
    precise vec3 received = incident.irradiance * cosine;
    if (BRDF_KIND == BRDF_LAMBERT) {
        return Lighting(received, vec3(0.0));
    }
    precise vec3 half_vector = normalize(incident.direction_ws + surface.eye_ws);
    precise float lobe = specular_lobe(
        BRDF_KIND, surface.roughness, surface.normal_ws, incident.direction_ws, surface.eye_ws, half_vector);
    precise float away = 1.0 - clamp(dot(surface.eye_ws, half_vector), 0.0, 1.0);
    precise float grazing = away * away * away * away * away;
    return lighting_with(received, lobe, grazing, surface.f0, surface.f90);
}

// What every texel begins with: light that comes from everywhere gives pi times its radiance.
Lighting ambient_lighting() {
    return Lighting(PI * frame.ambient.rgb, vec3(0.0));
}

#endif
