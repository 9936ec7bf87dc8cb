// What a fragment of a polygon around a triangle's blur knows of the triangle: its corners at both ends of the exposure, from which
// the fragment places them as each of its samples sees them (section 4.2).
//
// After seen.glsl.
#ifndef DEEP_SHADING_POLYGON_IN_GLSL
#define DEEP_SHADING_POLYGON_IN_GLSL

// As polygon_out.glsl and msaa.vert write them.
layout(location = 1) flat in uint in_primitive;
layout(location = 2) flat in vec4 in_open[3];
layout(location = 5) flat in vec4 in_close[3];
layout(location = 8) flat in vec3 in_open_depth;
layout(location = 9) flat in vec3 in_close_depth;

Seen open_corner(uint corner) {
    return Seen(in_open[corner], in_open_depth[corner]);
}

Seen close_corner(uint corner) {
    return Seen(in_close[corner], in_close_depth[corner]);
}

#endif
