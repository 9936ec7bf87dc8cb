// What the parts of path_traced's shader share: its numbers, its buffers, its ray.
#ifndef PATH_TRACED_PATH_GLSL
#define PATH_TRACED_PATH_GLSL

#include "frame.glsl"
#include "bvh.glsl"
#include "loops.glsl"
#include "resident_traced.glsl"
#include "shading/light_sphere.glsl"
#include "shading/medium.glsl"
#include "shading/scatter.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;
// BRDF_.
layout(constant_id = 2) const uint BRDF_KIND = 2;
// BRDF_LAMBERT or BRDF_GGX: how virtual point lights are scattered.
layout(constant_id = 118) const uint VPL_BRDF = 0;
// Surfaces that scatter a path at most.
layout(constant_id = 5) const uint BOUNCES = 1;
// 1: paths end by chance where they carry little.
layout(constant_id = 6) const uint ROULETTE = 0;
// 0: lights cast no shadows.
layout(constant_id = 7) const uint LIGHT_VISIBILITY = 1;
// 1: light between surfaces is that of virtual point lights, without shadows.
layout(constant_id = 8) const uint IS_WALKED = 0;
// Surfaces that a light walk lands on at most.
layout(constant_id = 9) const uint WALK_LANDINGS = 0;
// MEDIUM_ (airlight.glsl).
layout(constant_id = 10) const uint MEDIUM = 0;
// 1: rays leave all over a lens, or from beside the camera.
layout(constant_id = 11) const uint HAS_LENS = 0;
// AMBIENT_.
layout(constant_id = 12) const uint AMBIENT_VISIBILITY = 1;
// 0: what comes straight to the surface that is seen is not counted.
layout(constant_id = 13) const uint DIRECT_LIGHT = 1;
// 1: what the medium scatters is light of lights on the ray that is seen.
layout(constant_id = 14) const uint AIRLIGHT_SEEN = 0;
// 1: some of the lights are spheres.
layout(constant_id = 15) const uint HAS_SPHERES = 0;

// Ambient light is added to the surface that is seen, and nothing else comes from around the scene.
const uint AMBIENT_ADDED = 0u;
// Rays that leave the scene find it, and the background.
const uint AMBIENT_FOUND = 1u;
// Those that were scattered once find it alone.
const uint AMBIENT_FOUND_ONCE = 2u;

struct SampleParams {
    // The scene's sphere: what a sun's walk starts over.
    vec4 sphere_ws;
    MediumBlock medium;
    // Radius of the lens, and distance from it to the plane in focus, in metres.
    float lens_radius;
    float focus;
    // How far to the camera's right its middle is, metres.
    float lens_aside;
    // With TEXTURE_CONE: width of a pixel at the eye, metres, and by how much it grows a metre.
    float cone_width;
    float cone_spread;
    // Square of --vpl-clamp, in square metres.
    float least_squared;
    // How likely a light walk starts on a punctual light and not on an emitter.
    float punctual_part;
    // Entries of sources[]: emitters first, punctual lights after them.
    uint emitter_count;
    uint punctual_count;
    uint seed;
    // Steps of a ray for each voxel of the volume that it passes.
    float volume_steps;
};

// Something that light starts on, in a list sorted by the sum of chances.
struct SourceBlock {
    // A triangle of the tree, or a light of the list.
    uint index;
    float chance;
    // Sum over this one and all before it in its list.
    float cumulative;
    uint _unused;
};

layout(push_constant) uniform Push { SampleParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 1) readonly buffer Lights { LightBlock lights[]; };
#ifdef RAYS_QUERY
layout(set = 0, binding = 18) uniform accelerationStructureEXT structure;
#else
layout(std430, set = 0, binding = 2) readonly buffer BvhNodes { BVH_NODE bvh_nodes[]; };
#endif
layout(std430, set = 0, binding = 3) readonly buffer BvhTriangles { BvhTriangleBlock bvh_triangles[]; };
layout(std430, set = 0, binding = 4) readonly buffer TracedTriangles { TracedTriangleBlock surfaces[]; };
layout(std430, set = 0, binding = 5) readonly buffer TracedTangents { TracedTangentsBlock tangents[]; };
layout(std430, set = 0, binding = 6) readonly buffer TracedExtended { TracedExtendedBlock extended[]; };
layout(std430, set = 0, binding = 7) readonly buffer TracedMaterials { TracedMaterialBlock traced_materials[]; };
layout(std430, set = 0, binding = 8) readonly buffer Texels0 { uint texels_0[]; };
layout(std430, set = 0, binding = 9) readonly buffer Texels1 { uint texels_1[]; };
layout(std430, set = 0, binding = 10) readonly buffer Texels2 { uint texels_2[]; };
layout(std430, set = 0, binding = 11) readonly buffer Texels3 { uint texels_3[]; };
layout(std430, set = 0, binding = 12) readonly buffer Sources { SourceBlock sources[]; };
layout(std430, set = 0, binding = 13) buffer Sums { vec4 sums[]; };
layout(std430, set = 0, binding = 15) readonly buffer BvhClosing { BvhTriangleBlock bvh_closing[]; };
layout(std430, set = 0, binding = 16) readonly buffer TracedClosing { TracedClosingBlock closings[]; };
layout(std430, set = 0, binding = 17) readonly buffer FrameClosing { FrameBlock frame_closing; };
layout(set = 0, binding = 14, rgba32f) writeonly uniform image2D color;

#include "shading/traced.glsl"
#include "bvh_trace.glsl"

// The numbers of this pixel's sample, a pair at a time.
uint numbers_seed;
uint numbers_pair;

vec2 next_pair() {
    numbers_pair++;
    return sobol_pair(frame.sample_index, pair_seed(numbers_seed, numbers_pair));
}

// Seed of a ray's decisions about BLEND surfaces, which have no pairs of their own: how many a ray meets is not known.
uint next_seed() {
    numbers_pair++;
    return mixed(pair_seed(numbers_seed, numbers_pair) ^ mixed(frame.sample_index));
}

// Off a surface, on the side of its plane that `plane_ws` points to.
vec3 off_surface(SurfacePoint point) {
    return point.position_ws + point.plane_ws * RAY_OFFSET;
}

// A light of the list; those of the moment when the shutter closes lie behind those of the moment when it opens.
LightBlock light_at(uint index) {
    LightBlock light = lights[index];
    if (MOVES != 0u) {
        LightBlock closing = lights[frame.light_count + index];
        light.position_ws = mix(light.position_ws, closing.position_ws, shutter_part);
        light.direction_ws.xyz = normalize(mix(light.direction_ws.xyz, closing.direction_ws.xyz, shutter_part));
    }
    return light;
}

// Numbers for a point of a light, where there are lights of which one is drawn.
vec2 next_on_sphere() {
    return HAS_SPHERES != 0u ? next_pair() : vec2(0.0);
}

Incident incident_at(LightBlock light, vec3 position_ws, vec2 on_sphere) {
    return HAS_SPHERES != 0u ? incident_from_sphere(light, position_ws, on_sphere) : incident_from(light, position_ws);
}

// The first of `count` sources from `first` on whose sum of chances is beyond `number`.
SourceBlock source_of(uint first, uint count, float number) {
    uint low = first;
    uint high = first + count - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (sources[middle].cumulative > number) {
            high = middle;
        } else {
            low = middle + 1u;
        }
    }
    expect_done(low >= high);
    return sources[low];
}

// Uniform over a triangle.
vec2 barycentric_of(vec2 numbers) {
    float root = sqrt(numbers.x);
    return vec2(root * (1.0 - numbers.y), root * numbers.y);
}

#endif
