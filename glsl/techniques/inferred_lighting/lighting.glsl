// One light's part of the L-buffer: irradiance, and in the fourth channel the intensity of its highlight. Kircher 2009,
// section 2.2.
//
// The including shader has included surface.glsl and bvh_walk.glsl.
#ifndef INFERRED_LIGHTING_LIGHTING_GLSL
#define INFERRED_LIGHTING_LIGHTING_GLSL

// Rec.709.
float luminance(vec3 color) {
    precise float sum = 0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b;
    return sum;
}

// rgb: irradiance (lux); a: luminance of what a mirror of F0 = 1 would send to the eye.
vec4 lighting_by(LightBlock light, LitSurface surface) {
    Incident incident = incident_from(light, surface.position_ws);
    precise float cosine = dot(surface.normal_ws, incident.direction_ws);
    // NaN faces no light: a ray into nowhere would look into every node of the tree.
    if (!(cosine > 0.0) || incident.irradiance == vec3(0.0)) {
        return vec4(0.0);
    }
    if (DIRECT_SHADOW == SHADOW_RAY || (DIRECT_SHADOW == SHADOW_SUN && is_directional(light))) {
        if (occluded(surface.position_ws, surface.normal_ws, incident.direction_ws, incident.distance)) {
            return vec4(0.0);
        }
    }
    precise vec3 received = incident.irradiance * cosine;
    precise float highlight = 0.0;
    if (BRDF_KIND != BRDF_LAMBERT) {
        precise vec3 half_vector = normalize(incident.direction_ws + surface.eye_ws);
        precise float lobe = specular_lobe(
            BRDF_KIND, surface.roughness, surface.normal_ws, incident.direction_ws, surface.eye_ws, half_vector);
        highlight = lobe * luminance(received);
    }
    return vec4(received, highlight);
}

// What every texel begins with: light that comes from everywhere gives pi times its radiance.
vec4 ambient_lighting() {
    return vec4(PI * frame.ambient.rgb, 0.0);
}

#endif
