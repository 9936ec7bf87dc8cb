// One path a pixel, added to those before it. Pass: src/techniques/path_traced/sample.rs.
// variants: ALPHA=opaque|tested RAYS=two|four|query VOLUME=none|seen
#version 460
#ifdef RAYS_FOUR
#define NODES_FOUR
#endif
#ifdef RAYS_QUERY
#extension GL_EXT_ray_query : require
#endif
#include "techniques/path_traced/path.glsl"
#include "techniques/path_traced/airlight.glsl"
#include "techniques/path_traced/light_walk.glsl"
#ifdef VOLUME_SEEN
#include "shading/volume_march.glsl"
#endif

// Rays leave through the middles of pixels; else from anywhere in them.
layout(constant_id = 16) const uint IN_MIDDLES = 0u;

// Paths end by chance from this surface on.
const uint ROULETTE_FROM = 3u;

// The path of a pixel's sample, and where it continues.
struct Path {
    vec3 origin;
    vec3 direction;
    // How far the ray reaches, and how far before its origin it would begin if no near plane cut it.
    float limit;
    float behind;
    vec3 throughput;
    // Over solid angle, of the direction by which the path came here.
    float density;
    // Surfaces and places of the medium that have scattered it.
    uint bounce;
    bool goes_on;
    // Whether what shines on the place that the path comes from is counted: by DIRECT_LIGHT not on the surface that is
    // seen.
    bool is_lit;
    // Width of the ray's cone at the origin, metres, and by how much it grows a metre.
    float cone_width;
    float cone_spread;
};

// Moves a ray of `view` from the camera's place to a point of the lens; both meet in the plane in focus. `near`: how
// far before the lens its origin lies.
void through_lens(FrameBlock view, inout Path path, vec2 numbers, float near) {
    vec3 right = normalize(view.world_from_clip[0].xyz);
    vec3 down = normalize(view.world_from_clip[1].xyz);
    vec3 forward = view.forward_ws.xyz;
    float angle = 2.0 * PI * numbers.y;
    vec3 aside = (right * cos(angle) + down * sin(angle)) * (params.lens_radius * sqrt(numbers.x));
    aside += right * params.lens_aside;
    float steepness = dot(path.direction, forward);
    // From the origin on: next to it floats are finer than next to the world's.
    vec3 focused = path.direction * (params.focus / steepness);
    vec3 direction = normalize(focused - aside);
    float longer = steepness / dot(direction, forward);
    path.origin += aside + (direction * longer - path.direction) * (near / steepness);
    path.limit = path.limit < FAR ? path.limit * longer : FAR;
    path.behind *= longer;
    path.direction = direction;
}

// The ray of `view` through a place of the picture and, as `lens` says, of the lens, from the near plane to the far one.
Path view_path(FrameBlock view, vec2 at_px, vec2 lens) {
    ViewRay ray = view_ray(view, at_px);
    float width = params.cone_width + params.cone_spread * ray.behind;
    Path path = Path(ray.origin, ray.direction, ray.limit, ray.behind, vec3(1.0), 0.0, 0u, true, true, width, params.cone_spread);
    if (HAS_LENS != 0u) {
        through_lens(view, path, lens, ray.near);
    }
    return path;
}

Path camera_path(vec2 at_px) {
    vec2 lens = vec2(0.0);
    if (HAS_LENS != 0u) {
        lens = next_pair();
    }
    Path path = view_path(frame, at_px, lens);
    if (MOVES != 0u) {
        shutter_part = next_pair().x;
        Path closing = view_path(frame_closing, at_px, lens);
        path.origin = mix(path.origin, closing.origin, shutter_part);
        path.direction = normalize(mix(path.direction, closing.direction, shutter_part));
        path.behind = mix(path.behind, closing.behind, shutter_part);
        path.limit = min(path.limit, closing.limit);
    }
    return path;
}

// Whether what shines straight on a surface that this path finds is counted.
bool lights_surface(Path path) {
    return DIRECT_LIGHT != 0u || path.bounce != 0u;
}

// Radiance from around the scene on a ray that was scattered so often.
vec3 surroundings(uint bounce, bool is_lit) {
    if (AMBIENT_VISIBILITY == AMBIENT_FOUND) {
        return is_lit ? frame.background.rgb + frame.ambient.rgb : vec3(0.0);
    }
    if (AMBIENT_VISIBILITY == AMBIENT_FOUND_ONCE) {
        return bounce == 1u ? frame.ambient.rgb : vec3(0.0);
    }
    return vec3(0.0);
}

// What a path may still find by scattering in the medium: a last scattering leads to what shines by itself alone.
bool finds_more(Path path) {
    if (AIRLIGHT_SEEN != 0u) {
        return false;
    }
    return path.bounce + 1u < BOUNCES || params.emitter_count > 0u || largest(surroundings(path.bounce + 1u, true)) > 0.0;
}

// Width of the path's cone at a distance from its origin.
float cone_width_at(Path path, float distance) {
    return path.cone_width + path.cone_spread * distance;
}

// `distance`: from the path's origin to the new one. `spread`: by how much more its cone grows a metre from there on.
void turn(
    inout Path path,
    float distance,
    float spread,
    vec3 origin,
    vec3 direction,
    bool is_lit,
    float survivor
) {
    path.cone_width = cone_width_at(path, distance);
    path.cone_spread += spread;
    if (ROULETTE != 0u && path.bounce >= ROULETTE_FROM) {
        float survival = clamp(largest(path.throughput), 0.05, 0.95);
        path.throughput = survivor < survival ? path.throughput / survival : vec3(0.0);
    }
    path.goes_on = largest(path.throughput) > 0.0;
    path.origin = origin;
    path.direction = direction;
    path.limit = FAR;
    path.behind = 0.0;
    path.is_lit = is_lit;
    path.bounce++;
}

void scatter_in_medium(inout Path path, float distance) {
    vec3 place_ws = path.origin + path.direction * distance;
    vec2 numbers = next_pair();
    vec2 choice = next_pair();
    vec3 scattered = phase_direction(params.medium.asymmetry, path.direction, numbers);
    path.density = phase(params.medium.asymmetry, dot(scattered, path.direction));
    path.throughput *= params.medium.scattering / params.medium.extinction;
    turn(path, distance, 1.0, place_ws, scattered, true, choice.y);
}

void scatter_at(inout Path path, SurfacePoint point, float distance) {
    vec3 to_eye = -path.direction;
    vec2 numbers = next_pair();
    vec2 choice = next_pair();
    vec3 scattered = scatter_direction(BRDF_KIND, point.surface, point.normal_ws, to_eye, choice.x, numbers);
    path.density = scatter_density(BRDF_KIND, point.surface, point.normal_ws, scattered, to_eye);
    vec3 reflected = reflected_by(point, scattered, to_eye);
    bool leaves = dot(scattered, point.plane_ws) > 0.0 && path.density > 0.0;
    path.throughput *= leaves ? reflected / max(path.density, 1e-20) : vec3(0.0);
    float spread = BRDF_KIND == BRDF_LAMBERT ? 1.0 : point.surface.roughness * point.surface.roughness;
    turn(path, distance, spread, off_surface(point), scattered, lights_surface(path), choice.y);
}

// What a surface sends along the path by itself.
vec3 emitted_along(Path path, SurfacePoint point, float distance) {
    if (path.bounce == 0u) {
        return path.throughput * point.emitted;
    }
    if (path.is_lit && point.emitter_density > 0.0 && LIGHT_VISIBILITY != 0u && IS_WALKED == 0u) {
        float cosine = max(abs(dot(point.plane_ws, path.direction)), 1e-12);
        float other = point.emitter_density * distance * distance / cosine;
        return path.throughput * point.emitted * weight_of(path.density, other);
    }
    return vec3(0.0);
}

// Radiance along the ray through a place of the picture.
vec3 radiance_along(vec2 at_px) {
    Path path = camera_path(at_px);
    vec3 radiance = vec3(0.0);
    Waiting light = NOTHING;
    Waiting panel = NOTHING;
    // Scattered by the medium, and where.
    Waiting air = NOTHING;
    vec3 air_ws = path.origin;
    bool is_waiting = false;
    // Shadow rays of the place before, and the ray to the next one: in one loop, so that the walk is there once.
    uint rays = 3u;
    if (MEDIUM == MEDIUM_SCATTERS) {
        rays = 4u;
    }
    while (path.goes_on || is_waiting) {
        TraceHit hit;
        uint ray = 0u;
        for (; ray < rays; ray++) {
            bool is_path = ray == rays - 1u;
            Waiting waiting = panel;
            vec3 origin = path.origin;
            if (ray == 0u) {
                waiting = light;
            } else if (MEDIUM == MEDIUM_SCATTERS && ray == 2u) {
                waiting = air;
                origin = air_ws;
            }
            float shadow_limit = LIGHT_VISIBILITY != 0u ? waiting.distance - 2.0 * RAY_OFFSET : 0.0;
            TraceHit met = trace(
                is_path ? path.origin : origin,
                is_path ? path.direction : waiting.direction_ws,
                is_path ? (path.goes_on ? path.limit : 0.0) : shadow_limit,
                is_path ? (path.bounce == 0u ? RAY_CAMERA : 0u) : RAY_SHADOW,
                next_seed()
            );
            if (is_path) {
                hit = met;
            } else if (!met.is_hit) {
                radiance += waiting.radiance;
            }
        }
        expect_done(ray == rays);
        light = NOTHING;
        panel = NOTHING;
        air = NOTHING;
        is_waiting = false;
        if (!path.goes_on) {
            break;
        }
#ifdef VOLUME_SEEN
        if (path.bounce == 0u) {
            vec4 passed = march(path.origin, path.direction, hit.distance, params.volume_steps);
            radiance += path.throughput * passed.rgb;
            path.throughput *= passed.w;
        }
#endif
        bool is_in_medium = false;
        float place = 0.0;
        if (MEDIUM != MEDIUM_NONE) {
            vec2 ends = in_medium(params.medium, path.origin, path.direction, -path.behind, hit.distance);
            bool scatters = MEDIUM == MEDIUM_SCATTERS && path.bounce < BOUNCES;
            if (AIRLIGHT_SEEN != 0u) {
                scatters = scatters && path.bounce == 0u;
            }
            if (scatters) {
                air = airlight(path.origin, path.direction, ends, air_ws);
                air.radiance *= path.throughput;
                is_waiting = air.distance > 0.0;
            }
            if (scatters && finds_more(path)) {
                place = ends.x - log(1.0 - next_pair().x) / params.medium.extinction;
                is_in_medium = place < ends.y;
            } else {
                path.throughput *= passed_by(params.medium, ends);
            }
        }
        if (is_in_medium) {
            scatter_in_medium(path, place);
        } else if (!hit.is_hit) {
            vec3 around = path.bounce == 0u ? frame.background.rgb : surroundings(path.bounce, path.is_lit);
            radiance += path.throughput * around;
            path.goes_on = false;
        } else {
            SurfacePoint point = surface_point(hit.triangle, hit.barycentric, path.direction, cone_width_at(path, hit.distance));
            path.goes_on = !point.is_back && (!point.is_unlit || path.bounce == 0u);
            if (path.goes_on) {
                radiance += emitted_along(path, point, hit.distance);
                path.goes_on = !point.is_unlit && path.bounce < BOUNCES;
            }
            if (path.goes_on) {
                if (AMBIENT_VISIBILITY == AMBIENT_ADDED && path.bounce == 0u) {
                    vec3 reflected = ambient_reflectance(BRDF_KIND, point.surface) * frame.ambient.rgb;
                    radiance += path.throughput * reflected * point.openness;
                }
                vec3 to_eye = -path.direction;
                light = punctual_light(point, to_eye);
                panel = IS_WALKED != 0u ? NOTHING : emitter(point, to_eye);
                if (!lights_surface(path)) {
                    light = NOTHING;
                    panel = NOTHING;
                }
                light.radiance *= path.throughput;
                panel.radiance *= path.throughput;
                light = dimmed(light, point.position_ws);
                panel = dimmed(panel, point.position_ws);
                is_waiting = true;
                if (IS_WALKED != 0u) {
                    radiance += path.throughput * walked_radiance(point, to_eye);
                }
                scatter_at(path, point, hit.distance);
            }
        }
    }
    expect_done(!path.goes_on && !is_waiting);
    return radiance;
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= frame.width_px || pixel.y >= frame.height_px) {
        return;
    }
    numbers_seed = pixel_seed(pixel, params.seed);
    numbers_pair = 0u;
    vec2 inside = IN_MIDDLES != 0u ? vec2(0.5) : sobol_pair(frame.sample_index, pair_seed(numbers_seed, 0u));
    vec3 radiance = nan_if_cut(radiance_along(vec2(pixel) + inside));
    uint at = pixel.y * frame.width_px + pixel.x;
    vec4 sum = frame.sample_index == 0u ? vec4(0.0) : sums[at];
    sum += vec4(radiance, dot(radiance, radiance));
    sums[at] = sum;
    imageStore(color, ivec2(pixel), vec4(sum.rgb / float(frame.sample_index + 1u), 1.0));
}
