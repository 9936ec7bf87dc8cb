// The medium of --medium: what it stops, and what it scatters into a stretch of a path straight from the lights.
#ifndef PATH_TRACED_AIRLIGHT_GLSL
#define PATH_TRACED_AIRLIGHT_GLSL

#include "techniques/path_traced/next_event.glsl"

const uint MEDIUM_NONE = 0u;
// It stops light, and what it scatters is not counted.
const uint MEDIUM_DIMS = 1u;
const uint MEDIUM_SCATTERS = 2u;

// What arrives of `light`, which waits at `origin`, through the medium.
Waiting dimmed(Waiting light, vec3 origin) {
    if (MEDIUM != MEDIUM_NONE && light.distance > 0.0) {
        light.radiance *= passed_by(params.medium, in_medium(params.medium, origin, light.direction_ws, 0.0, light.distance));
    }
    return light;
}

// Light of one source, of all kinds by power, that is scattered at one place of a ray's stretch in the medium.
Waiting airlight(vec3 origin, vec3 direction, vec2 ends, out vec3 place_ws) {
    place_ws = origin;
    if (params.emitter_count + params.punctual_count == 0u || ends.y <= ends.x) {
        return NOTHING;
    }
    vec2 choices = next_pair();
    vec2 barycentric = barycentric_of(next_pair());
    float number = next_pair().x;
    bool is_punctual = choices.x < params.punctual_part;
    float part = is_punctual ? params.punctual_part : 1.0 - params.punctual_part;
    float choice = (is_punctual ? choices.x : choices.x - params.punctual_part) / part;
    uint first = is_punctual ? params.emitter_count : 0u;
    uint count = is_punctual ? params.punctual_count : params.emitter_count;
    SourceBlock source = source_of(first, count, min(choice, 0.99999994));
    // There may be none of either kind: only what was chosen is read.
    LightBlock light;
    vec3 source_ws;
    bool is_somewhere = true;
    if (is_punctual) {
        light = light_at(source.index);
        source_ws = light.position_ws.xyz;
        is_somewhere = !is_directional(light);
    } else {
        source_ws = place_of(source.index, barycentric);
    }
    Stretch stretch = stretch_of(origin, direction, ends, params.medium.extinction, source_ws, is_somewhere);
    float place = place_on(stretch, choices.y, number);
    place_ws = origin + direction * place;
    Waiting waiting = NOTHING;
    if (is_punctual) {
        Incident incident = incident_at(light, place_ws, next_on_sphere());
        waiting = Waiting(incident.irradiance / source.chance, incident.direction_ws, incident.distance);
        waiting.radiance *= phase(params.medium.asymmetry, dot(incident.direction_ws, direction));
    } else {
        uint triangle = source.index;
        Shining shining = shining_to(place_ws, source, source_ws);
        if (shining.density > 0.0) {
            float scattered = phase(params.medium.asymmetry, dot(shining.direction_ws, direction));
            waiting = Waiting(emitted_at(triangle, barycentric), shining.direction_ws, shining.distance);
            waiting.radiance *= scattered / shining.density;
            // Directions that the medium scatters into find emitters too.
            if (AIRLIGHT_SEEN == 0u) {
                if (LIGHT_VISIBILITY != 0u) {
                    waiting.radiance *= weight_of(shining.density, scattered);
                }
            }
        }
    }
    float passed = exp(-params.medium.extinction * (place - ends.x));
    waiting.radiance *= params.medium.scattering * passed / (density_on(stretch, place) * part);
    return dimmed(waiting, place_ws);
}

#endif
