// Triangles as they are, each into its tuple's layer: for devices whose vertex shaders cannot say which that is (section
// 4.2, Interleave-Instancing). Pass: src/techniques/deep_shading/visibility/layer.rs.
// variants: VERTEX=plain|extended VERTICES=fetched|indexed
#version 460

layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;

// As sample.vert has them.
layout(location = 0) in vec4 in_canonical[];
layout(location = 3) in vec2 in_uv[];
layout(location = 6) flat in uint in_tuple[];

layout(location = 0) out vec4 out_canonical;
layout(location = 3) out vec2 out_uv;
layout(location = 6) flat out uint out_tuple;

#ifdef VERTICES_FETCHED
layout(location = 1) flat in uint in_primitive[];
layout(location = 1) flat out uint out_primitive;
#endif
#ifdef VERTEX_EXTENDED
layout(location = 4) in vec4 in_color[];
layout(location = 5) in vec2 in_uv_1[];
layout(location = 4) out vec4 out_color;
layout(location = 5) out vec2 out_uv_1;
#endif

void main() {
    for (uint index = 0u; index < 3u; index++) {
        gl_Position = gl_in[index].gl_Position;
        gl_Layer = int(in_tuple[0]);
        out_canonical = in_canonical[index];
#ifdef VERTICES_FETCHED
        out_primitive = in_primitive[0];
#else
        gl_PrimitiveID = gl_PrimitiveIDIn;
#endif
        out_uv = in_uv[index];
#ifdef VERTEX_EXTENDED
        out_color = in_color[index];
        out_uv_1 = in_uv_1[index];
#endif
        out_tuple = in_tuple[0];
        EmitVertex();
    }
    EndPrimitive();
}
