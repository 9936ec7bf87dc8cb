// Tiles of the frame and their light masks: one bit a light, in the lights' order.
#ifndef LIGHTS_CULL_GLSL
#define LIGHTS_CULL_GLSL

const uint TILE_PX = 16u;

uint tile_of(uvec2 pixel, uint width_px) {
    uint tiles_x = (width_px + TILE_PX - 1u) / TILE_PX;
    return pixel.y / TILE_PX * tiles_x + pixel.x / TILE_PX;
}

#endif
