// What a surface does with light: Lambert, Blinn-Phong, GGX. Twin: src/shading/brdf.rs.
#ifndef SHADING_BRDF_GLSL
#define SHADING_BRDF_GLSL

#include "shading/extras.glsl"

const float PI = 3.14159265358979;

const uint BRDF_LAMBERT = 0u;
const uint BRDF_BLINN_PHONG = 1u;
const uint BRDF_GGX = 2u;

// A surface as light sees it.
struct Surface {
    vec3 base_color;
    float metallic;
    float roughness;
    // Read where SURFACE_EXTRAS is 1 only. 0: there is no mirroring surface, at no angle.
    float dielectric_f0;
};

vec3 f0_of(Surface surface) {
    float dielectric = SURFACE_EXTRAS != 0u ? surface.dielectric_f0 : DEFAULT_DIELECTRIC_F0;
    return mix(vec3(dielectric), surface.base_color, surface.metallic);
}

// Fresnel's value at grazing angles.
float f90_of(Surface surface) {
    return SURFACE_EXTRAS != 0u && surface.dielectric_f0 == 0.0 ? surface.metallic : 1.0;
}

// Base colour of the part that scatters diffusely.
vec3 albedo_of(Surface surface) {
    return surface.base_color * (1.0 - surface.metallic);
}

// Part of a radiance that comes from everywhere that a surface sends on: its diffuse part, and beside Lambert its mirror
// part at normal incidence, so that metals are not black under ambient light.
vec3 ambient_reflectance(uint kind, Surface surface) {
    vec3 f0 = kind == BRDF_LAMBERT ? vec3(0.0) : f0_of(surface);
    return (1.0 - f0) * albedo_of(surface) + f0;
}

// The mirror part of Blinn-Phong or GGX in 1/sr, without Fresnel's factor and the cosine. `half_vector`: between the light
// and the eye. All vectors are unit length; `to_light` is above the surface.
float specular_lobe(uint kind, float roughness, vec3 normal, vec3 to_light, vec3 to_eye, vec3 half_vector) {
    float n_dot_h = clamp(dot(normal, half_vector), 0.0, 1.0);
    float n_dot_l = clamp(dot(normal, to_light), 0.0, 1.0);
    float n_dot_v = max(dot(normal, to_eye), 1e-4);
    float alpha = max(roughness * roughness, 1e-3);
    float alpha_squared = alpha * alpha;
    if (kind == BRDF_BLINN_PHONG) {
        float exponent = max(2.0 / alpha_squared - 2.0, 1.0);
        return (exponent + 2.0) / (8.0 * PI) * pow(max(n_dot_h, 1e-6), exponent);
    }
    float denominator = n_dot_h * n_dot_h * (alpha_squared - 1.0) + 1.0;
    float distribution = alpha_squared / (PI * denominator * denominator);
    float masking = n_dot_l * sqrt(n_dot_v * n_dot_v * (1.0 - alpha_squared) + alpha_squared);
    float shadowing = n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0 - alpha_squared) + alpha_squared);
    return distribution * 0.5 / max(masking + shadowing, 1e-6);
}

// The BRDF in 1/sr, without the cosine. All vectors are unit length; `n_dot_l` is positive.
//
// GGX: Smith's height-correlated visibility, Schlick's Fresnel with F0 = mix(0.04 or the index of refraction's, base colour, metallic), diffuse
// weighted by 1 - F (glTF 2.0, appendix B). Blinn-Phong: the exponent with the same width, 2/alpha^2 - 2, normalised
// by (s + 2) / (8 pi) as in the L-buffer literature, with the same Fresnel.
vec3 brdf(uint kind, Surface surface, vec3 normal, vec3 to_light, vec3 to_eye) {
    vec3 diffuse = albedo_of(surface) / PI;
    if (kind == BRDF_LAMBERT) {
        return diffuse;
    }
    vec3 half_vector = normalize(to_light + to_eye);
    float v_dot_h = clamp(dot(to_eye, half_vector), 0.0, 1.0);
    vec3 f0 = f0_of(surface);
    float grazing = 1.0 - v_dot_h;
    float grazing_squared = grazing * grazing;
    vec3 fresnel = f0 + (f90_of(surface) - f0) * (grazing_squared * grazing_squared * grazing);
    float specular = specular_lobe(kind, surface.roughness, normal, to_light, to_eye, half_vector);
    return (1.0 - fresnel) * diffuse + fresnel * specular;
}

#endif
