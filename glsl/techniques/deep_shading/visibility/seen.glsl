// Corners as the ends of the exposure and as a tuple see them: every kind of visibility must put a triangle into the same
// place. After scene_buffers.glsl.
#ifndef DEEP_SHADING_SEEN_GLSL
#define DEEP_SHADING_SEEN_GLSL

// A corner at one end of the exposure, from the middle of the lens.
struct Seen {
    // Of the frame's clip space.
    vec4 clip;
    // Metres before the eye.
    float depth;
};

Seen seen_open(uint vertex) {
    vec4 open = open_ws(vertex);
    Seen seen;
    seen.clip = deep.open_clip_from_world * open;
    seen.depth = dot(deep.open_depth.xyz, open.xyz) + deep.open_depth.w;
    return seen;
}

Seen seen_close(uint vertex) {
    vec4 close = close_ws(vertex);
    Seen seen;
    seen.clip = deep.close_clip_from_world * close;
    seen.depth = dot(deep.close_depth.xyz, close.xyz) + deep.close_depth.w;
    return seen;
}

// A thin lens: by how much of its shear a point moves that lies `depth` metres before the eye: what lies in the plane in
// focus stays where it is, what lies behind it goes the other way than what lies before it.
float lens_part(float depth) {
    return depth * deep.inverse_focus - 1.0;
}

// Clip space of the tuple's layer. `close` is read where something moves.
vec4 clip_of(Seen open, Seen close, TupleBlock tuple) {
    vec4 clip = open.clip;
    float depth = open.depth;
    if (IS_MOVING != 0u) {
        clip = mix(clip, close.clip, tuple.time);
        depth = mix(depth, close.depth, tuple.time);
    }
    if (HAS_LENS != 0u) {
        clip.xy += deep.lens * tuple.lens * lens_part(depth);
    }
    clip.xy = clip.xy * tuple.scale + clip.w * tuple.shift;
    return clip;
}

#endif
