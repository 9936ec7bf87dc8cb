// A triangle's corners at both ends of the exposure, and where a tuple's layer has them. After seen.glsl.
#ifndef DEEP_SHADING_TRIANGLE_GLSL
#define DEEP_SHADING_TRIANGLE_GLSL

// Three when the shutter opens, and the same when it closes. `triangle`: of the index buffer.
void see_triangle(uint triangle, out Seen seen[6]) {
    for (uint corner = 0u; corner < 3u; corner++) {
        uint fetched = vertex_of(3u * triangle + corner);
        seen[corner] = seen_open(fetched);
        seen[corner + 3u] = seen[corner];
        if (IS_MOVING != 0u) {
            seen[corner + 3u] = seen_close(fetched);
        }
    }
}

// xy: homogeneous pixels of the tuple's layer; zw: depth and w.
vec4 layer_corner(Seen open, Seen close, TupleBlock tuple) {
    vec2 layer = vec2(deep.layer_width_px, deep.layer_height_px);
    vec4 clip = clip_of(open, close, tuple);
    precise vec2 at = 0.5 * layer * (clip.xy + clip.w);
    return vec4(at, clip.zw);
}

#endif
