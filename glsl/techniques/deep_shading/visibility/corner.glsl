// A corner of a triangle between both ends of the exposure, and where one tuple sees it (Clarberg & Munkberg 2014, section 4.2;
// appendix A, pass 1). The same operations in the same order, whichever stage makes them: the passes over one tuple must
// agree on depth to the bit.
//
// After scene_buffers.glsl.
#ifndef DEEP_SHADING_CORNER_GLSL
#define DEEP_SHADING_CORNER_GLSL

struct Exposed {
    // Clip space of the frame, from the middle of the lens, when the shutter opens and closes.
    vec4 open_clip;
    vec4 close_clip;
    // Metres before the eye, at both.
    vec2 depths;
};

Exposed exposed_at(uint vertex) {
    vec4 open = open_ws(vertex);
    Exposed exposed;
    precise vec4 open_clip = deep.open_clip_from_world * open;
    precise float open_depth = dot(deep.open_depth.xyz, open.xyz) + deep.open_depth.w;
    exposed.open_clip = open_clip;
    exposed.close_clip = open_clip;
    exposed.depths = vec2(open_depth);
    if (IS_MOVING != 0u) {
        vec4 close = close_ws(vertex);
        precise vec4 close_clip = deep.close_clip_from_world * close;
        precise float close_depth = dot(deep.close_depth.xyz, close.xyz) + deep.close_depth.w;
        exposed.close_clip = close_clip;
        exposed.depths.y = close_depth;
    }
    return exposed;
}

// In canonical shading space: xy homogeneous pixels, zw of clip space.
vec4 canonical_of(Exposed exposed) {
    precise vec4 clip = exposed.open_clip;
    if (IS_MOVING != 0u) {
        clip = 0.5 * exposed.open_clip + 0.5 * exposed.close_clip;
    }
    return vec4(shading_from_clip(deep, clip), clip.zw);
}

// Clip space of the tuple's layer.
vec4 clip_of(Exposed exposed, TupleBlock tuple) {
    precise vec4 clip = exposed.open_clip;
    precise float depth = exposed.depths.x;
    if (IS_MOVING != 0u) {
        clip = mix(exposed.open_clip, exposed.close_clip, tuple.time);
        depth = mix(exposed.depths.x, exposed.depths.y, tuple.time);
    }
    if (HAS_LENS != 0u) {
        // A thin lens: what lies in the plane in focus stays where it is.
        precise vec2 moved = clip.xy + deep.lens * tuple.lens * (depth * deep.inverse_focus - 1.0);
        clip = vec4(moved, clip.zw);
    }
    precise vec2 placed = clip.xy * tuple.scale + clip.w * tuple.shift;
    return vec4(placed, clip.zw);
}

#endif
