// A material's entries, each shaded and stored where it waited; a thread takes several, so that it reads each light once for all of
// them. Pass: src/techniques/deep_shading/entries/shade.rs.
// variants: VERTEX=plain|extended SHADOWS=traced|mapped
#version 460
#define DRAW_OF_TRIANGLE
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "techniques/deep_shading/entries/entry.glsl"
#include "shading/light_box.glsl"
#include "shading/lit_points.glsl"

layout(std430, set = 0, binding = 22) buffer Colors { uvec2 colors[]; };
layout(std430, set = 0, binding = 26) buffer Counters { uint counters[]; };

READS_PAIRS(waiting_at, colors)
WRITES_PAIRS(set_color, colors)

// 1: lights are left out whose range ends before all that a thread shades.
layout(constant_id = 105) const uint CULLS_LIGHTS = 0;

// By a thread's entries: where each waits; NO_PLACE: it has fewer.
uint point_place[TEXELS];
// Around all that light changes.
Box point_box = NO_BOX;

void set_point(uint i) {
    stand_on_entry(waiting_at(point_place[i]));
    vec3 base_color = base_color_at(params.material).rgb;
    point_is_shaded[i] = !is_unlit();
    Lit dark = dark_at(params.material, base_color);
    point_surface[i] = dark.surface;
    point_position_ws[i] = in_position_ws;
    point_normal_ws[i] = dark.normal_ws;
    point_eye_ws[i] = to_eye(frame, in_position_ws);
    point_radiance[i] = point_is_shaded[i] ? dark.radiance : base_color;
    if (point_is_shaded[i]) {
        include_point(point_box, in_position_ws);
    }
}

// A thread's evaluations of lights.
void count_evaluations(uint evaluated) {
    uint before = atomicAdd(counters[COUNTED_EVALUATIONS], evaluated);
    if (before + evaluated < before) {
        atomicAdd(counters[COUNTED_EVALUATIONS_CARRIED], 1u);
    }
}

void main() {
    uint point_count = 0u;
    uint lit_count = 0u;
    uint light_count = 0u;
    for (uint i = 0u; i < TEXELS; i++) {
        point_place[i] = own_place(i);
        point_is_shaded[i] = false;
        if (point_place[i] != NO_PLACE) {
            set_point(i);
            point_count++;
            lit_count += uint(point_is_shaded[i]);
        }
    }
    if (point_count == 0u) {
        return;
    }
    uint light = 0u;
    for (; light < frame.light_count; light++) {
        // A loop, and no branch: software drivers run a branch that no lane takes.
        for (bool reaches = CULLS_LIGHTS == 0u || is_touched(point_box, lights[light]); reaches; reaches = false) {
            add_light(lights[light]);
            light_count++;
        }
    }
    expect_done(light == frame.light_count);
    for (uint i = 0u; i < TEXELS; i++) {
        if (point_place[i] != NO_PLACE) {
            set_color(point_place[i], stored_color(nan_if_cut(point_radiance[i])));
        }
    }
    if (IS_COUNTED != 0u) {
        atomicAdd(counters[COUNTED_SHADED], point_count);
        count_evaluations(lit_count * light_count);
    }
}
