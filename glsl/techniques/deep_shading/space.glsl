// Shading space and the tuples that visibility is sampled at (Clarberg & Munkberg 2014, sections 3 and 4.2). Written by
// src/techniques/deep_shading/space.rs and tuples.rs.
#ifndef DEEP_SHADING_SPACE_GLSL
#define DEEP_SHADING_SPACE_GLSL

// 1: the scene is another one when the shutter closes.
layout(constant_id = 90) const uint IS_MOVING = 0;
// 1: the lens is open.
layout(constant_id = 91) const uint HAS_LENS = 0;

struct DeepBlock {
    // When the shutter opens, and closes.
    mat4 open_clip_from_world;
    mat4 close_clip_from_world;
    // How many metres before the eye a point lies: its product with xyz, plus w.
    vec4 open_depth;
    vec4 close_depth;
    // By how much clip space's x and y move a metre beside the eye's plane when the eye moves by the lens's radius; of two eyes
    // by that of a disk that has both lenses in it.
    vec2 lens;
    // One through the distance of the plane in focus, 1/m.
    float inverse_focus;
    // Pixels of shading space around the frame's.
    float guard_px;
    // Pixels of shading space that the frame's width and height are.
    vec2 scaled_px;
    uint shading_width_px;
    uint shading_height_px;
    // Size of a layer, which holds a tuple's samples.
    uint layer_width_px;
    uint layer_height_px;
    // Pixels over which the table of tuples is spread.
    uint table_width_px;
    uint table_height_px;
    // Samples a pixel of one eye, and all tuples: of two eyes the left one's and then as many of the right one.
    uint sample_count;
    uint tuple_count;
    // 0, which no compiler knows.
    uint opaque_zero;
    // How much coarser shading space is towards its rim (warp.glsl); 0: nowhere.
    float warp_falloff;
};

// One place in a pixel, on the lens and in time: (x, y, u, v, t) of the paper's appendix.
struct TupleBlock {
    // From the frame's clip space to a layer's: factors of x and y, and parts of w.
    vec2 scale;
    vec2 shift;
    // On the unit disk.
    vec2 lens;
    // 0: the shutter opens; 1: it closes.
    float time;
    // Where on the disk the middle of the eye's lens is, on the first axis; that lens touches the disk's rim. 0: it is the disk.
    float eye;
    // In its pixel, each of 0 to 1: what `shift` is of.
    vec2 place_px;
    // The two numbers of 0 to 1 that the place on the lens is of: its radius squared, and its turn.
    vec2 lens_unit;
};

// The middle of the lens when the shutter opens, for what is not of a layer.
TupleBlock whole_frame_tuple() {
    return TupleBlock(vec2(1.0), vec2(0.0), vec2(0.0), 0.0, 0.0, vec2(0.5), vec2(0.0));
}

// Where no surface is.
const uint NO_PRIMITIVE = 0xffffffffu;
// In place of a shading pixel: the sample has none.
const uint NO_SHADING_PIXEL = 0xffffffffu;

// In place of an address: the sample sees nothing.
const uint NO_ADDRESS = 0xffffffffu;

#include "techniques/deep_shading/warp.glsl"

// Homogeneous pixels of even shading space, as fine everywhere as in its middle: xy through w is a place in it.
vec2 shading_from_clip(DeepBlock deep, vec4 clip) {
    precise vec2 at = 0.5 * clip.xy * deep.scaled_px + clip.w * (0.5 * deep.scaled_px + deep.guard_px);
    return at;
}

// The pixel of a place, 16 bits a side, or NO_SHADING_PIXEL. `canonical`: xy homogeneous even pixels, zw depth and w.
uint shading_pixel(DeepBlock deep, vec4 canonical) {
    vec2 at = warped(deep, canonical.xy / canonical.w);
    vec2 extent = vec2(deep.shading_width_px, deep.shading_height_px);
    // Behind the eye, before the near plane or outside: shading space has no place for it.
    bool has_place = canonical.w > 0.0 && canonical.z <= canonical.w && all(greaterThanEqual(at, vec2(0.0))) &&
                     all(lessThan(at, extent));
    uvec2 pixel = uvec2(at);
    return has_place ? pixel.x | pixel.y << 16 : NO_SHADING_PIXEL;
}

// Its depth, reversed, as bits: those of floats without sign compare as the floats do.
uint shading_depth(vec4 canonical) {
    return floatBitsToUint(clamp(canonical.z / canonical.w, 0.0, 1.0));
}

// Bits of the depth that zmax begins at: the near plane, behind which lies all that may be seen.
const uint NEAREST_DEPTH = 0x3f800000u;

// Tuples of one eye.
uint eye_tuples(DeepBlock deep) {
    return deep.table_width_px * deep.table_height_px * deep.sample_count;
}

// Number of a tuple among those of all runs; both eyes have the same numbers.
uint tuple_number(DeepBlock deep, uint run, uint tuple) {
    return run * eye_tuples(deep) + tuple % eye_tuples(deep);
}

// Entries of the buffers that have one a sample.
uint sample_total(DeepBlock deep) {
    return deep.tuple_count * deep.layer_width_px * deep.layer_height_px;
}

// Index of a sample in those buffers: layer by layer, row by row.
uint sample_index(DeepBlock deep, uvec3 at) {
    return (at.z * deep.layer_height_px + at.y) * deep.layer_width_px + at.x;
}

// Where the sample of an index is: pixel of a layer, and the layer.
uvec3 sample_place(DeepBlock deep, uint index) {
    uint row = index / deep.layer_width_px;
    return uvec3(index % deep.layer_width_px, row % deep.layer_height_px, row / deep.layer_height_px);
}

#endif
