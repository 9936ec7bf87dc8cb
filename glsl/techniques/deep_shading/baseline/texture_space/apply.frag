// A draw's texture on it, where tuples see it (section 2). Pass: src/techniques/deep_shading/baseline/texture_space/apply.rs.
// variants: ALPHA=opaque|tested VERTEX=plain|extended VISIBILITY=interleaved|stochastic COUNT=off|on
#version 460
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/surface.glsl"
#include "techniques/deep_shading/counting.glsl"
#include "techniques/deep_shading/baseline/texture_space/atlas.glsl"

#include "techniques/deep_shading/baseline/sample_place.glsl"
#include "techniques/deep_shading/baseline/texture_space/lookup.glsl"

layout(location = 0) out vec4 out_color;

void main() {
    Place place;
    if (!is_placed(place)) {
        // Nothing more is run of it where the driver only turns it into a helper.
        discard;
        return;
    }
#ifdef ALPHA_TESTED
    stand_at(in_primitive, place);
    require_seen(base_color_at(params.material).a);
#endif
    out_color = attached_color(looked_up(in_primitive - params.primitive_offset, place.weights));
}
