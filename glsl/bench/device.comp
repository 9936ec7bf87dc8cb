// What a device does with memory and nothing else: what `bench device` times. Pass: src/bench/device/mod.rs.
//
// read, write and both (a copy) touch every sixteen bytes of a buffer once; stride reads words so far apart, random words in no order; atomic adds to
// one counter of a few. What is read is compared with a word that nobody wrote, so that no compiler leaves it out.
// variants: KIND=read|write|both|stride|random|atomic
#version 460

struct DeviceParams {
    // Invocations that do something.
    uint count;
    // Words of the source, or counters, less one: their number is a power of two.
    uint mask;
    // Words from one that is read to the next.
    uint stride;
};

const uint DEVICE_THREADS = 256u;
// Elements of sixteen bytes that an invocation touches.
const uint DEVICE_RUN = 4u;
// The word that is sought.
const uint DEVICE_SOUGHT = 0x9e3779b9u;

layout(local_size_x = DEVICE_THREADS) in;
layout(push_constant) uniform Push { DeviceParams params; };

#if defined(KIND_READ) || defined(KIND_BOTH)
layout(std430, set = 0, binding = 0) readonly buffer Source { uvec4 element[]; } source;
#elif defined(KIND_STRIDE) || defined(KIND_RANDOM)
layout(std430, set = 0, binding = 0) readonly buffer Source { uint word[]; } source;
#endif
#if defined(KIND_WRITE) || defined(KIND_BOTH)
layout(std430, set = 0, binding = 1) writeonly buffer Target { uvec4 element[]; } target;
#elif defined(KIND_ATOMIC)
layout(std430, set = 0, binding = 1) buffer Target { uint word[]; } target;
#else
layout(std430, set = 0, binding = 1) writeonly buffer Target { uint word[]; } target;
#endif

#if defined(KIND_RANDOM)
// A permutation of 32 bits (Wang 2007), so that places are even and no two neighbours are.
uint scattered(uint index) {
    index = (index ^ 61u) ^ (index >> 16u);
    index *= 9u;
    index ^= index >> 4u;
    index *= 0x27d4eb2du;
    return index ^ (index >> 15u);
}
#endif

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= params.count) {
        return;
    }
#if defined(KIND_READ)
    uvec4 all = uvec4(0u);
    for (uint step = 0u; step < DEVICE_RUN; step++) {
        all |= source.element[index + step * params.count];
    }
    if (all.x == DEVICE_SOUGHT && all.y == all.x && all.z == all.x && all.w == all.x) {
        target.word[0] = 1u;
    }
#elif defined(KIND_WRITE)
    for (uint step = 0u; step < DEVICE_RUN; step++) {
        uint at = index + step * params.count;
        target.element[at] = uvec4(at, 1u, 2u, 3u);
    }
#elif defined(KIND_BOTH)
    for (uint step = 0u; step < DEVICE_RUN; step++) {
        uint at = index + step * params.count;
        target.element[at] = source.element[at];
    }
#elif defined(KIND_STRIDE)
    if (source.word[(index * params.stride) & params.mask] == DEVICE_SOUGHT) {
        target.word[0] = 1u;
    }
#elif defined(KIND_RANDOM)
    if (source.word[scattered(index) & params.mask] == DEVICE_SOUGHT) {
        target.word[0] = 1u;
    }
#else
    atomicAdd(target.word[index & params.mask], 1u);
#endif
}
