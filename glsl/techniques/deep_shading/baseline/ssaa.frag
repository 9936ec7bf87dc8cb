// Supersampling: what a tuple draws is shaded there, sample by sample (section 6, "SSAA").
// Pass: src/techniques/deep_shading/baseline/ssaa.rs.
// variants: ALPHA=opaque|tested VERTEX=plain|extended SHADOWS=traced|mapped VISIBILITY=interleaved|stochastic
#version 460
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/surface.glsl"
#include "techniques/deep_shading/counters.glsl"

// As in shade.frag.
layout(constant_id = 94) const uint IS_COUNTED = 0;

layout(location = 1) flat in uint in_primitive;
layout(std430, set = 0, binding = 26) buffer Counters { uint counters[]; };
#ifdef VISIBILITY_STOCHASTIC
layout(location = 2) flat in vec4 in_corners[3];

#include "techniques/deep_shading/visibility/covers.glsl"
#include "techniques/deep_shading/visibility/hit.glsl"
#else
layout(location = 2) in vec3 in_weights;
#ifdef ALPHA_OPAQUE
// What writes into buffers, as counting does, is else tested after it has run.
layout(early_fragment_tests) in;
#endif
#endif
#ifdef ALPHA_TESTED
// surface.glsl calls the middle of the exposure `frame`.
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock run; };

#include "techniques/deep_shading/alpha.glsl"
#endif

layout(location = 0) out vec4 out_color;

void main() {
    Place place;
#ifdef VISIBILITY_STOCHASTIC
    if (!is_hit(in_corners, gl_FragCoord.xy, place)) {
        discard;
    }
    gl_FragDepth = hit_depth(in_corners, place.weights);
#else
    place.weights = inside_weights(in_weights);
    place.right = dFdx(in_weights);
    place.down = dFdy(in_weights);
    place.is_front = gl_FrontFacing != ((params.flags & DRAWN_MIRRORED) != 0u);
#endif
    // A layer's pixels are a table apart.
    place.right /= float(deep.table_width_px);
    place.down /= float(deep.table_height_px);
    stand_at(in_primitive, place);
    vec4 base_color = base_color_at(params.material);
#ifdef ALPHA_TESTED
    if (!is_seen(base_color.a, uvec2(gl_FragCoord.xy), tuple_number(deep, run.sample_index, params.tuple))) {
        discard;
    }
#endif
    out_color = attached_color(color_of_base(base_color));
    if (IS_COUNTED != 0u) {
        atomicAdd(counters[COUNTED_SHADED], 1u);
    }
}
