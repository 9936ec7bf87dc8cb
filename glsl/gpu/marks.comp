// Marks of what a frame reads and writes in buffers and images, and how many bytes it asks for. The functions below are grafted into
// every shader of a device that counts (src/spirv/graft.rs); `main` only keeps them in the module. Parameters are const, which are passed as
// values and not as pointers. Host: src/gpu/marks/mod.rs.
//
// Each set has slots, one a binding, which say where a resource's record lies: bytes read (two words), bytes written (two words), a bit a
// granule that is read, a bit a granule that is written.
// variants: SETS=own|both
#version 460

// What a binding leads to.
struct MarkSlotBlock {
    // Words from the beginning of all marks to the record.
    uint record;
    // Words of marks of reads, and as many of writes.
    uint word_count;
    // Bytes of a buffer, of an image those of a texel; 0: nothing is counted.
    uint bytes;
    // log2 of a buffer's granule, bytes; of an image log2 of the texels across it, and of those down times 256.
    uint granule;
    // Texels of the finest level.
    uint width;
    uint height;
    // Layers times samples, or slices.
    uint layers;
    uint levels;
    uint samples;
    // How coordinates beyond an edge are read, across and, times 16, down and, times 256, to the back: MARK_REPEAT and so on.
    uint wraps;
    // MARK_MAGNIFIES_LINEARLY and so on.
    uint filters;
    float least_level;
    float most_level;
};

// Words before a set's slots, the first of which says how far from the beginning of all marks it lies. Slot 0 counts nothing, and
// after it comes one a binding, then one a vertex stream.
const uint MARK_SLOTS = 4u;
const uint MARK_SLOT_WORDS = 13u;
// Words from the beginning of all marks to buffers with addresses: how many, then MARK_ADDRESS_WORDS for each: address (low word first),
// bytes, record, words of marks, log2 of a granule.
const uint MARK_ADDRESSES = 2097152u;
const uint MARK_ADDRESS_WORDS = 6u;
const uint MARK_MOST_ADDRESSES = 128u;
// Words from the beginning of all marks to how many invocations there were, in two words: behind the buffers with addresses.
const uint MARK_INVOCATIONS = 2097921u;
// Words of a record before its marks.
const uint MARK_COUNTS = 4u;
const uint MARK_REPEAT = 0u;
const uint MARK_MIRROR = 1u;
const uint MARK_EDGE = 2u;
const uint MARK_MAGNIFIES_LINEARLY = 1u;
const uint MARK_MINIFIES_LINEARLY = 2u;
const uint MARK_BLENDS_LEVELS = 4u;
// What `where` has beside the slot's number in the set of the material.
const uint MARK_IN_MATERIAL = 256u;

layout(local_size_x = 1) in;
layout(std430, set = 0, binding = 63) buffer Marks { uint words[]; } marks;
#if defined(SETS_BOTH)
layout(std430, set = 1, binding = 63) readonly buffer MaterialMarks { uint words[]; } material_marks;
#endif

uint slot_word(const uint where, const uint index) {
    uint at = MARK_SLOTS + (where & 255u) * MARK_SLOT_WORDS + index;
#if defined(SETS_BOTH)
    if ((where & MARK_IN_MATERIAL) != 0u) {
        return material_marks.words[at];
    }
#endif
    return marks.words[at];
}

MarkSlotBlock slot_of(const uint where) {
    MarkSlotBlock slot;
    slot.record = slot_word(where, 0u) - marks.words[0];
    slot.word_count = slot_word(where, 1u);
    slot.bytes = slot_word(where, 2u);
    slot.granule = slot_word(where, 3u);
    slot.width = slot_word(where, 4u);
    slot.height = slot_word(where, 5u);
    slot.layers = slot_word(where, 6u);
    slot.levels = slot_word(where, 7u);
    slot.samples = slot_word(where, 8u);
    slot.wraps = slot_word(where, 9u);
    slot.filters = slot_word(where, 10u);
    slot.least_level = uintBitsToFloat(slot_word(where, 11u));
    slot.most_level = uintBitsToFloat(slot_word(where, 12u));
    return slot;
}

// Adds `bytes` to what is counted at `at` in two words.
void add(const uint at, const uint bytes) {
    uint before = atomicAdd(marks.words[at], bytes);
    if (before + bytes < before) {
        atomicAdd(marks.words[at + 1u], 1u);
    }
}

// Marks granules from `first` to `last`. `at`: the first word of the marks.
void mark(const uint at, const uint first, const uint last) {
    for (uint word = first >> 5; word <= last >> 5; ++word) {
        uint low = word == first >> 5 ? first & 31u : 0u;
        uint high = word == last >> 5 ? last & 31u : 31u;
        uint bits = (0xffffffffu << low) & (0xffffffffu >> (31u - high));
        // Most have their mark already.
        if ((marks.words[at + word] & bits) != bits) {
            atomicOr(marks.words[at + word], bits);
        }
    }
}

// `size` bytes from `offset` on of a buffer of `bytes`. `writes`: 0 for a read, 1 for a write.
void mark_range(const uint record, const uint word_count, const uint bytes, const uint granule, const uint offset, const uint size, const uint writes) {
    // What lies beyond the end is no memory of the buffer's.
    if (offset >= bytes) {
        return;
    }
    uint counted = min(size, bytes - offset);
    add(record + 2u * writes, counted);
    mark(record + MARK_COUNTS + writes * word_count, offset >> granule, (offset + counted - 1u) >> granule);
}

void mark_bytes(const uint where, const uint offset, const uint size, const uint writes) {
    MarkSlotBlock slot = slot_of(where);
    mark_range(slot.record, slot.word_count, slot.bytes, slot.granule, offset, size, writes);
}

// The same of a buffer that is reached by its address.
void mark_address(const uvec2 address, const uint offset, const uint size, const uint writes) {
    uint table = MARK_ADDRESSES - marks.words[0];
    uint count = marks.words[table];
    for (uint index = 0u; index < count; ++index) {
        uint at = table + 1u + index * MARK_ADDRESS_WORDS;
        uint borrow;
        uint low = usubBorrow(address.x, marks.words[at], borrow);
        uint high = address.y - marks.words[at + 1u] - borrow;
        uint bytes = marks.words[at + 2u];
        if (high == 0u && low < bytes) {
            uint record = marks.words[at + 3u] - marks.words[0];
            mark_range(record, marks.words[at + 4u], bytes, marks.words[at + 5u], low + offset, size, writes);
            return;
        }
    }
}

uvec2 level_texels(const MarkSlotBlock slot, const uint level) {
    return max(uvec2(slot.width, slot.height) >> level, uvec2(1));
}

uvec2 level_granules(const MarkSlotBlock slot, const uint level) {
    uvec2 shift = uvec2(slot.granule & 255u, slot.granule >> 8);
    return (level_texels(slot, level) + (uvec2(1) << shift) - 1u) >> shift;
}

void mark_texel_of(const MarkSlotBlock slot, const uvec3 texel, const uint level, const uint writes) {
    if (slot.bytes == 0u || level >= slot.levels || texel.z >= slot.layers
        || any(greaterThanEqual(texel.xy, level_texels(slot, level)))) {
        return;
    }
    uint begin = 0u;
    for (uint finer = 0u; finer < level; ++finer) {
        uvec2 granules = level_granules(slot, finer);
        begin += granules.x * granules.y * slot.layers;
    }
    uvec2 granules = level_granules(slot, level);
    uvec2 place = texel.xy >> uvec2(slot.granule & 255u, slot.granule >> 8);
    uint granule = begin + (texel.z * granules.y + place.y) * granules.x + place.x;
    add(slot.record + 2u * writes, slot.bytes);
    mark(slot.record + MARK_COUNTS + writes * slot.word_count, granule, granule);
}

// One texel, of layer or slice `texel.z`, and of one of its samples.
void mark_texel(const uint where, const uvec3 texel, const uint level, const uint one_sample, const uint writes) {
    MarkSlotBlock slot = slot_of(where);
    mark_texel_of(slot, uvec3(texel.xy, texel.z * max(slot.samples, 1u) + one_sample), level, writes);
}

// Where a texel beyond an edge is read.
uint wrapped(const int at, const uint size, const uint wrap) {
    int side = int(size);
    if (wrap == MARK_EDGE) {
        return uint(clamp(at, 0, side - 1));
    }
    int period = wrap == MARK_MIRROR ? 2 * side : side;
    int inside = at - period * int(floor(float(at) / float(period)));
    inside = clamp(inside, 0, period - 1);
    return uint(inside < side ? inside : period - 1 - inside);
}

// The texels of one level that a look-up at `place` reads. `is_flat`: `place.z` is a layer, else it is filtered as the others are.
void mark_footprint(const MarkSlotBlock slot, const vec3 place, const bool is_flat, const uint level, const bool is_linear) {
    uvec2 size = level_texels(slot, level);
    vec3 texels = vec3(place.xy * vec2(size), is_flat ? place.z : place.z * float(slot.layers));
    ivec3 first = ivec3(floor(is_linear ? texels - 0.5 : texels));
    ivec3 count = ivec3(is_linear ? 2 : 1);
    if (is_flat) {
        first.z = int(clamp(round(place.z), 0.0, float(slot.layers) - 1.0));
        count.z = 1;
    }
    for (int index = 0; index < count.x * count.y * count.z; ++index) {
        ivec3 at = first + ivec3(index % count.x, (index / count.x) % count.y, index / (count.x * count.y));
        uvec3 texel = uvec3(
            wrapped(at.x, size.x, slot.wraps & 15u),
            wrapped(at.y, size.y, (slot.wraps >> 4) & 15u),
            is_flat ? uint(at.z) : wrapped(at.z, slot.layers, slot.wraps >> 8)
        );
        mark_texel_of(slot, texel, level, 0u);
    }
}

// Face, and place on it, of a direction.
vec3 on_face(const vec3 direction) {
    vec3 size = abs(direction);
    float axis;
    vec2 place;
    float face;
    if (size.z >= size.x && size.z >= size.y) {
        axis = size.z;
        face = direction.z < 0.0 ? 5.0 : 4.0;
        place = vec2(direction.z < 0.0 ? -direction.x : direction.x, -direction.y);
    } else if (size.y >= size.x) {
        axis = size.y;
        face = direction.y < 0.0 ? 3.0 : 2.0;
        place = vec2(direction.x, direction.y < 0.0 ? -direction.z : direction.z);
    } else {
        axis = size.x;
        face = direction.x < 0.0 ? 1.0 : 0.0;
        place = vec2(direction.x < 0.0 ? direction.z : -direction.z, -direction.y);
    }
    return vec3(0.5 * place / axis + 0.5, face);
}

// What a sampler reads at `place`. `kind`: 0 flat, of layer `place.z`; 1 three-dimensional; 2 a cube, at a direction.
void mark_sampled(const uint where, const vec3 place, const uint kind, const float level) {
    MarkSlotBlock slot = slot_of(where);
    if (slot.bytes == 0u) {
        return;
    }
    vec3 at = kind == 2u ? on_face(place) : place;
    float clamped = clamp(level, slot.least_level, slot.most_level);
    float coarsest = float(slot.levels - 1u);
    if (clamped <= 0.0) {
        mark_footprint(slot, at, kind != 1u, 0u, (slot.filters & MARK_MAGNIFIES_LINEARLY) != 0u);
        return;
    }
    bool is_linear = (slot.filters & MARK_MINIFIES_LINEARLY) != 0u;
    clamped = min(clamped, coarsest);
    if ((slot.filters & MARK_BLENDS_LEVELS) == 0u) {
        mark_footprint(slot, at, kind != 1u, uint(max(ceil(clamped + 0.5) - 1.0, 0.0)), is_linear);
        return;
    }
    mark_footprint(slot, at, kind != 1u, uint(clamped), is_linear);
    if (fract(clamped) > 0.0) {
        mark_footprint(slot, at, kind != 1u, uint(clamped) + 1u, is_linear);
    }
}

// The same by how `place` changes from a pixel to the next.
void mark_gradients(const uint where, const vec3 place, const uint kind, const vec2 across, const vec2 down) {
    vec2 size = vec2(slot_word(where, 4u), slot_word(where, 5u));
    float span = max(length(across * size), length(down * size));
    mark_sampled(where, place, kind, span > 0.0 ? log2(span) : -128.0);
}

// The four texels of the finest level around `place`.
void mark_gathered(const uint where, const vec3 place) {
    MarkSlotBlock slot = slot_of(where);
    mark_footprint(slot, place, true, 0u, true);
}

// The invocation that calls it is one of those that do a pass's work: it computes, or shades a fragment.
void mark_invocation() {
    add(MARK_INVOCATIONS - marks.words[0], 1u);
}

void main() {
    mark_invocation();
    mark_bytes(0u, 0u, 4u, 0u);
    mark_address(uvec2(0), 0u, 4u, 0u);
    mark_texel(0u, uvec3(0), 0u, 0u, 0u);
    mark_gradients(0u, vec3(0.0), 0u, vec2(0.0), vec2(0.0));
    mark_gathered(0u, vec3(0.0));
}
