// A fragment program that moves texels as a look-up texture says: the split as the paper ran it (Segovia 2006, sections
// 3.2 and 4.2). The shader does not know the mapping. Pass: src/techniques/interleaved_deferred/split/fragment.rs.
//   SOURCE=frame   from the un-split G-buffer: in one pass, or the first of two
//   SOURCE=blocks  from the block layout: the second of two
// variants: POSITION=half|unorm16|depth|float SOURCE=frame|blocks COLOR=off|on
#version 460
#ifdef SOURCE_FRAME
#include "passes/gbuffer_read.glsl"
#ifdef COLOR_ON
#include "techniques/interleaved_deferred/material_of_frame.glsl"
#endif
#else
#include "passes/gbuffer.glsl"
#define STORAGE_IMAGE
#define READS_SURFACE
#include "techniques/interleaved_deferred/sub_buffers.glsl"
#endif

layout(set = 0, binding = 0) uniform usampler2D lookup;

layout(location = 0) out POSITION_WORDS out_position;
layout(location = 1) out uvec2 out_normal;
#ifdef COLOR_ON
layout(location = 2) out uvec2 out_color;
#endif

// What a look-up texture says of padding, which comes from no pixel: it holds no surface.
const uint NOWHERE = 0xffffu;

void main() {
    uvec2 from = texelFetch(lookup, ivec2(gl_FragCoord.xy), 0).rg;
    if (from.x == NOWHERE) {
        out_position = POSITION_WORDS(0u);
        out_normal = uvec2(0u);
#ifdef COLOR_ON
        out_color = uvec2(0u);
#endif
        return;
    }
#ifdef SOURCE_FRAME
    out_position = position_words(from);
    out_normal = normal_words(from);
#ifdef COLOR_ON
    out_color = color_words(from);
#endif
#else
    out_position = load_position(ivec2(from));
    out_normal = load_normal(ivec2(from));
#ifdef COLOR_ON
    out_color = load_color(ivec2(from));
#endif
#endif
}
