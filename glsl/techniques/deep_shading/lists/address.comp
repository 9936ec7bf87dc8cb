// Where each sample's colour will be, looked up once, after compaction has moved them (section 4.3: the indirect frame
// buffer). Pass: src/techniques/deep_shading/lists/address.rs.
#version 460
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "techniques/deep_shading/space.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 2) readonly buffer Deep { DeepBlock deep; };
layout(set = 0, binding = 27) uniform usampler2DArray spids;
layout(std430, set = 0, binding = 20) readonly buffer Begins { uint begins[]; };
layout(std430, set = 0, binding = 21) readonly buffer Nodes { uvec2 nodes[]; };
layout(std430, set = 0, binding = 23) readonly buffer Linear { uint linear[]; };
layout(std430, set = 0, binding = 24) writeonly buffer Addresses { uint addresses[]; };
layout(std430, set = 0, binding = 39) readonly buffer BufferAddresses { BufferAddressBlock buffer_addresses; };

READS_WORDS(begin_of, begins)
READS_PAIRS(node_of, nodes)
READS_WORDS(row_id, linear)
WRITES_WORDS(set_address, addresses)

#define LISTS_COMPACT
#include "techniques/deep_shading/nodes.glsl"
#include "techniques/deep_shading/spid.glsl"

void main() {
    uvec3 at = gl_GlobalInvocationID;
    if (at.x >= deep.layer_width_px) {
        return;
    }
    uvec2 spid = texelFetch(spids, ivec3(at), 0).xy;
    if (spid.x != NO_PRIMITIVE) {
        uint own = sample_index(deep, at);
        set_address(own, color_of(spid, own));
    }
}
