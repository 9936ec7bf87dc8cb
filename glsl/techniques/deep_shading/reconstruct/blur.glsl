// How far the lens and motion have spread what a sample sees, and how far its colour may be spread in turn: the filter of
// a surface is a part as wide as its blur, whose picture has no detail finer than that (reconstruct/mod.rs).
#ifndef DEEP_SHADING_RECONSTRUCT_BLUR_GLSL
#define DEEP_SHADING_RECONSTRUCT_BLUR_GLSL

// The filter's standard deviation over that of a circle of confusion, with PART_SAMPLES samples a pixel. Larger takes more noise
// away and more of the picture.
const float LENS_PART = 0.35;
// And over that of a way, along which a thing thins out towards both ends; a wide filter brightens these: at 0.15 and 0.2 the
// truck of glTF's samples has an HDR-FLIP of 0.0244 and 0.0249, unfiltered 0.0242.
const float WAY_PART = 0.15;
// More samples have less noise, and narrower filters for it, which begin at wider blur: of 32, those of 8 raise the HDR-FLIP of VC
// from 0.0499 to 0.0506 and narrower ones lower it to 0.0498.
const float PART_SAMPLES = 8.0;
// A blur of this radius, with PART_SAMPLES samples, stays within a pixel, whose own samples have it already.
const float SHARP_PX = 0.5;
// A way up to this length is left to a pixel's own samples, too: at 1, 1.5 and 2 a box that moves has an HDR-FLIP of 0.0125, 0.0120 and
// 0.0117, unfiltered 0.0117.
const float SHARP_WAY_PX = 2.0;
// Greatest radius: filters look no farther than from tile to tile.
const float MOST_RADIUS_PX = 15.9;
// Pixels of a tile's side.
const uint TILE_PX = 16u;
// Layers of a tile.
const uint LAYER_COUNT = 4u;
// What a sample that sees nothing has for its depth, metres.
const float NO_DEPTH = 3.0e38;
// What blurs more is held at this, pixels.
const float MOST_BLUR_PX = 2048.0;

// A tile's layers, from front to back, and how far filters reach in it and around it.
struct TileBlock {
    // Where the second, third and fourth begin, metres before the eye.
    vec4 begins;
    // Their mean supports, as support_of.
    vec4 first;
    vec4 second;
    vec4 third;
    vec4 fourth;
    uint reach_x_px;
    uint reach_y_px;
    uint _unused[2];
};

struct Blur {
    // Radius of the circle of confusion, pixels of the frame; below 0 before the plane in focus.
    float circle_px;
    // From the shutter's opening to its closing, pixels of the frame.
    vec2 motion_px;
    // Metres before the eye.
    float depth;
};

// Where samples lie in buffers that have one entry each: all first ones of the frame's pixels, row by row, then all second ones.
uint entry_of(uvec2 frame_px, uvec2 pixel, uint index) {
    return (index * frame_px.y + pixel.y) * frame_px.x + pixel.x;
}

// The tile that a pixel of the frame lies in.
uint tile_under(uvec2 frame_px, uvec2 pixel) {
    return pixel.y / TILE_PX * ((frame_px.x + TILE_PX - 1u) / TILE_PX) + pixel.x / TILE_PX;
}

uvec2 packed_colors(vec3 color, Blur blur) {
    return uvec2(packHalf2x16(color.rg), packHalf2x16(vec2(color.b, blur.circle_px)));
}

uvec2 packed_vectors(Blur blur) {
    return uvec2(packHalf2x16(blur.motion_px), floatBitsToUint(blur.depth));
}

vec3 radiance_of(uvec2 colors) {
    return vec3(unpackHalf2x16(colors.x), unpackHalf2x16(colors.y).x);
}

Blur blur_of(uvec2 colors, uvec2 vectors) {
    return Blur(unpackHalf2x16(colors.y).y, unpackHalf2x16(vectors.x), uintBitsToFloat(vectors.y));
}

// How wide filters are for what is blurred.
struct Parts {
    float lens;
    float way;
    // Radius of the circles of confusion that are not filtered.
    float sharp_px;
};

Parts parts_of(uint sample_count) {
    float few = min(sqrt(PART_SAMPLES / float(sample_count)), 1.0);
    return Parts(LENS_PART * sqrt(few), WAY_PART * few, SHARP_PX / few);
}

// The ellipse that a filter ends at, as a symmetric matrix (xx, xy, yy): d is inside where its square by the inverse is below 1.
// The unit circle: no other pixel's middle is inside.
//
// The blur's variance is a quarter of its radius squared on each axis, and along its way a twelfth of its length squared; the
// filter's an eighth of its radius squared.
vec3 support_of(Blur blur, Parts parts) {
    float circle = max(abs(blur.circle_px) - parts.sharp_px, 0.0);
    float way = length(blur.motion_px);
    vec2 moved = way > SHARP_WAY_PX ? blur.motion_px * ((way - SHARP_WAY_PX) / way) : vec2(0.0);
    float round_part = 2.0 * circle * circle;
    vec3 wide = parts.lens * parts.lens * vec3(round_part, 0.0, round_part) +
                parts.way * parts.way * 2.0 / 3.0 * vec3(moved.x * moved.x, moved.x * moved.y, moved.y * moved.y);
    float most = MOST_RADIUS_PX * MOST_RADIUS_PX - 1.0;
    // The longer axis, squared.
    float longest = 0.5 * (wide.x + wide.z) + length(vec2(0.5 * (wide.x - wide.z), wide.y));
    return vec3(1.0, 0.0, 1.0) + wide * (longest > most ? most / longest : 1.0);
}

float determinant_of(vec3 support) {
    return support.x * support.z - support.y * support.y;
}

// Weight of a pixel that is `d` away: 1 at 0, and 0 from the support's rim on, where it is smooth.
float weight_at(vec3 support, vec2 d) {
    float square = dot(vec3(support.z, -2.0 * support.y, support.x), vec3(d.x * d.x, d.x * d.y, d.y * d.y));
    float left = max(1.0 - square / determinant_of(support), 0.0);
    return left * left;
}

uint layer_of(TileBlock tile, float depth) {
    return uint(depth >= tile.begins.x) + uint(depth >= tile.begins.y) + uint(depth >= tile.begins.z);
}

#endif
