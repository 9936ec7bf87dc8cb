// What is nearest to each sample, where triangles are drawn over all samples of a pixel at once: 64 bits, whose greatest value is
// the nearest surface, and of those equally near the one that was drawn first, as a depth test has it. 0: nothing, and so is
// what lies on the far plane.
#ifndef DEEP_SHADING_NEAREST_GLSL
#define DEEP_SHADING_NEAREST_GLSL

// Low word first. `depth`: reversed, above 0, so that its bits grow with it; `order`: the triangle's number in the order of draws.
uvec2 nearest_words(float depth, uint order) {
    return uvec2(~order, floatBitsToUint(depth));
}

bool is_nothing(uvec2 words) {
    return words.y == 0u;
}

// That number, where something is nearest.
uint nearest_order(uvec2 words) {
    return ~words.x;
}

#endif
