// Textures for shaders that choose one by material: their finest levels, or with TEXTURE_CONE all, as words of RGBA8, one
// level and one picture after the other, in storage buffers, because a driver need not index sampled images (lavapipe of
// Mesa 22 does not). Twin of the finest level: src/shading/material.rs.
//
// The including shader declares texels_0[] to texels_3[].
#ifndef SHADING_TEXEL_GLSL
#define SHADING_TEXEL_GLSL

#include "resident_traced.glsl"
#include "shading/slanted.glsl"

int wrapped(uint wrap, int at, int size) {
    if (wrap == WRAP_CLAMP) {
        return clamp(at, 0, size - 1);
    }
    int period = wrap == WRAP_MIRRORED ? 2 * size : size;
    int inside = at - period * int(floor(float(at) / float(period)));
    // A quotient may be less than the whole number that it is, and far out a float is off: by one period, or by more.
    inside += inside < 0 ? period : inside >= period ? -period : 0;
    inside = clamp(inside, 0, period - 1);
    return inside >= size ? period - 1 - inside : inside;
}

vec4 texel_at(TexelsBlock texels, int x, int y) {
    uint at = texels.first + uint(y) * texels.width_px + uint(x);
    uint buffer_index = texels.flags & 3u;
    uint word = 0u;
    if (buffer_index == 0u) {
        word = texels_0[at];
    } else if (TEXEL_BUFFERS != 1u) {
        if (buffer_index == 1u) {
            word = texels_1[at];
        } else if (buffer_index == 2u) {
            word = texels_2[at];
        } else {
            word = texels_3[at];
        }
    }
    vec4 value = unpackUnorm4x8(word);
    if ((texels.flags & TEXELS_SRGB) != 0u) {
        vec3 curve = pow((value.rgb + 0.055) / 1.055, vec3(2.4));
        value.rgb = mix(curve, value.rgb / 12.92, lessThanEqual(value.rgb, vec3(0.04045)));
    }
    return value;
}

// `place`: on the picture, whose sides are 1. Bilinear or nearest.
vec4 filtered(TexelsBlock texels, vec2 place, bool is_nearest) {
    vec2 at = place * vec2(texels.width_px, texels.height_px);
    at -= is_nearest ? 0.0 : 0.5;
    // Integers end at 2^31: a coordinate that is farther out is nowhere in particular.
    at = clamp(at, vec2(-1e9), vec2(1e9));
    vec2 low = floor(at);
    vec2 fraction = is_nearest ? vec2(0.0) : at - low;
    uint wrap_u = (texels.flags >> TEXELS_WRAP_U_SHIFT) & 3u;
    uint wrap_v = (texels.flags >> TEXELS_WRAP_V_SHIFT) & 3u;
    int x0 = wrapped(wrap_u, int(low.x), int(texels.width_px));
    int x1 = wrapped(wrap_u, int(low.x) + 1, int(texels.width_px));
    int y0 = wrapped(wrap_v, int(low.y), int(texels.height_px));
    int y1 = wrapped(wrap_v, int(low.y) + 1, int(texels.height_px));
    vec4 upper = mix(texel_at(texels, x0, y0), texel_at(texels, x1, y0), fraction.x);
    vec4 lower = mix(texel_at(texels, x0, y1), texel_at(texels, x1, y1), fraction.x);
    return mix(upper, lower, fraction.y);
}

// A coarser level, 0 the finest.
TexelsBlock level_of(TexelsBlock texels, int level) {
    for (int finer = 0; finer < level; finer++) {
        texels.first += texels.width_px * texels.height_px;
        texels.width_px = max(texels.width_px >> 1, 1u);
        texels.height_px = max(texels.height_px >> 1, 1u);
    }
    return texels;
}

// Where a ray's cone meets a surface, in units of both UV sets: xy of the first, zw of the second.
struct Footprint {
    // How long it is there, by the UV set's mean scale; of TEXTURE_CONE 1.
    vec2 widths;
    // Two diameters of the ellipse that the plane cuts out of it, at a right angle on the surface; of TEXTURE_CONE above 1.
    vec4 along;
    vec4 across;
};

// The finest level, whatever ray comes.
const Footprint FINEST = Footprint(vec2(0.0), vec4(0.0), vec4(0.0));

// The level of which a texel is so wide. `width_px`: in texels of the finest.
float level_at(TexelsBlock texels, float width_px) {
    float last = float(findMSB(max(texels.width_px, texels.height_px)));
    float level = clamp(log2(max(width_px, 1e-30)), 0.0, last);
    // As Vulkan rounds.
    return (texels.flags & TEXELS_BETWEEN_LEVELS) != 0u ? level : max(ceil(level - 0.5), 0.0);
}

// `filtered` stands in as few places as can be: drivers copy it to each, for each texture, before they know which are not run.
vec4 filtered_at(TexelsBlock texels, vec2 place, float level) {
    bool is_coarser = TEXTURE_CONE != 0u && level > 0.0;
    bool is_nearest = (texels.flags & (is_coarser ? TEXELS_NEAREST_SMALL : TEXELS_NEAREST)) != 0u;
    TexelsBlock finer = texels;
    float between = 0.0;
    if (is_coarser) {
        finer = level_of(texels, int(level));
        between = fract(level);
    }
    vec4 value = filtered(finer, place, is_nearest);
    return between > 0.0 ? mix(value, filtered(level_of(finer, 1), place, is_nearest), between) : value;
}

// What a step of the texture's UV set is on its picture, whose sides are 1.
vec2 step_of(TexelsBlock texels, vec4 in_both_sets) {
    vec2 in_set = texels.u.w > 0.5 ? in_both_sets.zw : in_both_sets.xy;
    return vec2(dot(texels.u.xy, in_set), dot(texels.v.xy, in_set));
}

// `uvs`: the two UV sets of the point. Bilinear, or nearest where the sampler says so.
vec4 texel_of(TexelsBlock texels, vec4 uvs, Footprint footprint) {
    if (texels.width_px == 0u) {
        return vec4(1.0);
    }
    bool is_second = texels.u.w > 0.5;
    vec2 uv = is_second ? uvs.zw : uvs.xy;
    vec2 place = vec2(dot(texels.u.xy, uv) + texels.u.z, dot(texels.v.xy, uv) + texels.v.z);
    float level = 0.0;
    Readings readings = ONE_READING;
    if (TEXTURE_CONE != 0u && (texels.flags & TEXELS_LEVELS) != 0u) {
        vec2 size_px = vec2(texels.width_px, texels.height_px);
        if (TEXTURE_CONE != 1u) {
            readings = readings_of(step_of(texels, footprint.along), step_of(texels, footprint.across), size_px, TEXTURE_CONE);
        } else {
            float turned = abs(texels.u.x * texels.v.y - texels.u.y * texels.v.x);
            readings.width_px = (is_second ? footprint.widths.y : footprint.widths.x) * sqrt(turned * size_px.x * size_px.y);
        }
        level = level_at(texels, readings.width_px);
    }
    vec4 sum = vec4(0.0);
    for (float index = 0.0; index < readings.count; index++) {
        sum += filtered_at(texels, place + place_of(readings, index), level);
    }
    return sum / readings.count;
}

#endif
