// Triangles by their ids, fetched from the scene's buffers: where the corners are when the shutter opens and closes.
//
// The including shader declares `params` (DrawnParams), `deep` (DeepBlock), the buffers of the scene as
// scene_buffers.glsl names them.
#ifndef DEEP_SHADING_CORNERS_GLSL
#define DEEP_SHADING_CORNERS_GLSL

// Where a vertex is, world space, when the shutter opens.
vec4 open_ws(uint vertex) {
    vec3 position = vec3(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
    precise vec4 placed = draws[params.draw].world_from_object * vec4(position, 1.0);
    return placed;
}

// The same when it closes.
vec4 close_ws(uint vertex) {
    vec3 position =
        vec3(close_positions[3u * vertex], close_positions[3u * vertex + 1u], close_positions[3u * vertex + 2u]);
    precise vec4 placed = close_draws[params.draw].world_from_object * vec4(position, 1.0);
    return placed;
}

uint vertex_of(uint corner) {
    return indices[corner] + params.vertex_offset;
}

// Clip space in the middle of the exposure, from the middle of the lens: canonical shading space (section 6). As the
// appendix has it the mean is taken in clip space.
vec4 canonical_clip(uint vertex) {
    precise vec4 clip = deep.open_clip_from_world * open_ws(vertex);
    if (IS_MOVING != 0u) {
        precise vec4 close = deep.close_clip_from_world * close_ws(vertex);
        clip = 0.5 * clip + 0.5 * close;
    }
    return clip;
}

// A corner as shading space has it: xy homogeneous pixels, zw of clip space.
vec4 canonical_corner(uint corner) {
    vec4 clip = canonical_clip(vertex_of(corner));
    return vec4(shading_from_clip(deep, clip), clip.zw);
}

// The same of a place between such corners, by their weights.
vec4 canonical_between(vec4 corners[3], vec3 weights) {
    return weights.x * corners[0] + weights.y * corners[1] + weights.z * corners[2];
}

// Weights of a triangle's corners, of sum 1, without those below 0: the rasteriser moves corners a little, and where a
// triangle is seen edge-on that little can be far in shading space.
vec3 inside_weights(vec3 weights) {
    vec3 inside = max(weights, vec3(0.0));
    return inside / (inside.x + inside.y + inside.z);
}

#endif
