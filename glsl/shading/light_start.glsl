// Where a walk of light starts on a punctual light. Twin: src/shading/light.rs, `LightStart`.
#ifndef SHADING_LIGHT_START_GLSL
#define SHADING_LIGHT_START_GLSL

#include "shading/light.glsl"
#include "shading/scatter.glsl"

struct LightStart {
    vec3 origin;
    vec3 direction;
    // Carried by the whole walk.
    vec3 flux;
};

// `numbers`: 0 to 1. `sphere_ws`: around the scene, the radius in w; a directional light starts on a disc before it.
LightStart start_of(LightBlock light, vec2 numbers, vec4 sphere_ws) {
    LightStart start;
    float angle = 2.0 * PI * numbers.y;
    if (is_directional(light)) {
        float radius = sphere_ws.w;
        vec3 on_disc = around(light.direction_ws.xyz, vec3(cos(angle), sin(angle), 0.0) * (radius * sqrt(numbers.x)));
        start.origin = sphere_ws.xyz + on_disc - light.direction_ws.xyz * (1.01 * radius);
        start.direction = light.direction_ws.xyz;
        start.flux = light.intensity.rgb * (PI * radius * radius);
        return start;
    }
    // Uniform in the outer cone, which is the whole sphere of a point.
    bool is_spot = is_kind(light, LIGHT_SPOT);
    float outer = is_spot ? -light.spot_offset / light.spot_scale : -1.0;
    float z = 1.0 - numbers.x * (1.0 - outer);
    float radius = sqrt(max(1.0 - z * z, 0.0));
    vec3 axis = is_spot ? light.direction_ws.xyz : vec3(0.0, 0.0, 1.0);
    float cone = is_spot ? clamp(z * light.spot_scale + light.spot_offset, 0.0, 1.0) : 1.0;
    start.origin = light.position_ws.xyz;
    start.direction = around(axis, vec3(radius * cos(angle), radius * sin(angle), z));
    start.flux = light.intensity.rgb * (2.0 * PI * (1.0 - outer) * cone * cone);
    return start;
}

#endif
