// One path a pixel, added to those before it. Pass: src/techniques/path_traced/sample.rs.
// variants: ALPHA=opaque|tested
#version 460
#include "techniques/path_traced/path.glsl"
#include "techniques/path_traced/next_event.glsl"
#include "techniques/path_traced/light_walk.glsl"

const float FAR = 1e30;
// Paths end by chance from this surface on.
const uint ROULETTE_FROM = 3u;

// The ray through a place of the picture, from the near plane to the far one.
void camera_ray(vec2 at_px, out vec3 origin, out vec3 direction, out float limit) {
    vec2 ndc = at_px / vec2(frame.width_px, frame.height_px) * 2.0 - 1.0;
    vec4 near = frame.world_from_clip * vec4(ndc, 1.0, 1.0);
    vec4 far = frame.world_from_clip * vec4(ndc, 0.0, 1.0);
    bool is_perspective = frame.eye_ws.w > 0.0;
    // A far plane at infinity has w = 0: this is a direction all the same.
    direction = is_perspective ? normalize(far.xyz - frame.eye_ws.xyz * far.w) : frame.forward_ws.xyz;
    vec3 start = near.xyz / near.w;
    // Along the ray, and not to the near plane's own point, which floats place too roughly next to the eye.
    origin = is_perspective ? frame.eye_ws.xyz + direction * distance(start, frame.eye_ws.xyz) : start;
    limit = far.w > 0.0 ? min(distance(far.xyz / far.w, origin), FAR) : FAR;
}

// Radiance along the ray through a place of the picture.
vec3 radiance_along(vec2 at_px) {
    vec3 origin;
    vec3 direction;
    float limit;
    camera_ray(at_px, origin, direction, limit);
    vec3 radiance = vec3(0.0);
    vec3 throughput = vec3(1.0);
    // Over solid angle, of the direction by which the path came here.
    float density = 0.0;
    Waiting light = NOTHING;
    Waiting panel = NOTHING;
    uint bounce = 0u;
    bool goes_on = true;
    bool is_waiting = false;
    while (goes_on || is_waiting) {
        bool is_camera = bounce == 0u;
        TraceHit hit;
        uint ray = 0u;
        // Shadow rays of the surface before, and the ray to the next one: in one loop, so that the walk is there once.
        for (; ray < 3u; ray++) {
            bool is_path = ray == 2u;
            Waiting waiting = panel;
            if (ray == 0u) {
                waiting = light;
            }
            float shadow_limit = LIGHT_VISIBILITY != 0u ? waiting.distance - 2.0 * RAY_OFFSET : 0.0;
            TraceHit met = trace(
                origin,
                is_path ? direction : waiting.direction_ws,
                is_path ? (goes_on ? limit : 0.0) : shadow_limit,
                is_path ? (is_camera ? RAY_CAMERA : 0u) : RAY_SHADOW,
                next_seed()
            );
            if (is_path) {
                hit = met;
            } else if (!met.is_hit) {
                radiance += waiting.radiance;
            }
        }
        expect_done(ray == 3u);
        light = NOTHING;
        panel = NOTHING;
        is_waiting = false;
        if (!goes_on) {
            break;
        }
        if (!hit.is_hit) {
            vec3 around_all = is_camera ? frame.background.rgb : frame.background.rgb + frame.ambient.rgb;
            radiance += throughput * around_all;
            break;
        }
        SurfacePoint point = surface_point(hit.triangle, hit.barycentric, direction);
        vec3 to_eye = -direction;
        if (point.is_back || (point.is_unlit && !is_camera)) {
            break;
        }
        if (is_camera) {
            radiance += throughput * point.emitted;
        } else if (point.emitter_density > 0.0 && LIGHT_VISIBILITY != 0u && IS_WALKED == 0u) {
            float cosine = max(abs(dot(point.plane_ws, direction)), 1e-12);
            float other = point.emitter_density * hit.distance * hit.distance / cosine;
            radiance += throughput * point.emitted * weight_of(density, other);
        }
        goes_on = !point.is_unlit && bounce < BOUNCES;
        if (goes_on) {
            light = punctual_light(point, to_eye);
            panel = IS_WALKED != 0u ? NOTHING : emitter(point, to_eye);
            light.radiance *= throughput;
            panel.radiance *= throughput;
            is_waiting = true;
            if (IS_WALKED != 0u) {
                radiance += throughput * albedo_of(point.surface) / PI * walked_irradiance(point);
            }
            vec2 numbers = next_pair();
            vec2 choice = next_pair();
            vec3 scattered =
                scatter_direction(BRDF_KIND, point.surface, point.normal_ws, to_eye, choice.x, numbers);
            density = scatter_density(BRDF_KIND, point.surface, point.normal_ws, scattered, to_eye);
            vec3 reflected = reflected_by(point, scattered, to_eye);
            bool leaves = dot(scattered, point.plane_ws) > 0.0 && density > 0.0;
            throughput *= leaves ? reflected / max(density, 1e-20) : vec3(0.0);
            if (ROULETTE != 0u && bounce >= ROULETTE_FROM) {
                float survival = clamp(largest(throughput), 0.05, 0.95);
                throughput = choice.y < survival ? throughput / survival : vec3(0.0);
            }
            goes_on = largest(throughput) > 0.0;
            origin = off_surface(point);
            direction = scattered;
            limit = FAR;
            bounce++;
        }
    }
    expect_done(!is_waiting);
    return radiance;
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= frame.width_px || pixel.y >= frame.height_px) {
        return;
    }
    numbers_seed = pixel_seed(pixel, params.seed);
    numbers_pair = 0u;
    vec3 radiance = nan_if_cut(radiance_along(vec2(pixel) + sobol_pair(frame.sample_index, pair_seed(numbers_seed, 0u))));
    uint at = pixel.y * frame.width_px + pixel.x;
    vec4 sum = frame.sample_index == 0u ? vec4(0.0) : sums[at];
    sum += vec4(radiance, dot(radiance, radiance));
    sums[at] = sum;
    imageStore(color, ivec2(pixel), vec4(sum.rgb / float(frame.sample_index + 1u), 1.0));
}
