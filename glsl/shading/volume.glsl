// A scalar field on a grid as light: a transfer function says what it emits and how much it stops. Keller and Heidrich
// 2001, section 3.3. Filled by src/resident/volume.rs.
//
// Voxels are words, and the eight around a place are weighed here: samplers weigh by 256ths on many devices, which shows as
// bands under a steep transfer function.
#ifndef SHADING_VOLUME_GLSL
#define SHADING_VOLUME_GLSL

struct VolumeBlock {
    // From the box of the voxels' middles, 0 to 1 along each side, to the world, and from the world to voxels: 0 is the
    // middle of the first.
    mat4 world_from_box;
    mat4 voxels_from_world;
    // xyz: the middle of the last voxel.
    vec4 last;
    // A value less `lowest`, times `scale`, is an entry of the transfer table, counted in entries.
    float lowest;
    float scale;
    // Extinction of 1 in the table, as a part of the light that a metre stops.
    float extinction;
    uint last_entry;
    // Words are floats; else whole numbers.
    uint is_float;
    uint _unused[3];
};

layout(std430, set = 0, binding = 60) readonly buffer Volume { VolumeBlock volume; };
// xyz: radiance that an opaque piece emits; w: extinction.
layout(std430, set = 0, binding = 61) readonly buffer Transfer { vec4 transfer[]; };
layout(set = 0, binding = 62) uniform usampler3D voxels;

float voxel(ivec3 at) {
    uint word = texelFetch(voxels, at, 0).r;
    return volume.is_float != 0u ? uintBitsToFloat(word) : float(word);
}

// The value at a place in voxels, each of 0 to the last.
float field_at(vec3 place) {
    vec3 low = clamp(floor(place), vec3(0.0), volume.last.xyz - 1.0);
    vec3 part = clamp(place - low, 0.0, 1.0);
    ivec3 at = ivec3(low);
    vec4 left = vec4(
        voxel(at), voxel(at + ivec3(0, 1, 0)), voxel(at + ivec3(0, 0, 1)), voxel(at + ivec3(0, 1, 1)));
    vec4 right = vec4(
        voxel(at + ivec3(1, 0, 0)), voxel(at + ivec3(1, 1, 0)), voxel(at + ivec3(1, 0, 1)), voxel(at + ivec3(1, 1, 1)));
    vec4 along_x = mix(left, right, part.x);
    vec2 along_y = mix(along_x.xz, along_x.yw, part.y);
    return mix(along_y.x, along_y.y, part.z);
}

// rgb: radiance that an opaque piece of the field there emits; w: part of the light that a metre of it stops.
vec4 medium_at(vec3 place) {
    float entry = clamp((field_at(place) - volume.lowest) * volume.scale, 0.0, float(volume.last_entry));
    uint below = min(uint(entry), volume.last_entry - 1u);
    vec4 found = mix(transfer[below], transfer[below + 1u], entry - float(below));
    return vec4(found.rgb, found.w * volume.extinction);
}

// Part of the light that a length in metres of such a medium stops.
float opacity(float extinction, float length_m) {
    return 1.0 - exp(-extinction * length_m);
}

#endif
