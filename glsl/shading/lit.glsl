// A surface where it is drawn, lit forward by punctual lights: what blended surfaces and forward's material pass share.
//
// The including shader declares: `frame`, `lights[]`, what material.glsl, bvh_walk.glsl and shade_lights.glsl need,
// and, with the axis LISTS=object, `light_lists[]` (src/lights/object_lists.rs).
#ifndef SHADING_LIT_GLSL
#define SHADING_LIT_GLSL

#include "shading/sum_lights.glsl"

struct Lit {
    Surface surface;
    vec3 normal_ws;
    // Towards the eye: its own, that of ambient light, that of the lights, summed in this order.
    vec3 radiance;
};

// Before any light of a list reaches it.
Lit dark_at(MaterialBlock material, vec3 base_color) {
    Lit lit;
    vec2 metallic_roughness = metallic_roughness_at(material);
    lit.normal_ws = normal_at(material, to_eye(frame, in_position_ws));
    lit.surface = Surface(base_color, metallic_roughness.x, metallic_roughness.y, DEFAULT_DIELECTRIC_F0);
    float openness = 1.0;
    if (SURFACE_EXTRAS != 0u) {
        uint extras = extras_at(material);
        lit.surface.dielectric_f0 = f0_of_extras(extras);
        openness = openness_of_extras(extras);
    }
    precise vec3 radiance =
        emissive_at(material) + ambient_reflectance(BRDF_KIND, lit.surface) * frame.ambient.rgb * openness;
    lit.radiance = radiance;
    return lit;
}

// `first`, `count`: the stretch of the list, or of the lights where there is none.
Lit lit_at(MaterialBlock material, vec3 base_color, vec3 position_ws, uint first, uint count) {
    Lit lit = dark_at(material, base_color);
    lit.radiance = sum_lights(lit.radiance, lit.surface, position_ws, lit.normal_ws, first, count);
    return lit;
}

#endif
