// Two numbers at a time of the Sobol sequence, Owen-scrambled by a hash. Twin: src/sampling/sobol.rs, to the bit.
#ifndef SAMPLING_SOBOL_GLSL
#define SAMPLING_SOBOL_GLSL

// All bits of `value`, well mixed (the finalizer of MurmurHash3).
uint mixed(uint value) {
    value = (value ^ (value >> 16)) * 0x85ebca6bu;
    value = (value ^ (value >> 13)) * 0xc2b2ae35u;
    return value ^ (value >> 16);
}

// Each bit turned by the bits below it and `seed`: Owen's scrambling of a number whose bits are reversed (Laine and Karras
// 2011, constants of Burley 2020).
uint scrambled_upwards(uint value, uint seed) {
    value += seed;
    value ^= value * 0x6c50b47cu;
    value ^= value * 0xb82f1e52u;
    value ^= value * 0xc7afe638u;
    value ^= value * 0x8d22f6e6u;
    return value;
}

// 0 to 1 without 1, in steps of 2^-24.
float unit_of(uint bits) {
    return float(bits >> 8) * 5.9604644775390625e-8;
}

// Point `index` of the first two dimensions, shuffled and scrambled by `seed`.
vec2 sobol_pair(uint index, uint seed) {
    index = bitfieldReverse(scrambled_upwards(bitfieldReverse(index), mixed(seed)));
    // The second dimension's matrix is Pascal's triangle modulo 2: bit k is the sum of all bits whose place holds k's bits.
    uint second = index;
    second ^= (second >> 1) & 0x55555555u;
    second ^= (second >> 2) & 0x33333333u;
    second ^= (second >> 4) & 0x0f0f0f0fu;
    second ^= (second >> 8) & 0x00ff00ffu;
    second ^= (second >> 16) & 0x0000ffffu;
    uint x = bitfieldReverse(scrambled_upwards(index, mixed(seed ^ 0x68bc21ebu)));
    uint y = bitfieldReverse(scrambled_upwards(second, mixed(seed ^ 0x02e5be93u)));
    return vec2(unit_of(x), unit_of(y));
}

// The seed of a pixel's numbers for one purpose: `pair` counts the pairs that its sample has taken.
uint pair_seed(uint pixel_seed, uint pair) {
    return mixed(pixel_seed ^ mixed(pair + 1u));
}

uint pixel_seed(uvec2 pixel, uint seed) {
    return mixed(pixel.x ^ mixed(pixel.y ^ mixed(seed)));
}

#endif
