// One direction of the fast Gaussian: half-texel fetches through a linear sampler, colour and flag at once. A pair of
// texels with any flag ends the walk. Segovia 2006, section 4.5 and figure 4b. Pass: src/passes/filter/gauss_fast.rs.
// variants: TARGET=image|buffer
#version 460
#include "passes/gbuffer.glsl"

struct GaussFastParams {
    uint width_px;
    uint height_px;
    uint row_pitch;
    // 1: along x, 0: along y.
    uint horizontal;
    uint radius;
    // -1 / (2 sigma^2), in 1/px^2.
    float falloff;
};

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

layout(push_constant) uniform Push { GaussFastParams params; };
layout(set = 0, binding = 0) uniform sampler2D source;
#ifdef TARGET_IMAGE
layout(set = 0, binding = 1, rg32ui) writeonly uniform uimage2D target;
#else
layout(std430, set = 0, binding = 1) writeonly buffer Target { uvec2 target[]; };
#endif

// Whether a walk in this direction stops, from the sum of two texels' flags (gauss_pack.comp). A fetch is off by the
// sampler's rounding, so 4 may come as 3.9999998, whose remainder would pass for a stop.
bool stops(float sum) {
    uint stops = uint(sum + 0.5);
    return params.horizontal != 0u ? (stops & 3u) != 0u : stops >= 4u;
}

float weight_at(uint tap) {
    return exp(float(tap * tap) * params.falloff);
}

// Blends the pairs of one side into `sum` (w: the weights) until a pair holds a discontinuity or the frame ends.
void walk(vec2 middle, vec2 direction, uint room, inout vec4 sum) {
    for (uint tap = 1u; tap <= min(params.radius, room); tap += 2u) {
        bool pair = tap < min(params.radius, room);
        float weight = weight_at(tap) + (pair ? weight_at(tap + 1u) : 0.0);
        vec2 at = middle + direction * (float(tap) + (pair ? 0.5 : 0.0));
        vec4 fetched = textureLod(source, at / vec2(params.width_px, params.height_px), 0.0);
        if (stops(fetched.a * 2.0)) {
            return;
        }
        sum += vec4(fetched.rgb, 1.0) * weight;
    }
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width_px || pixel.y >= params.height_px) {
        return;
    }
    vec2 middle = vec2(pixel) + 0.5;
    vec2 direction = params.horizontal != 0u ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
    uint before = params.horizontal != 0u ? pixel.x : pixel.y;
    uint after = params.horizontal != 0u ? params.width_px - 1u - pixel.x : params.height_px - 1u - pixel.y;
    vec4 own = texelFetch(source, ivec2(pixel), 0);
    vec4 sum = vec4(own.rgb, 1.0);
    if (!stops(own.a * 2.0)) {
        walk(middle, direction, after, sum);
    }
    walk(middle, -direction, before, sum);
    uvec2 words = pack_halves(sum.rgb / sum.w, packHalf2x16(vec2(own.a, 0.0)));
#ifdef TARGET_IMAGE
    imageStore(target, ivec2(pixel), uvec4(words, 0u, 0u));
#else
    target[pixel.y * params.row_pitch + pixel.x] = words;
#endif
}
