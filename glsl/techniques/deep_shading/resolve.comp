// The mean of each pixel's samples of one eye: their colours are gathered through the address buffer, by following links, or from the
// samples' own places (section 3.2; appendix A, pass 4); of a baseline from the layers that it drew them into.
// Pass: src/techniques/deep_shading/resolve.rs.
// variants: FETCH=own|address|direct|linked|compact|pointer|layers|passes|multisampled
#version 460
#include "frame.glsl"
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "techniques/deep_shading/space.glsl"
#include "techniques/deep_shading/counters.glsl"

// As in shade.frag.
layout(constant_id = 94) const uint IS_COUNTED = 0;

layout(local_size_x = 64) in;

struct ResolveParams {
    // Whose samples: 0 the left one or the only one, 1 the right one.
    uint eye;
};

layout(push_constant) uniform Push { ResolveParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 2) readonly buffer Deep { DeepBlock deep; };
layout(std430, set = 0, binding = 26) buffer Counters { uint counters[]; };
layout(set = 0, binding = 29, rgba32f) writeonly uniform image2D color;

#include "techniques/deep_shading/fetch.glsl"

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= frame.width_px || pixel.y >= frame.height_px) {
        return;
    }
    uvec2 table = uvec2(deep.table_width_px, deep.table_height_px);
    uvec2 cell = pixel % table;
    uint first = params.eye * eye_tuples(deep) + (cell.y * table.x + cell.x) * deep.sample_count;
    precise vec3 sum = vec3(0.0);
    uint missing = 0u;
    uint seen = 0u;
    for (uint index = 0u; index < deep.sample_count; index++) {
        vec4 fetched = sample_at(pixel, first, index);
        if (fetched.a < 0.0) {
            sum += frame.background.rgb;
            continue;
        }
        seen++;
        missing += fetched.a == 0.0 ? 1u : 0u;
        sum += fetched.rgb;
    }
    imageStore(color, ivec2(pixel), vec4(sum / float(deep.sample_count), 1.0));
    if (IS_COUNTED != 0u && (missing > 0u || seen > 0u)) {
        atomicAdd(counters[COUNTED_MISSING], missing);
        atomicAdd(counters[COUNTED_SAMPLES], seen);
    }
}
