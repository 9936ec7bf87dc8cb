// The colour of a triangle at a place on it: its whole material under all lights, in the middle of the exposure.
//
// The including shader includes scene_buffers.glsl, has the axis VERTEX and `primitive`'s draw in `params`.
#ifndef DEEP_SHADING_SURFACE_GLSL
#define DEEP_SHADING_SURFACE_GLSL

#include "frame.glsl"
#include "bvh.glsl"
#include "loops.glsl"
#include "shading/light.glsl"
#include "techniques/deep_shading/attributes.glsl"
#include "techniques/deep_shading/place.glsl"
#include "techniques/deep_shading/scaled.glsl"
#include "techniques/deep_shading/stored.glsl"

// BRDF_ and SHADOW_ values.
layout(constant_id = 2) const uint BRDF_KIND = 2;
layout(constant_id = 3) const uint DIRECT_SHADOW = 0;

// The frame as it is in the middle of the exposure.
layout(std430, set = 0, binding = 17) readonly buffer Middle { FrameBlock frame; };
layout(std430, set = 0, binding = 3) readonly buffer Lights { LightBlock lights[]; };
layout(std430, set = 0, binding = 5) readonly buffer BvhNodes { BvhNodeBlock bvh_nodes[]; };
layout(std430, set = 0, binding = 6) readonly buffer BvhTriangles { BvhTriangleBlock bvh_triangles[]; };
layout(std430, set = 0, binding = 15) readonly buffer CloseAttributes { float close_attributes[]; };
#ifdef VERTEX_EXTENDED
layout(std430, set = 0, binding = 8) readonly buffer Placements { PlacementBlock placements[]; };
#endif

#define MATERIAL_PLACE
#include "shading/material.glsl"
#include "bvh_walk.glsl"
#include "shading/lit.glsl"

vec3 open_normal_ws(uint vertex) {
    uint at = ATTRIBUTE_FLOATS * vertex;
    DrawBlock draw = draws[params.draw];
    precise vec3 normal = draw.normal_x.xyz * attributes[at] + draw.normal_y.xyz * attributes[at + 1u] +
                          draw.normal_z.xyz * attributes[at + 2u];
    return normal;
}

vec3 close_normal_ws(uint vertex) {
    uint at = ATTRIBUTE_FLOATS * vertex;
    DrawBlock draw = close_draws[params.draw];
    precise vec3 normal = draw.normal_x.xyz * close_attributes[at] + draw.normal_y.xyz * close_attributes[at + 1u] +
                          draw.normal_z.xyz * close_attributes[at + 2u];
    return normal;
}

// w: the side of the bitangent.
vec4 open_tangent_ws(uint vertex) {
    uint at = ATTRIBUTE_FLOATS * vertex + 3u;
    vec3 tangent = vec3(attributes[at], attributes[at + 1u], attributes[at + 2u]);
    precise vec3 turned = mat3(draws[params.draw].world_from_object) * tangent;
    return vec4(turned, sign(attributes[at + 3u]));
}

vec3 close_tangent_ws(uint vertex) {
    uint at = ATTRIBUTE_FLOATS * vertex + 3u;
    vec3 tangent = vec3(close_attributes[at], close_attributes[at + 1u], close_attributes[at + 2u]);
    precise vec3 turned = mat3(close_draws[params.draw].world_from_object) * tangent;
    return turned;
}

// Directions of one length each: the mean of two moments is that of their directions.
vec3 mean_direction(vec3 open, vec3 close) {
    precise float open_length = sqrt(dot(open, open));
    precise float close_length = sqrt(dot(close, close));
    bool has_both = open_length > 0.0 && close_length > 0.0;
    precise vec3 sum = has_both ? open / open_length + close / close_length : open + close;
    return sum;
}

struct Corner {
    // As place_at takes it.
    vec4 canonical;
    vec3 position_ws;
    vec3 normal_ws;
    vec4 tangent_ws;
};

Corner corner_at(uint vertex) {
    Corner corner;
    vec4 clip = canonical_clip(vertex);
    corner.canonical = vec4(shading_from_clip(deep, clip), clip.zw);
    corner.position_ws = open_ws(vertex).xyz;
    corner.normal_ws = open_normal_ws(vertex);
    corner.tangent_ws = open_tangent_ws(vertex);
    if (IS_MOVING != 0u) {
        precise vec3 middle_ws = 0.5 * corner.position_ws + 0.5 * close_ws(vertex).xyz;
        corner.position_ws = middle_ws;
        corner.normal_ws = mean_direction(corner.normal_ws, close_normal_ws(vertex));
        corner.tangent_ws.xyz = mean_direction(corner.tangent_ws.xyz, close_tangent_ws(vertex));
    }
    return corner;
}

// The corners of a triangle of the draw of `params`, by its id.
uvec3 vertices_of(uint primitive) {
    uint corner = 3u * (primitive - params.primitive_offset);
    return uvec3(vertex_of(corner), vertex_of(corner + 1u), vertex_of(corner + 2u));
}

// Writes what is interpolated elsewhere. The triangle's corners, and a place on it with its rates of a pixel.
void stand_on(Corner a, Corner b, Corner c, uvec3 vertices, Place place) {
    precise vec3 position_ws =
        place.weights.x * a.position_ws + place.weights.y * b.position_ws + place.weights.z * c.position_ws;
    precise vec3 normal_ws = place.weights.x * a.normal_ws + place.weights.y * b.normal_ws + place.weights.z * c.normal_ws;
    precise vec3 tangent_ws =
        place.weights.x * a.tangent_ws.xyz + place.weights.y * b.tangent_ws.xyz + place.weights.z * c.tangent_ws.xyz;
    in_position_ws = position_ws;
    in_normal_ws = normal_ws;
    in_tangent_ws = vec4(tangent_ws, a.tangent_ws.w);
    in_material = draws[params.draw].material;
    in_front_facing = place.is_front != ((params.flags & DRAWN_MIRRORED) != 0u);
    vec2 uv_a = uv_at(vertices.x);
    vec2 uv_b = uv_at(vertices.y);
    vec2 uv_c = uv_at(vertices.z);
    precise vec2 uv = place.weights.x * uv_a + place.weights.y * uv_b + place.weights.z * uv_c;
    in_uv = uv;
    precise vec2 uv_right = place.right.x * uv_a + place.right.y * uv_b + place.right.z * uv_c;
    precise vec2 uv_down = place.down.x * uv_a + place.down.y * uv_b + place.down.z * uv_c;
    in_uv_right = uv_right;
    in_uv_down = uv_down;
#ifdef VERTEX_EXTENDED
    in_color = place.weights.x * color_at(vertices.x) + place.weights.y * color_at(vertices.y) +
               place.weights.z * color_at(vertices.z);
    uv_a = uv_1_at(vertices.x);
    uv_b = uv_1_at(vertices.y);
    uv_c = uv_1_at(vertices.z);
    in_uv_1 = place.weights.x * uv_a + place.weights.y * uv_b + place.weights.z * uv_c;
    in_uv_1_right = place.right.x * uv_a + place.right.y * uv_b + place.right.z * uv_c;
    in_uv_1_down = place.down.x * uv_a + place.down.y * uv_b + place.down.z * uv_c;
#endif
}

// The material says that light does not change it.
bool is_unlit() {
    return SURFACE_EXTRAS != 0u && (params.material.flags & MATERIAL_UNLIT) != 0u;
}

// Colour at the place that was written last.
uvec2 color_of_base(vec4 base_color) {
    vec3 radiance = base_color.rgb;
    if (!is_unlit()) {
        radiance =
            nan_if_cut(lit_at(params.material, base_color.rgb, in_position_ws, 0u, frame.light_count).radiance);
    }
    return stored_color(radiance);
}

// Writes what is interpolated elsewhere, of `primitive`, of the draw of `params`. With `is_given` the weights say where on the
// triangle; else it is the middle of `pixel`.
void stand_in(uint primitive, uvec2 pixel, bool is_given, vec3 weights) {
    uvec3 vertices = vertices_of(primitive);
    Corner a = corner_at(vertices.x);
    Corner b = corner_at(vertices.y);
    Corner c = corner_at(vertices.z);
    EvenPixel even = even_pixel(deep, pixel);
    Place place = place_at(
        scaled(a.canonical, primitive), scaled(b.canonical, primitive), scaled(c.canonical, primitive), even.middle);
    vec3 right = place.right;
    if (deep.warp_falloff != 0.0) {
        place.right = even.right.x * right + even.right.y * place.down;
        place.down = even.down.x * right + even.down.y * place.down;
    }
    if (is_given) {
        place.weights = weights;
        place.right = vec3(0.0);
        place.down = vec3(0.0);
    }
    stand_on(a, b, c, vertices, place);
}

// Writes what is interpolated elsewhere, of a place on `primitive`.
void stand_at(uint primitive, Place place) {
    uvec3 vertices = vertices_of(primitive);
    stand_on(corner_at(vertices.x), corner_at(vertices.y), corner_at(vertices.z), vertices, place);
}

// A colour as an attachment of half floats holds it to the bit, however the driver rounds: numbers that are half floats already.
// Mesa 25.0.7 takes unpacking for the inverse of packing, and lavapipe then cuts the numbers off by itself.
vec4 attached_color(uvec2 words) {
    words ^= deep.opaque_zero;
    return vec4(unpackHalf2x16(words.x), unpackHalf2x16(words.y));
}

#endif
