// Directions drawn as brdf.glsl scatters them, and how likely each is: a cosine around the normal for the diffuse part, and
// for the mirroring part GGX's visible normals (Heitz 2018, by the spherical caps of Dupuy and Benyoub 2023) or
// Blinn-Phong's lobe. What is drawn is weighed by brdf() itself, so that a choice that is off costs noise, not truth.
#ifndef SHADING_SCATTER_GLSL
#define SHADING_SCATTER_GLSL

#include "shading/brdf.glsl"

// Two unit vectors that stand on `normal` and on each other (Duff et al. 2017).
void frame_around(vec3 normal, out vec3 x, out vec3 y) {
    float turn = normal.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (turn + normal.z);
    float b = normal.x * normal.y * a;
    x = vec3(1.0 + turn * normal.x * normal.x * a, turn * b, -turn * normal.x);
    y = vec3(b, turn + normal.y * normal.y * a, -normal.y);
}

vec3 around(vec3 normal, vec3 local) {
    vec3 x;
    vec3 y;
    frame_around(normal, x, y);
    return x * local.x + y * local.y + normal * local.z;
}

vec3 cosine_direction(vec3 normal, vec2 numbers) {
    float radius = sqrt(numbers.x);
    float angle = 2.0 * PI * numbers.y;
    return around(normal, vec3(radius * cos(angle), radius * sin(angle), sqrt(max(1.0 - numbers.x, 0.0))));
}

float largest(vec3 color) {
    return max(color.r, max(color.g, color.b));
}

// How often the mirroring part is drawn, 0 to 1. Both parts keep a share: directions that one never draws would get no
// weight from the other.
float mirror_part(uint kind, Surface surface, vec3 normal, vec3 to_eye) {
    if (kind == BRDF_LAMBERT || dot(normal, to_eye) <= 0.0) {
        return 0.0;
    }
    float grazing = 1.0 - clamp(dot(normal, to_eye), 0.0, 1.0);
    float squared = grazing * grazing;
    float f0 = largest(f0_of(surface));
    float mirrored = f0 + (f90_of(surface) - f0) * squared * squared * grazing;
    float diffuse = (1.0 - mirrored) * largest(albedo_of(surface));
    return mirrored <= 0.0 ? 0.0 : clamp(mirrored / (mirrored + diffuse), 0.1, 0.95);
}

// Density over solid angle of the mirroring part alone.
float mirror_density(uint kind, Surface surface, vec3 normal, vec3 to_light, vec3 to_eye) {
    vec3 half_vector = normalize(to_light + to_eye);
    float n_dot_h = clamp(dot(normal, half_vector), 0.0, 1.0);
    float n_dot_v = max(dot(normal, to_eye), 1e-4);
    float alpha = max(surface.roughness * surface.roughness, 1e-3);
    float alpha_squared = alpha * alpha;
    if (kind == BRDF_BLINN_PHONG) {
        float exponent = max(2.0 / alpha_squared - 2.0, 1.0);
        float of_half = (exponent + 1.0) / (2.0 * PI) * pow(max(n_dot_h, 1e-6), exponent);
        return of_half / (4.0 * max(dot(to_eye, half_vector), 1e-6));
    }
    float denominator = n_dot_h * n_dot_h * (alpha_squared - 1.0) + 1.0;
    float distribution = alpha_squared / (PI * denominator * denominator);
    return distribution / (2.0 * (n_dot_v + sqrt(alpha_squared + (1.0 - alpha_squared) * n_dot_v * n_dot_v)));
}

// Density over solid angle of what scatter_direction draws.
float scatter_density(uint kind, Surface surface, vec3 normal, vec3 to_light, vec3 to_eye) {
    float part = mirror_part(kind, surface, normal, to_eye);
    float diffuse = max(dot(normal, to_light), 0.0) / PI;
    return part > 0.0 ? mix(diffuse, mirror_density(kind, surface, normal, to_light, to_eye), part) : diffuse;
}

vec3 mirror_half_vector(uint kind, Surface surface, vec3 normal, vec3 to_eye, vec2 numbers) {
    float angle = 2.0 * PI * numbers.y;
    float alpha = max(surface.roughness * surface.roughness, 1e-3);
    if (kind == BRDF_BLINN_PHONG) {
        float exponent = max(2.0 / (alpha * alpha) - 2.0, 1.0);
        float z = pow(max(1.0 - numbers.x, 1e-7), 1.0 / (exponent + 1.0));
        float radius = sqrt(max(1.0 - z * z, 0.0));
        return around(normal, vec3(radius * cos(angle), radius * sin(angle), z));
    }
    vec3 x;
    vec3 y;
    frame_around(normal, x, y);
    vec3 eye = normalize(vec3(alpha * dot(to_eye, x), alpha * dot(to_eye, y), dot(to_eye, normal)));
    float z = (1.0 - numbers.x) * (1.0 + eye.z) - eye.z;
    float radius = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
    vec3 stretched = vec3(radius * cos(angle), radius * sin(angle), z) + eye;
    vec3 local = normalize(vec3(alpha * stretched.xy, max(stretched.z, 1e-6)));
    return x * local.x + y * local.y + normal * local.z;
}

// `choice`: 0 to 1, between the parts.
vec3 scatter_direction(uint kind, Surface surface, vec3 normal, vec3 to_eye, float choice, vec2 numbers) {
    vec3 diffuse = cosine_direction(normal, numbers);
    if (choice >= mirror_part(kind, surface, normal, to_eye)) {
        return diffuse;
    }
    return reflect(-to_eye, mirror_half_vector(kind, surface, normal, to_eye, numbers));
}

#endif
