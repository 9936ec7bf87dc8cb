// Homogeneous media: how they scatter (Henyey and Greenstein 1941), and where along a ray a light's share of it is looked
// for (Kulla and Fajardo 2012). Twin: src/shading/medium.rs.
#ifndef SHADING_MEDIUM_GLSL
#define SHADING_MEDIUM_GLSL

#include "shading/medium_box.glsl"
#include "shading/scatter.glsl"

// Density over solid angle; `cosine`: between the directions in which light travels before and after.
float phase(float asymmetry, float cosine) {
    float squared = asymmetry * asymmetry;
    float base = 1.0 + squared - 2.0 * asymmetry * cosine;
    return (1.0 - squared) / (4.0 * PI * base * sqrt(base));
}

// A direction drawn with the density phase() around `forward`.
vec3 phase_direction(float asymmetry, vec3 forward, vec2 numbers) {
    float cosine = 1.0 - 2.0 * numbers.x;
    // Next to 0 the inversion divides by it.
    if (abs(asymmetry) > 1e-3) {
        float squared = asymmetry * asymmetry;
        float ratio = (1.0 - squared) / (1.0 + asymmetry * cosine);
        cosine = clamp((1.0 + squared - ratio * ratio) / (2.0 * asymmetry), -1.0, 1.0);
    }
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    float angle = 2.0 * PI * numbers.y;
    return around(forward, vec3(sine * cos(angle), sine * sin(angle), cosine));
}

// Part of the light that a stretch of this optical depth stops; exact where that is next to nothing too.
float stopped_by(float depth) {
    return depth < 1e-3 ? depth * (1.0 - 0.5 * depth) : 1.0 - exp(-depth);
}

// How a place is drawn on a stretch of a ray: by the angle under which a light sees it, or as transmittance falls.
struct Stretch {
    // In metres along the ray.
    vec2 ends;
    // Per metre.
    float extinction;
    // Where the ray passes the light, and how far off.
    float nearest;
    float off;
    // Under which the light sees the stretch.
    float angle;
    // How often the angle is drawn, 0 where the light is nowhere.
    float angle_part;
};

// `light_ws`: of a light that is somewhere.
Stretch stretch_of(vec3 origin, vec3 direction, vec2 ends, float extinction, vec3 light_ws, bool is_somewhere) {
    float nearest = dot(light_ws - origin, direction);
    float wide = ends.y - ends.x;
    // A ray through the light itself is given a little room: any distance makes a density, the true one the best.
    float off = max(distance(light_ws, origin + direction * nearest), 1e-6 * wide);
    vec2 from_nearest = ends - nearest;
    // The difference of two arcs, which are next to each other where the light is far, by one.
    float angle = atan(off * wide, off * off + from_nearest.x * from_nearest.y);
    return Stretch(ends, extinction, nearest, off, angle, is_somewhere && angle > 0.0 ? 0.5 : 0.0);
}

float place_on(Stretch stretch, float choice, float number) {
    float place = stretch.ends.x - log(1.0 - number * stopped_by(stretch.extinction * (stretch.ends.y - stretch.ends.x)))
        / stretch.extinction;
    if (choice < stretch.angle_part) {
        float turned = number * stretch.angle;
        float begin = stretch.ends.x - stretch.nearest;
        place = stretch.nearest + stretch.off * (begin * cos(turned) + stretch.off * sin(turned))
            / (stretch.off * cos(turned) - begin * sin(turned));
    }
    return clamp(place, stretch.ends.x, stretch.ends.y);
}

// Per metre, of what place_on draws.
float density_on(Stretch stretch, float place) {
    float passed = stretch.extinction * exp(-stretch.extinction * (place - stretch.ends.x))
        / stopped_by(stretch.extinction * (stretch.ends.y - stretch.ends.x));
    float past = place - stretch.nearest;
    float seen = stretch.off / (max(stretch.angle, 1e-30) * (stretch.off * stretch.off + past * past));
    return mix(passed, seen, stretch.angle_part);
}

#endif
