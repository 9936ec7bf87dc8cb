// The surface of a light's shadow volumes, for the stencil. Kircher & Lawrance 2009, section 4.
// Pass: src/techniques/inferred_lighting/light/shadow_volumes.rs.
#version 460
#include "frame.glsl"
#include "shading/light.glsl"
#include "techniques/inferred_lighting/light/volumes.glsl"

// World space. w = 1: a point; w = 0: the end of a ray away from the light.
layout(location = 0) in vec4 position;

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 1) readonly buffer Lights { LightBlock lights[]; };

// Parts of its distance by which a volume is farther than what casts it: some 30 roundings of a float.
const float AWAY = 1.0 / 262144.0;
// How many times its own length a ray is long where it has to end.
const float ENDLESS = 1048576.0;

// Parallel projection has no picture of what is infinitely far: rays end there, far outside of any scene.
vec4 ended(vec4 at) {
    if (at.w > 0.0) {
        return at;
    }
    LightBlock light = lights[params.light];
    if (is_directional(light)) {
        vec3 middle = frame.box_min_ws.xyz + 0.5 * frame.box_size_ws.xyz;
        return vec4(middle + at.xyz * (ENDLESS * length(frame.box_size_ws.xyz)), 1.0);
    }
    return vec4(light.position_ws.xyz + at.xyz * ENDLESS, 1.0);
}

void main() {
    bool is_perspective = frame.eye_ws.w > 0.0;
    vec4 at = is_perspective ? position : ended(position);
    // What distance times depth falls by as the distance grows by its own length; in parallel projection, what depth does
    // over the scene's.
    vec4 whole = is_perspective ? vec4(frame.eye_ws.xyz, 1.0)
                                : vec4(-frame.forward_ws.xyz * length(frame.box_size_ws.xyz), 0.0);
    gl_Position = frame.clip_from_world * at;
    // Moved as a point of the world would be: what is infinitely far stays.
    gl_Position.z -= AWAY * at.w * (frame.clip_from_world * whole).z;
}
