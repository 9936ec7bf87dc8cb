// The surface that a ray meets: attributes between a triangle's corners, and its material with its textures. The same as
// the G-buffer pass makes of a fragment, but for textures: a pixel is many rays, and their finest level is read, or that of the
// ray's cone (TEXTURE_CONE); of alpha and emission always the finest.
//
// The including shader declares bvh_triangles[], bvh_closing[], surfaces[], closings[], tangents[], extended[],
// traced_materials[] and what texel.glsl needs.
#ifndef SHADING_TRACED_GLSL
#define SHADING_TRACED_GLSL

#include "bvh_moving.glsl"
#include "shading/brdf.glsl"
#include "shading/texel.glsl"

struct SurfacePoint {
    vec3 position_ws;
    // Unit normal of the triangle's plane, on the side that the ray comes from.
    vec3 plane_ws;
    // Unit shading normal.
    vec3 normal_ws;
    Surface surface;
    // Radiance of its own towards where the ray comes from.
    vec3 emitted;
    float emitter_density;
    // Part of ambient light that arrives by the occlusion map; 1 where none is read.
    float openness;
    bool is_unlit;
    // The back of a single-sided surface: black.
    bool is_back;
};

// What is known of a point before its textures are read.
struct Corners {
    vec3 weights;
    // Both UV sets.
    vec4 uvs;
    vec4 color;
    uint material;
};

Corners corners_of(TracedTriangleBlock triangle, uint index, vec2 barycentric) {
    Corners point;
    point.weights = vec3(1.0 - barycentric.x - barycentric.y, barycentric);
    vec3 u = vec3(triangle.corners[0].w, triangle.corners[1].w, triangle.corners[2].w);
    point.uvs = vec4(dot(u, point.weights), dot(triangle.v_material.xyz, point.weights), 0.0, 0.0);
    point.color = vec4(1.0);
    if (HAS_EXTENDED != 0u) {
        TracedExtendedBlock more = extended[index];
        mat3x4 colors = mat3x4(more.colors[0], more.colors[1], more.colors[2]);
        point.color = colors * point.weights;
        point.uvs.zw = more.uvs_01.xy * point.weights.x + more.uvs_01.zw * point.weights.y + more.uv_2.xy * point.weights.z;
    }
    point.material = floatBitsToUint(triangle.v_material.w);
    return point;
}

vec4 textured(vec4 factor, TexelsBlock texels, vec4 uvs, Footprint footprint) {
    return HAS_TEXTURES != 0u ? factor * texel_of(texels, uvs, footprint) : factor;
}

// Twice the area of a triangle in a UV set, by two of its edges.
float uv_area(vec2 first, vec2 second) {
    return abs(first.x * second.y - first.y * second.x);
}

// Where a cone meets a triangle. `plane`: its corners where the ray meets them; `width`: across the ray, metres. The widths are of
// Akenine-Moeller et al. 2019, the axes are those of the cone's cut with the plane.
Footprint footprint_of(BvhTriangleBlock plane, TracedTriangleBlock triangle, uint index, vec3 direction_ws, float width) {
    vec3 v = triangle.v_material.xyz;
    vec2 first = vec2(triangle.corners[0].w, v.x);
    vec4 edge1 = vec4(vec2(triangle.corners[1].w, v.y) - first, 0.0, 0.0);
    vec4 edge2 = vec4(vec2(triangle.corners[2].w, v.z) - first, 0.0, 0.0);
    if (HAS_EXTENDED != 0u) {
        TracedExtendedBlock more = extended[index];
        edge1.zw = more.uvs_01.zw - more.uvs_01.xy;
        edge2.zw = more.uv_2.xy - more.uvs_01.xy;
    }
    vec3 normal = cross(plane.edge1.xyz, plane.edge2.xyz);
    float area = max(length(normal), 1e-30);
    normal /= area;
    float slope = dot(normal, direction_ws);
    float long_width = width / max(abs(slope), 1e-4);
    Footprint footprint = FINEST;
    footprint.widths = sqrt(vec2(uv_area(edge1.xy, edge2.xy), uv_area(edge1.zw, edge2.zw)) / area) * long_width;
    if (TEXTURE_CONE != 1u) {
        vec3 tilt = direction_ws - normal * slope;
        // Seen from straight above any direction is as good.
        tilt = dot(tilt, tilt) > 1e-12 ? normalize(tilt) : normalize(plane.edge1.xyz);
        vec3 along = tilt * long_width;
        vec3 across = cross(normal, tilt) * width;
        // Steps in the plane as parts of the edges, of the dual basis.
        vec3 of_edge1 = cross(plane.edge2.xyz, normal) / area;
        vec3 of_edge2 = cross(normal, plane.edge1.xyz) / area;
        footprint.along = edge1 * dot(along, of_edge1) + edge2 * dot(along, of_edge2);
        footprint.across = edge1 * dot(across, of_edge1) + edge2 * dot(across, of_edge2);
    }
    return footprint;
}

// How much of a ray this point stops, 0 to 1.
float coverage_at(uint index, vec2 barycentric) {
    Corners point = corners_of(surfaces[index], index, barycentric);
    TracedMaterialBlock traced = traced_materials[point.material];
    float alpha = textured(traced.material.base_color * point.color, traced.base_color, point.uvs, FINEST).a;
    if (traced.alpha == ALPHA_IS_MASK) {
        return alpha < traced.material.alpha_cutoff ? 0.0 : 1.0;
    }
    return traced.alpha == ALPHA_IS_BLEND ? clamp(alpha, 0.0, 1.0) : 1.0;
}

// Radiance that a point of an emitter sends, dimmed by its alpha.
vec3 emitted_at(uint index, vec2 barycentric) {
    Corners point = corners_of(surfaces[index], index, barycentric);
    TracedMaterialBlock traced = traced_materials[point.material];
    vec3 radiance = textured(vec4(traced.material.emissive.rgb, 1.0), traced.emissive, point.uvs, FINEST).rgb;
    return traced.alpha == ALPHA_IS_OPAQUE ? radiance : radiance * coverage_at(index, barycentric);
}

// Whether a ray of this direction comes from the side that is the triangle's front.
bool is_front_of(BvhTriangleBlock triangle, vec3 direction_ws) {
    bool is_mirrored = (floatBitsToUint(triangle.corner.w) & TRIANGLE_MIRRORED) != 0u;
    return (dot(cross(triangle.edge1.xyz, triangle.edge2.xyz), direction_ws) < 0.0) != is_mirrored;
}

// `cone_width`: of the ray's cone here, across it, metres; of TEXTURE_CONE.
SurfacePoint surface_point(uint index, vec2 barycentric, vec3 direction_ws, float cone_width) {
    BvhTriangleBlock plane = triangle_at(index);
    TracedTriangleBlock triangle = surfaces[index];
    if (MOVES != 0u) {
        for (uint corner = 0u; corner < 3u; corner++) {
            vec3 to = closings[index].normals[corner].xyz;
            triangle.corners[corner].xyz = mix(triangle.corners[corner].xyz, to, shutter_part);
        }
    }
    Corners corners = corners_of(triangle, index, barycentric);
    TracedMaterialBlock traced = traced_materials[corners.material];
    MaterialBlock material = traced.material;
    SurfacePoint point;
    point.position_ws = plane.corner.xyz + plane.edge1.xyz * barycentric.x + plane.edge2.xyz * barycentric.y;
    vec3 plane_ws = normalize(cross(plane.edge1.xyz, plane.edge2.xyz));
    point.plane_ws = dot(plane_ws, direction_ws) < 0.0 ? plane_ws : -plane_ws;
    Footprint footprint = FINEST;
    if (TEXTURE_CONE != 0u) {
        footprint = footprint_of(plane, triangle, index, direction_ws, cone_width);
    }
    bool is_front = is_front_of(plane, direction_ws);
    bool is_double_sided = (material.flags & MATERIAL_DOUBLE_SIDED) != 0u;
    vec3 sum = triangle.corners[0].xyz * corners.weights.x + triangle.corners[1].xyz * corners.weights.y
        + triangle.corners[2].xyz * corners.weights.z;
    vec3 front_ws = is_front ? point.plane_ws : -point.plane_ws;
    vec3 normal = dot(sum, sum) > 0.0 ? normalize(sum) : front_ws;
    if (HAS_TANGENTS != 0u && (material.flags & MATERIAL_NORMAL_TEXTURE) != 0u) {
        TracedTangentsBlock tangent_of = tangents[index];
        if (MOVES != 0u) {
            for (uint corner = 0u; corner < 3u; corner++) {
                vec3 to = closings[index].tangents[corner].xyz;
                tangent_of.corners[corner].xyz = mix(tangent_of.corners[corner].xyz, to, shutter_part);
            }
        }
        vec4 tangent = tangent_of.corners[0] * corners.weights.x + tangent_of.corners[1] * corners.weights.y
            + tangent_of.corners[2] * corners.weights.z;
        if (tangent.xyz != vec3(0.0)) {
            vec3 along = normalize(tangent.xyz);
            vec3 bitangent = cross(normal, along) * tangent.w;
            vec3 mapped = texel_of(traced.normal, corners.uvs, footprint).xyz * 2.0 - 1.0;
            mapped.xy *= material.emissive.a;
            vec3 bent = along * mapped.x + bitangent * mapped.y + normal * mapped.z;
            normal = dot(bent, bent) > 1e-12 ? normalize(bent) : normal;
        }
    }
    point.normal_ws = is_double_sided && !is_front ? -normal : normal;
    vec3 base_color = textured(material.base_color * corners.color, traced.base_color, corners.uvs, footprint).rgb;
    vec4 factors = vec4(1.0, material.roughness, material.metallic, 1.0);
    vec4 metallic_roughness = textured(factors, traced.metallic_roughness, corners.uvs, footprint);
    point.surface = Surface(base_color, metallic_roughness.b, metallic_roughness.g, DEFAULT_DIELECTRIC_F0);
    point.is_unlit = (material.flags & MATERIAL_UNLIT) != 0u;
    point.is_back = !is_front && !is_double_sided;
    if (SURFACE_EXTRAS != 0u) {
        point.surface.dielectric_f0 = f0_of_code((material.flags >> MATERIAL_F0_SHIFT) & 0xffu);
    }
    point.emitted = textured(vec4(material.emissive.rgb, 1.0), traced.emissive, corners.uvs, FINEST).rgb;
    point.emitted = point.is_unlit ? base_color : point.emitted;
    point.emitter_density = traced.emitter_density;
    point.openness = 1.0;
    if (HAS_OCCLUSION != 0u && (material.flags & MATERIAL_OCCLUSION_TEXTURE) != 0u) {
        float strength = float((material.flags >> MATERIAL_OCCLUSION_SHIFT) & 0xffu) / 255.0;
        point.openness += strength * (texel_of(traced.occlusion, corners.uvs, footprint).r - 1.0);
    }
    if (MOVES != 0u) {
        // Chances are by the area when the shutter opens.
        BvhTriangleBlock opening = bvh_triangles[index];
        float area = length(cross(plane.edge1.xyz, plane.edge2.xyz));
        point.emitter_density *= length(cross(opening.edge1.xyz, opening.edge2.xyz)) / max(area, 1e-30);
    }
    return point;
}

#endif
