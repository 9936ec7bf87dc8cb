// Point and spot lights that are spheres (--light-radius). Twin: src/shading/light.rs.
#ifndef SHADING_LIGHT_SPHERE_GLSL
#define SHADING_LIGHT_SPHERE_GLSL

#include "shading/light.glsl"
#include "shading/scatter.glsl"

float radius_of(LightBlock light) {
    return is_directional(light) ? 0.0 : light.direction_ws.w;
}

// As incident_from, of a point of the light's sphere, drawn evenly over the part that is seen: the mean over `numbers`,
// 0 to 1, is what all of the sphere gives. Dark inside the sphere.
Incident incident_from_sphere(LightBlock light, vec3 position_ws, vec2 numbers) {
    Incident center = incident_from(light, position_ws);
    float radius = radius_of(light);
    if (radius <= 0.0) {
        return center;
    }
    // A sphere shines to its outside.
    if (center.distance <= radius) {
        return Incident(center.direction_ws, center.distance, vec3(0.0));
    }
    float ratio = radius / center.distance;
    float sine_squared = ratio * ratio;
    float least_cosine = sqrt(max(1.0 - sine_squared, 0.0));
    // 1 - cosine, without the difference of two numbers next to each other.
    float fallen = numbers.x * sine_squared / (1.0 + least_cosine);
    float cosine = 1.0 - fallen;
    float sine = sqrt(max(fallen * (2.0 - fallen), 0.0));
    float angle = 2.0 * PI * numbers.y;
    vec3 towards = around(center.direction_ws, vec3(sine * cos(angle), sine * sin(angle), cosine));
    float beside = center.distance * sine;
    float distance = center.distance * cosine - sqrt(max(radius * radius - beside * beside, 0.0));
    // Radiance is intensity over the sphere's disc, and the sphere covers 2 pi (1 - least_cosine).
    float seen = 2.0 / (1.0 + least_cosine);
    return Incident(towards, distance, irradiance_along(light, center.distance * center.distance, towards) * seen);
}

// Where light leaves a sphere for `direction_ws`, from its middle: evenly over the disc that is seen from there.
vec3 leaving_sphere(float radius, vec3 direction_ws, vec2 numbers) {
    return radius * cosine_direction(direction_ws, numbers);
}

#endif
