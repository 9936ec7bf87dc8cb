// The closed surface around what a light reaches, for the stencil: an icosahedron that holds the light's sphere.
// Kircher 2009, section 2.2 (depth-fail volumes). Pass: src/techniques/inferred_lighting/light/volumes.rs.
#version 460
#include "frame.glsl"
#include "shading/light.glsl"
#include "techniques/inferred_lighting/light/volumes.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 1) readonly buffer Lights { LightBlock lights[]; };

// The golden ratio: corners are the cyclic permutations of (0, 1, GOLDEN) with all signs.
const float GOLDEN = 1.6180339887;
// Distance from the middle to a face of that icosahedron; a hair less, so that rounding leaves the sphere inside.
const float INRADIUS = 1.5115226281 * 0.999;

const vec3 CORNERS[12] = vec3[](
    vec3(0.0, 1.0, GOLDEN), vec3(0.0, -1.0, GOLDEN), vec3(0.0, 1.0, -GOLDEN), vec3(0.0, -1.0, -GOLDEN),
    vec3(1.0, GOLDEN, 0.0), vec3(-1.0, GOLDEN, 0.0), vec3(1.0, -GOLDEN, 0.0), vec3(-1.0, -GOLDEN, 0.0),
    vec3(GOLDEN, 0.0, 1.0), vec3(GOLDEN, 0.0, -1.0), vec3(-GOLDEN, 0.0, 1.0), vec3(-GOLDEN, 0.0, -1.0));

// Counter-clockwise from outside.
const uint FACES[60] = uint[](
    0u, 1u, 8u, 0u, 10u, 1u, 0u, 4u, 5u, 0u, 8u, 4u, 0u, 5u, 10u,
    1u, 7u, 6u, 1u, 6u, 8u, 1u, 10u, 7u, 2u, 9u, 3u, 2u, 3u, 11u,
    2u, 5u, 4u, 2u, 4u, 9u, 2u, 11u, 5u, 3u, 6u, 7u, 3u, 9u, 6u,
    3u, 7u, 11u, 4u, 8u, 9u, 5u, 11u, 10u, 6u, 9u, 8u, 7u, 10u, 11u);

void main() {
    LightBlock light = lights[params.light];
    vec3 corner = CORNERS[FACES[gl_VertexIndex]] / INRADIUS;
    gl_Position = frame.clip_from_world * vec4(light.position_ws.xyz + corner * light.intensity.w, 1.0);
}
