// What a plane through a volume shows of it, and how much of what lies behind it hides: a step's worth of the field, as the
// plane cuts it. Keller and Heidrich 2001, section 3.3. Pass: src/techniques/interleaved_sampling/slices.rs.
#version 460
#include "techniques/interleaved_sampling/slices.glsl"

layout(location = 0) flat in vec2 in_plane;

// Premultiplied.
layout(location = 0) out vec4 out_color;

void main() {
    // From the texel, not from the corners, which rasterisers snap to parts of one.
    ViewRay ray = clip_ray(frame, gl_FragCoord.xy / vec2(params.layer_width, params.layer_height) * 2.0 - 1.0);
    float cosine = dot(ray.direction, axis_ws());
    float along = (in_plane.x - depth_of(ray.origin)) / cosine;
    vec3 place = (volume.voxels_from_world * vec4(ray.origin + ray.direction * along, 1.0)).xyz;
    vec4 seen = medium_at(place);
    float hidden = opacity(seen.w, in_plane.y / cosine);
    out_color = vec4(seen.rgb * hidden, hidden);
}
