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

// What is seen through a place, from the near plane to the far one. Twin: src/frame.rs.
struct ViewRay {
    vec3 origin;
    vec3 direction;
    // How far it reaches, and how far before its origin it would begin if no near plane cut it, in metres.
    float limit;
    float behind;
    // How far before the eye's plane the near plane lies, in metres.
    float near;
};

// Where a ray ends that nothing does.
const float FAR = 1e30;

// Through a place of what is drawn into, -1 to 1 along both axes.
ViewRay clip_ray(FrameBlock frame, vec2 ndc) {
    vec4 near = frame.world_from_clip * vec4(ndc, 1.0, 1.0);
    vec4 far = frame.world_from_clip * vec4(ndc, 0.0, 1.0);
    bool is_perspective = frame.eye_ws.w > 0.0;
    // A far plane at infinity has w = 0: this is a direction all the same.
    vec3 direction = is_perspective ? normalize(far.xyz - frame.eye_ws.xyz * far.w) : frame.forward_ws.xyz;
    vec3 start = near.xyz / near.w;
    float behind = is_perspective ? distance(start, frame.eye_ws.xyz) : 0.0;
    // Along the ray, and not to the near plane's own point, which floats place too roughly next to the eye.
    vec3 origin = is_perspective ? frame.eye_ws.xyz + direction * behind : start;
    float limit = far.w > 0.0 ? min(distance(far.xyz / far.w, origin), FAR) : FAR;
    float near_m = dot(start - frame.eye_ws.xyz, frame.forward_ws.xyz);
    return ViewRay(origin, direction, limit, behind, near_m);
}

ViewRay view_ray(FrameBlock frame, vec2 at_px) {
    return clip_ray(frame, at_px / vec2(frame.width_px, frame.height_px) * 2.0 - 1.0);
}

#endif
