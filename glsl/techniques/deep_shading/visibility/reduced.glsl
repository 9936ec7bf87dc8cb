// A sample's test against a moving triangle under a lens by as few products as it takes: the triangle's own transform is done once
// for all samples of a pixel, and a sample moves corners along their ways, shears them by its place on the lens and looks at them
// from where it is in the frame (section 4.2, which names Laine and Karras 2011, "Efficient Triangle Coverage Tests for Stochastic
// Rasterization", whose test in five dimensions takes about 25 fused multiply-adds; here the edges take 30, and six subtractions).
//
// After polygon_in.glsl and covers.glsl.
#ifndef DEEP_SHADING_REDUCED_GLSL
#define DEEP_SHADING_REDUCED_GLSL

// A triangle when the shutter opens, and by how much it changes until it closes: xy homogeneous pixels of the frame, z: w, and
// w: metres before the eye; depth apart.
struct Swept {
    vec4 open[3];
    vec4 change[3];
    vec3 open_z;
    vec3 change_z;
    vec2 half_frame_px;
};

vec4 frame_corner(Seen seen, vec2 half_frame_px) {
    precise vec4 corner = vec4(half_frame_px * (seen.clip.xy + seen.clip.w), seen.clip.w, seen.depth);
    return corner;
}

Swept swept_triangle(uint width_px, uint height_px) {
    Swept swept;
    swept.half_frame_px = 0.5 * vec2(width_px, height_px);
    for (uint corner = 0u; corner < 3u; corner++) {
        swept.open[corner] = frame_corner(open_corner(corner), swept.half_frame_px);
        precise vec4 change = frame_corner(close_corner(corner), swept.half_frame_px) - swept.open[corner];
        swept.change[corner] = change;
        swept.open_z[corner] = in_open[corner].z;
        precise float change_z = in_close[corner].z - in_open[corner].z;
        swept.change_z[corner] = change_z;
    }
    return swept;
}

// What edges span with the sample, as areas_of. `pixel`: of the frame.
vec3 reduced_areas(Swept swept, TupleBlock tuple, vec2 pixel) {
    precise vec2 at = pixel + tuple.place_px;
    precise vec2 shear = swept.half_frame_px * deep.lens * tuple.lens;
    precise vec2 shear_per_metre = shear * deep.inverse_focus;
    vec2 from[3];
    for (uint corner = 0u; corner < 3u; corner++) {
        precise vec4 now = swept.open[corner];
        if (IS_MOVING != 0u) {
            now = swept.open[corner] + tuple.time * swept.change[corner];
        }
        precise vec2 here = now.xy - now.z * at;
        if (HAS_LENS != 0u) {
            here = here + (now.w * shear_per_metre - shear);
        }
        from[corner] = here;
    }
    return areas_of(from[0], from[1], from[2]);
}

// Depth and w at a place with these weights.
vec2 reduced_depth(Swept swept, TupleBlock tuple, vec3 weights) {
    precise vec3 z = swept.open_z;
    precise vec3 w = vec3(swept.open[0].z, swept.open[1].z, swept.open[2].z);
    if (IS_MOVING != 0u) {
        z = swept.open_z + tuple.time * swept.change_z;
        w = w + tuple.time * vec3(swept.change[0].z, swept.change[1].z, swept.change[2].z);
    }
    precise vec2 depth = vec2(dot(weights, z), dot(weights, w));
    return depth;
}

#endif
