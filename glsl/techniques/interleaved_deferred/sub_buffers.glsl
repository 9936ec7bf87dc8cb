// Texels of sub-buffers, and of the block layout between two passes, as copies and shading read and write them.
//
// The including shader has the axis STORAGE, and says before the include what it reads and writes: READS_SURFACE and
// WRITES_SURFACE (position and normal; axis POSITION; with COLOR=on, and where VPL_BRDF=ggx reads it, colour too),
// READS_IRRADIANCE and WRITES_IRRADIANCE.
//   buffer  storage buffers; sub-buffers one after the other
//   image   written as storage images, read as sampled ones; sub-buffers tiled side by side (Segovia 2006, figure 3)
//   layers  the same, an array layer for each sub-buffer
// A copy (axis COPY) moves RUN neighbouring texels a thread, two where they lie in buffers: neighbours of those that it
// writes (pull), whose words go out together, or of those that it reads (push).
#ifndef INTERLEAVED_DEFERRED_SUB_BUFFERS_GLSL
#define INTERLEAVED_DEFERRED_SUB_BUFFERS_GLSL

#include "techniques/interleaved_deferred/mapping.glsl"

#if defined(STORAGE_BUFFER)
#define PLACE uint
PLACE place_of_texel(MappingParams mapping, uvec3 texel) {
    return linear_of(mapping, texel);
}
PLACE place_of_block_texel(MappingParams mapping, uvec2 at) {
    return at.y * padded_of(mapping).x + at.x;
}
#elif defined(STORAGE_IMAGE)
#define PLACE ivec2
#define SAMPLED usampler2D
#define STORED uimage2D
PLACE place_of_texel(MappingParams mapping, uvec3 texel) {
    return ivec2(tiled_of(mapping, texel));
}
PLACE place_of_block_texel(MappingParams mapping, uvec2 at) {
    return ivec2(at);
}
#else
#define PLACE ivec3
#define SAMPLED usampler2DArray
#define STORED uimage2DArray
PLACE place_of_texel(MappingParams mapping, uvec3 texel) {
    return ivec3(texel);
}
#endif

#if defined(STORAGE_BUFFER) && (defined(COPY_PULL) || defined(COPY_PUSH))
const uint RUN = 2u;
#else
const uint RUN = 1u;
#endif

#if defined(STORAGE_BUFFER) && defined(COPY_PULL)
#define STORES_RUNS
#endif

#if defined(COLOR_ON) || defined(VPL_BRDF_GGX)
#define HAS_COLOR
#endif

#if defined(READS_SURFACE) || defined(WRITES_SURFACE)
// What shading needs of a pixel, packed as in the G-buffer; `color`: as color_words of material_of_frame.glsl.
struct SurfaceTexel {
    POSITION_WORDS position;
    uvec2 normal;
#ifdef HAS_COLOR
    uvec2 color;
#endif
};

#if defined(POSITION_FLOAT)
#define POSITION_FORMAT rgba32ui
#define POSITION_OF(fetched) fetched
#define POSITION_TEXEL(words) words
#elif defined(POSITION_DEPTH)
#define POSITION_FORMAT r32ui
#define POSITION_OF(fetched) fetched.r
#define POSITION_TEXEL(words) uvec4(words, 0u, 0u, 0u)
#define POSITION_RUN uvec2
#else
#define POSITION_FORMAT rg32ui
#define POSITION_OF(fetched) fetched.rg
#define POSITION_TEXEL(words) uvec4(words, 0u, 0u)
#define POSITION_RUN uvec4
#endif
#endif

#ifdef READS_SURFACE
#ifdef STORAGE_BUFFER
layout(std430, set = 0, binding = 10) readonly buffer SourcePosition { POSITION_WORDS texel[]; } source_position;
layout(std430, set = 0, binding = 11) readonly buffer SourceNormal { uvec2 texel[]; } source_normal;

POSITION_WORDS load_position(PLACE place) {
    return source_position.texel[place];
}

uvec2 load_normal(PLACE place) {
    return source_normal.texel[place];
}

#ifdef HAS_COLOR
layout(std430, set = 0, binding = 18) readonly buffer SourceColor { uvec2 texel[]; } source_color;

uvec2 load_color(PLACE place) {
    return source_color.texel[place];
}
#endif
#else
layout(set = 0, binding = 10) uniform SAMPLED source_position;
layout(set = 0, binding = 11) uniform SAMPLED source_normal;

POSITION_WORDS load_position(PLACE place) {
    return POSITION_OF(texelFetch(source_position, place, 0));
}

uvec2 load_normal(PLACE place) {
    return texelFetch(source_normal, place, 0).rg;
}

#ifdef HAS_COLOR
layout(set = 0, binding = 18) uniform SAMPLED source_color;

uvec2 load_color(PLACE place) {
    return texelFetch(source_color, place, 0).rg;
}
#endif
#endif

SurfaceTexel load_surface(PLACE place) {
    SurfaceTexel texel;
    texel.position = load_position(place);
    texel.normal = load_normal(place);
#ifdef HAS_COLOR
    texel.color = load_color(place);
#endif
    return texel;
}
#endif

#ifdef WRITES_SURFACE
#if defined(STORES_RUNS)
#ifdef POSITION_RUN
layout(std430, set = 0, binding = 12) writeonly buffer TargetPosition { POSITION_RUN run[]; } target_position;
#else
layout(std430, set = 0, binding = 12) writeonly buffer TargetPosition { POSITION_WORDS texel[]; } target_position;
#endif
layout(std430, set = 0, binding = 13) writeonly buffer TargetNormal { uvec4 run[]; } target_normal;
#ifdef HAS_COLOR
layout(std430, set = 0, binding = 19) writeonly buffer TargetColor { uvec4 run[]; } target_color;
#endif

void store_surfaces(PLACE first, SurfaceTexel run[RUN]) {
#ifdef POSITION_RUN
    target_position.run[first / 2u] = POSITION_RUN(run[0].position, run[1].position);
#else
    target_position.texel[first] = run[0].position;
    target_position.texel[first + 1u] = run[1].position;
#endif
    target_normal.run[first / 2u] = uvec4(run[0].normal, run[1].normal);
#ifdef HAS_COLOR
    target_color.run[first / 2u] = uvec4(run[0].color, run[1].color);
#endif
}
#else
#ifdef STORAGE_BUFFER
layout(std430, set = 0, binding = 12) writeonly buffer TargetPosition { POSITION_WORDS texel[]; } target_position;
layout(std430, set = 0, binding = 13) writeonly buffer TargetNormal { uvec2 texel[]; } target_normal;
#ifdef HAS_COLOR
layout(std430, set = 0, binding = 19) writeonly buffer TargetColor { uvec2 texel[]; } target_color;
#endif

void store_surface(PLACE place, SurfaceTexel texel) {
    target_position.texel[place] = texel.position;
    target_normal.texel[place] = texel.normal;
#ifdef HAS_COLOR
    target_color.texel[place] = texel.color;
#endif
}
#else
layout(POSITION_FORMAT, set = 0, binding = 12) writeonly uniform STORED target_position;
layout(rg32ui, set = 0, binding = 13) writeonly uniform STORED target_normal;
#ifdef HAS_COLOR
layout(rg32ui, set = 0, binding = 19) writeonly uniform STORED target_color;
#endif

void store_surface(PLACE place, SurfaceTexel texel) {
    imageStore(target_position, place, POSITION_TEXEL(texel.position));
    imageStore(target_normal, place, uvec4(texel.normal, 0u, 0u));
#ifdef HAS_COLOR
    imageStore(target_color, place, uvec4(texel.color, 0u, 0u));
#endif
}
#endif

void store_surfaces(PLACE first, SurfaceTexel run[1]) {
    store_surface(first, run[0]);
}
#endif
#endif

#ifdef READS_IRRADIANCE
#ifdef STORAGE_BUFFER
layout(std430, set = 0, binding = 14) readonly buffer SourceIrradiance { uvec2 texel[]; } source_irradiance;

uvec2 load_irradiance(PLACE place) {
    return source_irradiance.texel[place];
}
#else
layout(set = 0, binding = 14) uniform SAMPLED source_irradiance;

uvec2 load_irradiance(PLACE place) {
    return texelFetch(source_irradiance, place, 0).rg;
}
#endif
#endif

#ifdef WRITES_IRRADIANCE
#ifdef STORES_RUNS
layout(std430, set = 0, binding = 15) writeonly buffer TargetIrradiance { uvec4 run[]; } target_irradiance;

void store_irradiances(PLACE first, uvec2 run[RUN]) {
    target_irradiance.run[first / 2u] = uvec4(run[0], run[1]);
}
#else
#ifdef STORAGE_BUFFER
layout(std430, set = 0, binding = 15) writeonly buffer TargetIrradiance { uvec2 texel[]; } target_irradiance;

void store_irradiance(PLACE place, uvec2 words) {
    target_irradiance.texel[place] = words;
}
#else
layout(rg32ui, set = 0, binding = 15) writeonly uniform STORED target_irradiance;

void store_irradiance(PLACE place, uvec2 words) {
    imageStore(target_irradiance, place, uvec4(words, 0u, 0u));
}
#endif

void store_irradiances(PLACE first, uvec2 run[1]) {
    store_irradiance(first, run[0]);
}
#endif
#endif

#endif
