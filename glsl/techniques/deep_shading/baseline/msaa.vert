// A triangle around all that a triangle covers of the frame while the shutter is open, and its corners at both ends of the
// exposure. Pass: src/techniques/deep_shading/baseline/msaa.rs.
//
// Why one triangle: of a polygon of several the pixels along its inner edges would be run, and shaded, once for each side.
#version 460
#include "frame.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/visibility/seen.glsl"
#include "techniques/deep_shading/visibility/triangle.glsl"
#include "techniques/deep_shading/visibility/bound.glsl"
#include "techniques/deep_shading/baseline/box.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };

layout(location = 1) flat out uint out_primitive;
// Clip space when the shutter opens, and closes; and metres before the eye.
layout(location = 2) flat out vec4 out_open[3];
layout(location = 5) flat out vec4 out_close[3];
layout(location = 8) flat out vec3 out_open_depth;
layout(location = 9) flat out vec3 out_close_depth;
// What the triangle is drawn around: its direction, and from where to where along it and across it.
layout(location = 10) flat out vec2 out_along;
layout(location = 11) flat out vec4 out_range;

// The rasteriser's own samples only say which pixels are run: all of those that a pixel has must be covered where any place
// in it may be. A quarter is for rounding.
const float WHOLE_PIXEL = 1.25;

Box box_of(Bound bound, vec2 along) {
    Box box = Box(along, vec2(3.0e38), vec2(-3.0e38));
    for (uint index = 0u; index < bound.count; index++) {
        vec2 at = turned(along, bound.corners[index]);
        box.least = min(box.least, at);
        box.greatest = max(box.greatest, at);
    }
    return box;
}

// With whole pixels around it: how far a pixel's corners lie along a direction.
Box widened(Box box) {
    float reach = WHOLE_PIXEL * (abs(box.along.x) + abs(box.along.y));
    return Box(box.along, box.least - reach, box.greatest + reach);
}

float area_of(Box box) {
    vec2 size = widened(box).greatest - widened(box).least;
    return size.x * size.y;
}

// Nothing of it is in the frame.
bool is_outside(Box upright, vec2 frame_px) {
    return any(lessThan(upright.greatest, vec2(0.0))) || any(greaterThan(upright.least, frame_px));
}

// The lesser of the box along the polygon's longest side and what the frame has of the upright one.
Box best_box(Bound bound, Box upright, vec2 frame_px) {
    vec2 longest = vec2(1.0, 0.0);
    for (uint index = 0u; index < bound.count; index++) {
        vec2 side = bound.corners[(index + 1u) % bound.count] - bound.corners[index];
        if (dot(side, side) > dot(longest, longest)) {
            longest = side;
        }
    }
    upright.least = max(upright.least, vec2(0.0));
    upright.greatest = min(upright.greatest, frame_px);
    Box tilted = box_of(bound, normalize(longest));
    if (area_of(tilted) < area_of(upright)) {
        return tilted;
    }
    return upright;
}

void main() {
    uint corner = uint(gl_VertexIndex) % 3u;
    uint triangle = uint(gl_VertexIndex) / 3u;
    Seen seen[6];
    see_triangle(triangle, seen);
    for (uint index = 0u; index < 3u; index++) {
        out_open[index] = seen[index].clip;
        out_close[index] = seen[index + 3u].clip;
    }
    out_open_depth = vec3(seen[0].depth, seen[1].depth, seen[2].depth);
    out_close_depth = vec3(seen[3].depth, seen[4].depth, seen[5].depth);
    out_primitive = params.primitive_offset + triangle;
    vec2 frame_px = vec2(frame.width_px, frame.height_px);
    TupleBlock whole_frame = whole_frame_tuple();
    Bound bound = bound_of(seen, whole_frame, frame_px, 0.0);
    Box upright = box_of(bound, vec2(1.0, 0.0));
    if (bound.count == 0u || is_outside(upright, frame_px)) {
        gl_Position = vec4(0.0, 0.0, 0.5, 1.0);
        return;
    }
    Box tight = best_box(bound, upright, frame_px);
    out_along = tight.along;
    out_range = vec4(tight.least, tight.greatest);
    Box box = widened(tight);
    // Twice as long and as wide as the box, whose far corner lies on its long side; towards the middle of the frame, so that
    // it rarely leaves what drivers draw without cutting it into pieces.
    vec2 size = box.greatest - box.least;
    vec2 middle = turned(box.along, 0.5 * frame_px);
    bvec2 from_least = lessThan(box.least + box.greatest, 2.0 * middle);
    vec2 start = mix(box.greatest, box.least, from_least);
    vec2 way = mix(-size, size, from_least);
    vec2 at = start + 2.0 * way * vec2(corner == 1u, corner == 2u);
    vec2 across = vec2(-box.along.y, box.along.x);
    gl_Position = vec4((box.along * at.x + across * at.y) * 2.0 / frame_px - 1.0, 0.5, 1.0);
}
