// Light between surfaces as virtual point lights give it, where it may pass through walls: a light walk of its own for each
// pixel and sample, whose landings light the pixel's point by VPL_BRDF, with the facing test and the clamp of vpl_irradiance. Twin of
// the walk: src/lights/vpl.rs. Its mean is what infinitely many virtual point lights sum up to.
#ifndef PATH_TRACED_LIGHT_WALK_GLSL
#define PATH_TRACED_LIGHT_WALK_GLSL

#include "shading/light_start.glsl"
#include "techniques/path_traced/next_event.glsl"

// Starts are divided by how likely each is. `vpl`: the start itself, which is a light.
LightStart start_on_emitter(float number, float chance, out VplBlock vpl) {
    SourceBlock source = source_of(0u, params.emitter_count, number);
    vec2 barycentric = barycentric_of(next_pair());
    BvhTriangleBlock triangle = triangle_at(source.index);
    vec3 twice = cross(triangle.edge1.xyz, triangle.edge2.xyz);
    uint flags = floatBitsToUint(triangle.corner.w);
    vec3 normal = normalize(twice);
    float area = 0.5 * length(twice) / (source.chance * chance);
    vec2 numbers = next_pair();
    normal = (flags & TRIANGLE_MIRRORED) != 0u ? -normal : normal;
    if ((flags & TRIANGLE_SINGLE_SIDED) == 0u) {
        // Both sides shine: each walk takes one of them, and represents both.
        area *= 2.0;
        normal = numbers.x < 0.5 ? normal : -normal;
    }
    vec3 at = place_of(source.index, barycentric);
    vec3 radiance = emitted_at(source.index, barycentric);
    vpl = VplBlock(vec4(at, 0.0), vec4(normal, 0.0), vec4(radiance * area, 0.0));
    return LightStart(at + normal * RAY_OFFSET, cosine_direction(normal, next_pair()), radiance * area * PI);
}

LightStart start_on_punctual(float number, float chance) {
    SourceBlock source = source_of(params.emitter_count, params.punctual_count, number);
    LightBlock light = light_at(source.index);
    light.intensity.rgb /= source.chance * chance;
    LightStart start = start_of(light, next_pair(), params.sphere_ws);
    if (HAS_SPHERES != 0u) {
        start.origin += leaving_sphere(radius_of(light), start.direction, next_pair());
    }
    return start;
}

// What a virtual light does to a point: irradiance under Lambert's, which all lights share; else radiance towards the eye.
vec3 added_by(VplBlock vpl, SurfacePoint point, vec3 to_eye) {
    vec3 received = vpl_irradiance(vpl, point.position_ws, point.normal_ws, params.least_squared);
    if (VPL_BRDF == BRDF_LAMBERT) {
        return received;
    }
    float distance;
    vec3 towards = towards_vpl(vpl, point.position_ws, distance);
    return received * brdf(VPL_BRDF, point.surface, point.normal_ws, towards, to_eye);
}

// Radiance that the point sends towards the eye.
vec3 walked_radiance(SurfacePoint point, vec3 to_eye) {
    vec3 received = vec3(0.0);
    if (params.emitter_count + params.punctual_count == 0u) {
        return received;
    }
    float number = next_pair().x;
    bool is_punctual = number < params.punctual_part;
    LightStart start;
    if (is_punctual) {
        start = start_on_punctual(min(number / params.punctual_part, 0.99999994), params.punctual_part);
    } else {
        float part = 1.0 - params.punctual_part;
        VplBlock vpl;
        start = start_on_emitter(min((number - params.punctual_part) / part, 0.99999994), part, vpl);
        if (DIRECT_LIGHT != 0u) {
            received += added_by(vpl, point, to_eye);
        }
    }
    vec3 origin = start.origin;
    vec3 direction = start.direction;
    vec3 flux = start.flux;
    uint landing = 0u;
    bool goes_on = true;
    for (; landing < WALK_LANDINGS && goes_on; landing++) {
        TraceHit hit = trace(origin, direction, 4.0 * params.sphere_ws.w, RAY_SOLID, 0u);
        goes_on = hit.is_hit;
        if (goes_on) {
            SurfacePoint landed = surface_point(hit.triangle, hit.barycentric, direction, 0.0);
            bool is_black = landed.is_back || landed.is_unlit;
            flux = is_black ? vec3(0.0) : flux * albedo_of(landed.surface);
            vec4 intensity = vec4(flux / PI, 0.0);
            VplBlock vpl = VplBlock(vec4(landed.position_ws, 0.0), vec4(landed.plane_ws, 0.0), intensity);
            received += added_by(vpl, point, to_eye);
            origin = off_surface(landed);
            direction = cosine_direction(landed.plane_ws, next_pair());
            goes_on = flux != vec3(0.0);
        }
    }
    expect_done(landing == WALK_LANDINGS || !goes_on);
    return VPL_BRDF == BRDF_LAMBERT ? albedo_of(point.surface) / PI * received : received;
}

#endif
