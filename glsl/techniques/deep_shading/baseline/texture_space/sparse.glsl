// Which triangles no sample of the frame can see, by the side that they show and by their place: they are not shaded.
//
// After scene_buffers.glsl, seen.glsl, triangle.glsl and bound.glsl.
#ifndef DEEP_SHADING_SPARSE_GLSL
#define DEEP_SHADING_SPARSE_GLSL

// A corner's homogeneous x, y and w (pixels of the frame from some place on), and how far the lens's radius moves x and y.
struct Track {
    vec3 at;
    vec2 by_lens;
};

// Bernstein coefficients, over the exposure, of the determinant of three vectors that each move evenly.
vec4 determinants(vec3 a, vec3 b, vec3 c, vec3 a_close, vec3 b_close, vec3 c_close) {
    vec3 open = cross(b, c);
    if (IS_MOVING == 0u) {
        return vec4(dot(a, open));
    }
    vec3 close = cross(b_close, c_close);
    vec3 both = cross(b, c_close) + cross(b_close, c);
    return vec4(
        dot(a, open), (dot(a_close, open) + dot(a, both)) / 3.0, (dot(a_close, both) + dot(a, close)) / 3.0,
        dot(a_close, close));
}

// `seen`: as of see_triangle. False: no sample sees it.
bool may_be_seen(Seen seen[6], vec2 frame_px) {
    uint near_count = 0u;
    for (uint index = 0u; index < 6u; index++) {
        bool is_before = seen[index].clip.w > 0.0 && seen[index].clip.z <= seen[index].clip.w;
        near_count += is_before ? 0u : 1u;
    }
    if (near_count > 0u) {
        return near_count < 6u;
    }
    // Before the eye all that it covers lies in the hull of what the lens sees of its corners at both ends (bound.glsl).
    TupleBlock whole_frame = whole_frame_tuple();
    vec2 least = vec2(3.0e38);
    vec2 greatest = vec2(-3.0e38);
    for (uint index = 0u; index < 6u; index++) {
        Spot spot = spot_of(seen[index], whole_frame, 0.5 * frame_px);
        least = min(least, spot.middle - spot.radii);
        greatest = max(greatest, spot.middle + spot.radii);
    }
    // A layer's pixels are a table apart: so far corners may be snapped.
    vec2 table = vec2(deep.table_width_px, deep.table_height_px);
    if (any(greaterThan(least, frame_px + table)) || any(lessThan(greatest, -table))) {
        return false;
    }
    if ((params.flags & DRAWN_DOUBLE_SIDED) != 0u) {
        return true;
    }
    // At a moment the determinant of the corners, whose sign is the side that they show, changes evenly with the place on the lens:
    // there it is at least what it is in the middle less the length of that change.
    vec2 from = 0.5 * (least + greatest);
    Track tracks[6];
    float volumes = 1.0;
    for (uint index = 0u; index < 6u; index++) {
        vec4 clip = seen[index].clip;
        vec2 lens = HAS_LENS != 0u ? deep.lens * lens_part(seen[index].depth) : vec2(0.0);
        tracks[index] = Track(
            vec3(0.5 * frame_px * (clip.xy + clip.w) - clip.w * from, clip.w), 0.5 * frame_px * lens);
        volumes *= index < 3u ? max(clip.w, seen[index + 3u].clip.w) : 1.0;
    }
    vec3 x = vec3(tracks[0].at.x, tracks[1].at.x, tracks[2].at.x);
    vec3 y = vec3(tracks[0].at.y, tracks[1].at.y, tracks[2].at.y);
    vec3 w = vec3(tracks[0].at.z, tracks[1].at.z, tracks[2].at.z);
    vec3 u = vec3(tracks[0].by_lens.x, tracks[1].by_lens.x, tracks[2].by_lens.x);
    vec3 v = vec3(tracks[0].by_lens.y, tracks[1].by_lens.y, tracks[2].by_lens.y);
    vec3 x_close = vec3(tracks[3].at.x, tracks[4].at.x, tracks[5].at.x);
    vec3 y_close = vec3(tracks[3].at.y, tracks[4].at.y, tracks[5].at.y);
    vec3 w_close = vec3(tracks[3].at.z, tracks[4].at.z, tracks[5].at.z);
    vec3 u_close = vec3(tracks[3].by_lens.x, tracks[4].by_lens.x, tracks[5].by_lens.x);
    vec3 v_close = vec3(tracks[3].by_lens.y, tracks[4].by_lens.y, tracks[5].by_lens.y);
    vec4 middle = determinants(x, y, w, x_close, y_close, w_close);
    vec4 by_u = determinants(u, y, w, u_close, y_close, w_close);
    vec4 by_v = determinants(x, v, w, x_close, v_close, w_close);
    vec4 change = sqrt(by_u * by_u + by_v * by_v);
    // Corners are snapped, and rounded: in a box a triangle's sides are no longer than its rim, and an area is at most that times by
    // how far they move. The determinant is twice an area times the three w.
    vec2 size = greatest - least;
    float moved = max(table.x, table.y) * snap_px() + 1e-5 * max(size.x, size.y);
    vec4 margin = change + 4.0 * volumes * (size.x + size.y + moved) * moved;
    // Fronts have negative ones, as place_at has it, but where a draw is mirrored.
    bool is_mirrored = (params.flags & DRAWN_MIRRORED) != 0u;
    return any(lessThanEqual(is_mirrored ? -middle : middle, margin));
}

#endif
