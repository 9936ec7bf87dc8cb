// The highlight in the L-buffer, and out of it. Schlick's Fresnel factor F0 (1 - p) + F90 p is linear in F0, so that sums over lights
// need not know the F0 of the surface that reads them. Kircher 2009, section 2.2, which leaves Fresnel out.
//
// The including shader has included shading/brdf.glsl and l_buffer.glsl.
#ifndef INFERRED_LIGHTING_HIGHLIGHT_GLSL
#define INFERRED_LIGHTING_HIGHLIGHT_GLSL

// 1: the factor is that of each light's angle; 0: HIGHLIGHT=intensity has that of normal incidence, as the paper.
layout(constant_id = 23) const uint FRESNEL_PER_LIGHT = 1;

// F0 by which a highlight is divided at least: what is darker is divided by this on both sides, and loses nothing.
const float LEAST_F0 = 1.0 / 64.0;

// Rec.709.
float luminance(vec3 color) {
    precise float sum = 0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b;
    return sum;
}

// What one light adds. `received`: lux; `lobe`: 1/sr, without Fresnel's factor; `grazing`: p, 0 to 1; `f0`, `f90`: the texel's.
Lighting lighting_with(vec3 received, float lobe, float grazing, vec3 f0, float f90) {
    if (HIGHLIGHT == HIGHLIGHT_INTENSITY) {
        // One constant at a time: the build cannot evaluate what joins two.
        if (FRESNEL_PER_LIGHT == 0u) {
            precise float mirrored = lobe * luminance(received);
            return Lighting(received, vec3(mirrored, 0.0, 0.0));
        }
    }
    precise float head_on = 1.0 - grazing;
    if (HIGHLIGHT == HIGHLIGHT_SPLIT) {
        precise vec3 scattered = received * head_on;
        precise float mirrored = lobe * luminance(received);
        precise vec2 parts = mirrored * vec2(head_on, grazing);
        return Lighting(scattered, vec3(parts, 0.0));
    }
    precise vec3 scattered = received * (1.0 - f90 * grazing);
    if (HIGHLIGHT == HIGHLIGHT_RGB) {
        precise vec3 factor = (f0 * head_on + f90 * grazing) / max(f0, vec3(LEAST_F0));
        precise vec3 mirrored = lobe * received * factor;
        return Lighting(scattered, mirrored);
    }
    precise float gray = luminance(f0);
    precise float factor = (gray * head_on + f90 * grazing) / max(gray, LEAST_F0);
    precise float mirrored = lobe * luminance(received) * factor;
    return Lighting(scattered, vec3(mirrored, 0.0, 0.0));
}

// Radiance that a surface of `f0` mirrors.
vec3 highlight_of(Lighting lighting, vec3 f0, float f90) {
    vec3 divided_by = max(f0, vec3(LEAST_F0));
    if (HIGHLIGHT == HIGHLIGHT_RGB) {
        return divided_by * lighting.highlight;
    }
    // One number has the colour of the diffuse lighting (section 2.2).
    float brightness = luminance(lighting.irradiance);
    vec3 tint = brightness > 0.0 ? lighting.irradiance / brightness : vec3(0.0);
    if (HIGHLIGHT == HIGHLIGHT_SPLIT) {
        return (f0 * lighting.highlight.x + f90 * lighting.highlight.y) * tint;
    }
    return (FRESNEL_PER_LIGHT == 0u ? f0 : divided_by) * lighting.highlight.x * tint;
}

#endif
