// A triangle's hull in shading space: all that a pixel touches of it (section 4.4).
//
// The including shader has `deep` (DeepBlock).
#ifndef DEEP_SHADING_SHADE_HULL_GLSL
#define DEEP_SHADING_SHADE_HULL_GLSL

#include "techniques/deep_shading/hull.glsl"
#include "techniques/deep_shading/shade/depth.glsl"

// In even shading space, or in one sector of it that is warped. Corners as `hull_around` takes them.
Hull even_hull_of(vec4 a, vec4 b, vec4 c) {
    return hull_around(a, b, c, reach_px(), 2.0 * even_half_px(deep) + 1.0);
}

// The sector between the diagonals that a point before the eye lies in, from the middle of shading space on: where x is greater
// than y or not, and the sign of that one.
uvec2 sector_of(vec2 from_middle) {
    bool is_wide = abs(from_middle.x) > abs(from_middle.y);
    return uvec2(is_wide, (is_wide ? from_middle.x : from_middle.y) < 0.0);
}

// Places that lie in `least` to `greatest`, warped, lie in this box: towards the middle they move the more the farther out
// they are on the other axis.
Hull warped_box_of(vec2 least, vec2 greatest) {
    vec2 half_px = even_half_px(deep);
    vec2 low = (least - half_px) / half_px;
    vec2 high = (greatest - half_px) / half_px;
    vec2 nearest = max(vec2(0.0), max(low, -high));
    vec2 farthest = max(abs(low), abs(high));
    float falloff = deep.warp_falloff;
    vec2 low_other = vec2(low.x < 0.0 ? nearest.y : farthest.y, low.y < 0.0 ? nearest.x : farthest.x);
    vec2 high_other = vec2(high.x > 0.0 ? nearest.y : farthest.y, high.y > 0.0 ? nearest.x : farthest.x);
    vec2 from = low * (1.0 + falloff) / (1.0 + falloff * max(abs(low), low_other));
    vec2 to = high * (1.0 + falloff) / (1.0 + falloff * max(abs(high), high_other));
    vec2 warped_half_px = 0.5 * vec2(deep.shading_width_px, deep.shading_height_px);
    return box_of(warped_half_px * (1.0 + from) - reach_px(), warped_half_px * (1.0 + to) + reach_px());
}

// In shading space. Corners as above, in even shading space.
Hull hull_of(vec4 a, vec4 b, vec4 c) {
    if (deep.warp_falloff == 0.0) {
        return even_hull_of(a, b, c);
    }
    vec2 half_px = even_half_px(deep);
    vec2 warped_half_px = 0.5 * vec2(deep.shading_width_px, deep.shading_height_px);
    vec4 given[3] = vec4[3](a, b, c);
    bool has_sector = true;
    uvec2 sector = sector_of(a.xy / (a.w * half_px) - 1.0);
    for (uint index = 0u; index < 3u; index++) {
        vec4 corner = given[index];
        vec2 from_middle = corner.xy / half_px - corner.w;
        has_sector = has_sector && corner.w > 0.0 && sector_of(from_middle / corner.w) == sector;
        float far = sector.x == 1u ? abs(from_middle.x) : abs(from_middle.y);
        float w = (corner.w + deep.warp_falloff * far) / (1.0 + deep.warp_falloff);
        // What is before the near plane stays so.
        given[index] = vec4(warped_half_px * (from_middle + w), corner.z + w - corner.w, w);
    }
    if (has_sector) {
        return even_hull_of(given[0], given[1], given[2]);
    }
    Hull whole = even_hull_of(a, b, c);
    vec2 least = whole.corners[0];
    vec2 greatest = whole.corners[0];
    for (uint index = 1u; index < whole.count; index++) {
        least = min(least, whole.corners[index]);
        greatest = max(greatest, whole.corners[index]);
    }
    if (whole.count == 0u) {
        return whole;
    }
    return warped_box_of(least, greatest);
}

// As far back as all of the triangle in a pixel allows (section 4.4): in its plane, or where the hull comes before the near
// plane there, as near as its nearest corner. Corners as `hull_of` takes them.
Depths hull_depths(vec4 a, vec4 b, vec4 c, Hull hull) {
    Depths nearest = nearest_depths(a, b, c);
    if (deep.warp_falloff != 0.0 || nearest.at_origin == 1.0) {
        return nearest;
    }
    Depths plane = plane_depths(a, b, c);
    float greatest = 0.0;
    for (uint index = 0u; index < hull.count; index++) {
        greatest = max(greatest, depth_at(plane, hull.corners[index]));
    }
    return greatest < 1.0 ? plane : nearest;
}

#endif
