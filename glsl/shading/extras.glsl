// What few materials say: another index of refraction, ambient occlusion, no light at all. It travels in the spare 16 bits
// of the G-buffer's emission. Twin: src/shading/brdf.rs.
#ifndef SHADING_EXTRAS_GLSL
#define SHADING_EXTRAS_GLSL

// 1 where a material of the scene has any of it; else nothing of this file runs.
layout(constant_id = 61) const uint SURFACE_EXTRAS = 0;

// F0 of a dielectric whose index of refraction is 1.5.
const float DEFAULT_DIELECTRIC_F0 = 0.04;

// 0: the default; 1 to 255: steps of the root of F0, which is (n - 1) / (n + 1).
float f0_of_code(uint code) {
    float ratio = float(code - 1u) / 254.0;
    return code == 0u ? DEFAULT_DIELECTRIC_F0 : ratio * ratio;
}

// `openness`: the part of ambient light that arrives.
uint pack_extras(uint f0_code, float openness) {
    return f0_code | (uint((1.0 - clamp(openness, 0.0, 1.0)) * 255.0 + 0.5) << 8);
}

float f0_of_extras(uint extras) {
    return f0_of_code(extras & 0xffu);
}

float openness_of_extras(uint extras) {
    return 1.0 - float(extras >> 8) / 255.0;
}

#endif
