// What every shader may know of the frame: camera, extent, the scene's box, constant light. Written by src/frame.rs.
// The including shader declares the buffer and calls it `frame`.
#ifndef FRAME_GLSL
#define FRAME_GLSL

struct FrameBlock {
    // Reversed depth: 1 at the near plane, 0 at the far plane or at infinity.
    mat4 clip_from_world;
    mat4 world_from_clip;
    // xyz: the eye in world space; w: 1 for perspective, 0 for orthographic.
    vec4 eye_ws;
    // xyz: the camera's axes as unit vectors, world space: where it looks, its right, its up.
    vec4 forward_ws;
    vec4 right_ws;
    vec4 up_ws;
    // The scene's box: positions of unorm16 are fractions of it.
    vec4 box_min_ws;
    vec4 box_size_ws;
    // Radiance where no surface is.
    vec4 background;
    // Radiance that comes from everywhere, unshadowed.
    vec4 ambient;
    uint width_px;
    uint height_px;
    uint light_count;
    uint vpl_count;
    // Which run of the frame this is, of techniques that sum several up to a picture; else 0.
    uint sample_index;
    uint _unused[3];
};

// Unit vector from a surface point to the eye.
vec3 to_eye(FrameBlock frame, vec3 position_ws) {
    return frame.eye_ws.w > 0.0 ? normalize(frame.eye_ws.xyz - position_ws) : -frame.forward_ws.xyz;
}

#endif
