// Each sample an entry of its own: without lists (--lists none), the plain way to the picture.
// Pass: src/techniques/deep_shading/entries/samples.rs.
#version 460
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "techniques/deep_shading/space.glsl"
#include "techniques/deep_shading/entries/waiting.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 2) readonly buffer Deep { DeepBlock deep; };
layout(set = 0, binding = 27) uniform usampler2DArray spids;
layout(std430, set = 0, binding = 22) writeonly buffer Colors { uvec2 colors[]; };
layout(std430, set = 0, binding = 39) readonly buffer BufferAddresses { BufferAddressBlock buffer_addresses; };

WRITES_PAIRS(set_color, colors)

void main() {
    uvec3 at = gl_GlobalInvocationID;
    if (at.x >= deep.layer_width_px) {
        return;
    }
    uvec2 spid = texelFetch(spids, ivec3(at), 0).xy;
    uint own = sample_index(deep, at);
    set_color(own, spid.x == NO_PRIMITIVE ? NO_ENTRY : entry_of_sample(spid, own));
}
