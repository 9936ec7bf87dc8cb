// Where a sample lies in its pixel, on the lens and in time: where its tuple does, or, where pixels have samples of their own
// (`--pixel-samples own`), there with its binary digits turned by a hash of the pixel. Turned alike, those of a pixel stay as
// evenly spread as they were, and no two pixels have the same. The host's twin: tuples.rs.
//
// After space.glsl; the including shader declares `deep`.
#ifndef DEEP_SHADING_OWN_SAMPLES_GLSL
#define DEEP_SHADING_OWN_SAMPLES_GLSL

#include "sampling/sobol.glsl"

layout(constant_id = 107) const uint HAS_OWN_SAMPLES = 0;

// By what the digits of all of a pixel's samples are turned.
struct Turns {
    uvec2 place;
    uvec2 lens;
    uint time;
};

// Devices need not know sines of angles beyond half a turn well: a place on the lens is turned from the side opposite.
const float HALF_TURN = 3.14159265;

// `pixel`: of the frame.
Turns turns_of(uvec2 pixel) {
    uint seed = pixel_seed(pixel, 0u);
    return Turns(uvec2(pair_seed(seed, 0u), pair_seed(seed, 1u)), uvec2(pair_seed(seed, 2u), pair_seed(seed, 3u)),
        pair_seed(seed, 4u));
}

// A number of 0 to 1 without 1, in steps of 2^-24.
float turned(float number, uint turn) {
    return unit_of((uint(number * 16777216.0) << 8) ^ turn);
}

vec2 turned(vec2 numbers, uvec2 turns) {
    return vec2(turned(numbers.x, turns.x), turned(numbers.y, turns.y));
}

// What a sample of a tuple has in a pixel with these turns.
TupleBlock turned_tuple(TupleBlock tuple, Turns turns) {
    if (HAS_OWN_SAMPLES != 0u) {
        vec2 place = turned(tuple.place_px, turns.place);
        vec2 table_px = vec2(deep.table_width_px, deep.table_height_px);
        vec2 layer_px = vec2(deep.layer_width_px, deep.layer_height_px);
        precise vec2 shift = tuple.shift - 2.0 * (place - tuple.place_px) / (table_px * layer_px);
        tuple.shift = shift;
        tuple.place_px = place;
        if (HAS_LENS != 0u) {
            tuple.lens_unit = turned(tuple.lens_unit, turns.lens);
            float angle = (tuple.lens_unit.y - 0.5) * (2.0 * HALF_TURN);
            precise vec2 on_disk = -sqrt(tuple.lens_unit.x) * vec2(cos(angle), sin(angle));
            precise vec2 lens = vec2(tuple.eye, 0.0) + (1.0 - abs(tuple.eye)) * on_disk;
            tuple.lens = lens;
        }
        if (IS_MOVING != 0u) {
            tuple.time = turned(tuple.time, turns.time);
        }
    }
    return tuple;
}

// The pixel of the frame of a sample: `at` as sample_index has it, pixel of a layer and the layer.
uvec2 pixel_of_sample(uvec3 at) {
    uint cell = at.z % eye_tuples(deep) / deep.sample_count;
    uvec2 table = uvec2(deep.table_width_px, deep.table_height_px);
    return at.xy * table + uvec2(cell % table.x, cell / table.x);
}

TupleBlock turned_tuple(TupleBlock tuple, uvec3 at) {
    return turned_tuple(tuple, turns_of(pixel_of_sample(at)));
}

#endif
