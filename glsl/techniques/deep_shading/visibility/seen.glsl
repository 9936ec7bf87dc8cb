// Corners as the ends of the exposure and as a tuple see them (section 4.2; appendix A, pass 1): every kind of visibility must
// put a triangle into the same place, whichever stage does it, and strays must be found where their samples saw them.
// After scene_buffers.glsl.
#ifndef DEEP_SHADING_SEEN_GLSL
#define DEEP_SHADING_SEEN_GLSL

// A corner at one end of the exposure, from the middle of the lens.
struct Seen {
    // Place in the frame's clip space.
    vec4 clip;
    // Metres before the eye.
    float depth;
};

Seen seen_open(uint vertex) {
    vec4 open = open_ws(vertex);
    precise vec4 clip = deep.open_clip_from_world * open;
    precise float depth = dot(deep.open_depth.xyz, open.xyz) + deep.open_depth.w;
    return Seen(clip, depth);
}

Seen seen_close(uint vertex) {
    vec4 close = close_ws(vertex);
    precise vec4 clip = deep.close_clip_from_world * close;
    precise float depth = dot(deep.close_depth.xyz, close.xyz) + deep.close_depth.w;
    return Seen(clip, depth);
}

// A thin lens: by how much of its shear a point moves that lies `depth` metres before the eye: what lies in the plane in
// focus stays where it is, what lies behind it goes the other way than what lies before it.
float lens_part(float depth) {
    return depth * deep.inverse_focus - 1.0;
}

// In canonical shading space: xy homogeneous pixels, zw of clip space. `close` is read where something moves, here and below.
vec4 canonical_of(Seen open, Seen close) {
    precise vec4 clip = open.clip;
    if (IS_MOVING != 0u) {
        clip = 0.5 * open.clip + 0.5 * close.clip;
    }
    return vec4(shading_from_clip(deep, clip), clip.zw);
}

// Clip space of the tuple's layer.
vec4 clip_of(Seen open, Seen close, TupleBlock tuple) {
    precise vec4 clip = open.clip;
    precise float depth = open.depth;
    if (IS_MOVING != 0u) {
        clip = mix(open.clip, close.clip, tuple.time);
        depth = mix(open.depth, close.depth, tuple.time);
    }
    precise vec2 at = clip.xy;
    if (HAS_LENS != 0u) {
        at = clip.xy + deep.lens * tuple.lens * lens_part(depth);
    }
    precise vec2 placed = at * tuple.scale + clip.w * tuple.shift;
    return vec4(placed, clip.zw);
}

#endif
