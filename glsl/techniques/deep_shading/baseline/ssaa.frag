// Supersampling: what a tuple draws is shaded there, sample by sample (section 6, "SSAA").
// Pass: src/techniques/deep_shading/baseline/ssaa.rs.
// variants: ALPHA=opaque|tested VERTEX=plain|extended SHADOWS=traced|mapped VISIBILITY=interleaved|stochastic COUNT=off|on
#version 460
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/surface.glsl"
#include "techniques/deep_shading/counting.glsl"

#include "techniques/deep_shading/baseline/sample_place.glsl"

layout(location = 0) out vec4 out_color;

void main() {
    Place place;
    if (!is_placed(place)) {
        // Nothing more is run of it where the driver only turns it into a helper.
        discard;
        return;
    }
    stand_at(in_primitive, place);
    vec4 base_color = base_color_at(params.material);
#ifdef ALPHA_TESTED
    require_seen(base_color.a);
#endif
    out_color = attached_color(color_of_base(base_color));
    count(COUNTED_SHADED);
}
