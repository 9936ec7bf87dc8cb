// A texel of a triangle's level, drawn by hull.vert, and its place on the triangle. After place.glsl and atlas.glsl.
#ifndef DEEP_SHADING_TEXEL_GLSL
#define DEEP_SHADING_TEXEL_GLSL

layout(location = 0) flat in uint in_triangle;
layout(location = 1) flat in uint in_level;

uvec2 texel_at() {
    return uvec2(gl_FragCoord.xy);
}

// What is drawn reaches over the rim.
bool is_texel() {
    return all(lessThan(texel_at(), uvec2(level_side(in_level))));
}

// The texel's middle on the triangle, or the triangle's place nearest to it, with rates of a texel. `charted` are its corners.
Place texel_place(Charted charted) {
    vec2 at[3] = charted.corners;
    return place_at(
        vec4(at[0], 0.0, 1.0), vec4(at[1], 0.0, 1.0), vec4(at[2], 0.0, 1.0), vec2(texel_at()) + 0.5);
}

#endif
