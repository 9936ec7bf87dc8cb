// Bits whose every bit depends on all of those given: numbers that seem to be random, and sums that distinguish sets.
#ifndef DEEP_SHADING_MIXED_GLSL
#define DEEP_SHADING_MIXED_GLSL

uint mixed(uint bits) {
    bits = (bits ^ (bits >> 15)) * 0x2c1b3c6du;
    bits = (bits ^ (bits >> 12)) * 0x297a2d39u;
    return bits ^ (bits >> 15);
}

#endif
