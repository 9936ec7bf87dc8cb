// Light that reaches a point straight from a light: one punctual light and one point of an emitter a vertex, before the
// shadow ray has said whether it arrives.
#ifndef PATH_TRACED_NEXT_EVENT_GLSL
#define PATH_TRACED_NEXT_EVENT_GLSL

#include "techniques/path_traced/path.glsl"

// Lights of the list that a vertex looks at; of a longer list every n-th, from a place that is drawn.
const uint MOST_LOOKS = 256u;

// Light on its way along a shadow ray; all 0 where there is none.
struct Waiting {
    vec3 radiance;
    vec3 direction_ws;
    // 0: there is no ray to be sent.
    float distance;
};

const Waiting NOTHING = Waiting(vec3(0.0), vec3(0.0, 0.0, 1.0), 0.0);

vec3 reflected_by(SurfacePoint point, vec3 to_light, vec3 to_eye) {
    float cosine = dot(point.normal_ws, to_light);
    return cosine > 0.0 ? brdf(BRDF_KIND, point.surface, point.normal_ws, to_light, to_eye) * cosine : vec3(0.0);
}

// Chosen as strongly as each would light the point if nothing stood between.
Waiting punctual_light(SurfacePoint point, vec3 to_eye) {
    Waiting chosen = NOTHING;
    if (frame.light_count == 0u) {
        return chosen;
    }
    vec2 numbers = next_pair();
    // One point of each is what its chance is of: lights may share its numbers.
    vec2 on_sphere = next_on_sphere();
    uint stride = (frame.light_count + MOST_LOOKS - 1u) / MOST_LOOKS;
    float sum = 0.0;
    float choice = numbers.x;
    float chosen_weight = 1.0;
    uint light = min(uint(numbers.y * float(stride)), stride - 1u);
    for (; light < frame.light_count; light += stride) {
        Incident incident = incident_at(light_at(light), point.position_ws, on_sphere);
        vec3 radiance = reflected_by(point, incident.direction_ws, to_eye) * incident.irradiance;
        float weight = largest(radiance);
        if (weight > 0.0) {
            sum += weight;
            float chance = weight / sum;
            bool is_chosen = choice < chance;
            choice = is_chosen ? choice / chance : (choice - chance) / max(1.0 - chance, 1e-7);
            choice = min(choice, 0.99999994);
            if (is_chosen) {
                chosen = Waiting(radiance, incident.direction_ws, incident.distance);
                chosen_weight = weight;
            }
        }
    }
    expect_done(light >= frame.light_count);
    chosen.radiance *= float(stride) * sum / chosen_weight;
    return chosen;
}

// How much a direction that was drawn with density `drawn` counts beside one that `other` could have drawn (Veach's
// power heuristic).
float weight_of(float drawn, float other) {
    float ratio = other / drawn;
    return 1.0 / (1.0 + ratio * ratio);
}

vec3 place_of(uint triangle_index, vec2 barycentric) {
    BvhTriangleBlock triangle = triangle_at(triangle_index);
    return triangle.corner.xyz + triangle.edge1.xyz * barycentric.x + triangle.edge2.xyz * barycentric.y;
}

// A point of an emitter as another point sees it.
struct Shining {
    vec3 direction_ws;
    float distance;
    // Over solid angle, of the choice of that point; 0: it does not shine here.
    float density;
};

// `at_ws`: of the triangle that `source` is.
Shining shining_to(vec3 position_ws, SourceBlock source, vec3 at_ws) {
    BvhTriangleBlock triangle = triangle_at(source.index);
    vec3 to_light = at_ws - position_ws;
    float distance_squared = max(dot(to_light, to_light), 1e-12);
    float distance = sqrt(distance_squared);
    vec3 direction = to_light / distance;
    vec3 twice = cross(triangle.edge1.xyz, triangle.edge2.xyz);
    float area = 0.5 * length(twice);
    float cosine = abs(dot(twice, direction)) / max(2.0 * area, 1e-30);
    bool is_lit_side = is_front_of(triangle, direction)
        || (floatBitsToUint(triangle.corner.w) & TRIANGLE_SINGLE_SIDED) == 0u;
    bool shines = is_lit_side && cosine > 0.0;
    return Shining(direction, distance, shines ? source.chance / area * distance_squared / cosine : 0.0);
}

Waiting emitter(SurfacePoint point, vec3 to_eye) {
    if (params.emitter_count == 0u) {
        return NOTHING;
    }
    vec2 numbers = next_pair();
    vec2 place = next_pair();
    SourceBlock source = source_of(0u, params.emitter_count, numbers.x);
    vec2 barycentric = barycentric_of(place);
    Shining shining = shining_to(point.position_ws, source, place_of(source.index, barycentric));
    vec3 direction = shining.direction_ws;
    // Behind the plane of the triangle that the point lies on nothing arrives, as no ray that is scattered goes there.
    if (shining.density <= 0.0 || dot(point.plane_ws, direction) <= 0.0) {
        return NOTHING;
    }
    vec3 radiance = reflected_by(point, direction, to_eye) * emitted_at(source.index, barycentric) / shining.density;
    // Without shadows there is no ray that could find the emitter.
    if (LIGHT_VISIBILITY != 0u) {
        float scattered = scatter_density(BRDF_KIND, point.surface, point.normal_ws, direction, to_eye);
        radiance *= weight_of(shining.density, scattered);
    }
    return Waiting(radiance, direction, shining.distance);
}

#endif
