// How shaders reach buffers that have an entry a sample, or more: lists and colours, what a reconstruction keeps, a
// compact geometry buffer. Through descriptors, or by the buffers' addresses where one is longer than the device binds
// (--list-access). Written by src/techniques/deep_shading/buffer_addresses.rs.
//
// Included first, as extensions require; each shader says below what it binds which of these it calls.
#ifndef DEEP_SHADING_BUFFER_ADDRESSES_GLSL
#define DEEP_SHADING_BUFFER_ADDRESSES_GLSL
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

// 1: by their addresses.
layout(constant_id = 97) const uint BY_ADDRESS = 0;

// Addresses, low word first; 0 with descriptors, and of what the frame does not have.
struct BufferAddressBlock {
    uvec2 begins;
    uvec2 nodes;
    uvec2 colors;
    uvec2 linear;
    uvec2 addresses;
    uvec2 zmax;
    uvec2 lengths;
    uvec2 pointers;
    uvec2 cache;
    uvec2 entry_places;
    uvec2 entry_normals;
    uvec2 entry_base_colors;
    uvec2 entry_radiances;
    uvec2 sample_colors;
    uvec2 sample_vectors;
    uvec2 layer_means;
    uvec2 entry_order;
};

// Threads of one dispatch read what others wrote.
layout(buffer_reference, std430, buffer_reference_align = 4) coherent buffer Words { uint words[]; };
layout(buffer_reference, std430, buffer_reference_align = 8) coherent buffer Pairs { uvec2 pairs[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Quads { vec4 quads[]; };

// Functions over a buffer of words, pairs or quads that is bound as `name`.
#define READS_WORDS(function, name)                            \
    uint function(uint index) {                                \
        if (BY_ADDRESS != 0u) {                                \
            return Words(buffer_addresses.name).words[index];  \
        }                                                      \
        return name[index];                                    \
    }
#define WRITES_WORDS(function, name)                           \
    void function(uint index, uint word) {                     \
        if (BY_ADDRESS != 0u) {                                \
            Words(buffer_addresses.name).words[index] = word;  \
        } else {                                               \
            name[index] = word;                                \
        }                                                      \
    }
#define LOWERS_WORDS(function, name)                                     \
    void function(uint index, uint word) {                               \
        if (BY_ADDRESS != 0u) {                                          \
            atomicMin(Words(buffer_addresses.name).words[index], word);  \
        } else {                                                         \
            atomicMin(name[index], word);                                \
        }                                                                \
    }
// Returns what was there.
#define SWAPS_WORDS(function, name)                                                            \
    uint function(uint index, uint expected, uint word) {                                      \
        if (BY_ADDRESS != 0u) {                                                                \
            return atomicCompSwap(Words(buffer_addresses.name).words[index], expected, word);  \
        }                                                                                      \
        return atomicCompSwap(name[index], expected, word);                                    \
    }
#define REPLACES_WORDS(function, name)                                        \
    void function(uint index, uint word) {                                    \
        if (BY_ADDRESS != 0u) {                                               \
            atomicExchange(Words(buffer_addresses.name).words[index], word);  \
        } else {                                                              \
            atomicExchange(name[index], word);                                \
        }                                                                     \
    }
#define READS_PAIRS(function, name)                            \
    uvec2 function(uint index) {                               \
        if (BY_ADDRESS != 0u) {                                \
            return Pairs(buffer_addresses.name).pairs[index];  \
        }                                                      \
        return name[index];                                    \
    }
#define WRITES_PAIRS(function, name)                           \
    void function(uint index, uvec2 pair) {                    \
        if (BY_ADDRESS != 0u) {                                \
            Pairs(buffer_addresses.name).pairs[index] = pair;  \
        } else {                                               \
            name[index] = pair;                                \
        }                                                      \
    }
// The second of a pair alone.
#define WRITES_SECONDS(function, name)                           \
    void function(uint index, uint word) {                       \
        if (BY_ADDRESS != 0u) {                                  \
            Pairs(buffer_addresses.name).pairs[index].y = word;  \
        } else {                                                 \
            name[index].y = word;                                \
        }                                                        \
    }
#define READS_QUADS(function, name)                            \
    vec4 function(uint index) {                                \
        if (BY_ADDRESS != 0u) {                                \
            return Quads(buffer_addresses.name).quads[index];  \
        }                                                      \
        return name[index];                                    \
    }
#define WRITES_QUADS(function, name)                           \
    void function(uint index, vec4 quad) {                     \
        if (BY_ADDRESS != 0u) {                                \
            Quads(buffer_addresses.name).quads[index] = quad;  \
        } else {                                               \
            name[index] = quad;                                \
        }                                                      \
    }

#endif
