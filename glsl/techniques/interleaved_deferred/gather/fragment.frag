// A fragment program that moves irradiance as a look-up texture says: the gather as the paper ran it (Segovia 2006,
// section 4.4). The shader does not know the mapping. Pass: src/techniques/interleaved_deferred/gather/fragment.rs.
#version 460
#define STORAGE_IMAGE
#define READS_IRRADIANCE
#include "techniques/interleaved_deferred/sub_buffers.glsl"

layout(set = 0, binding = 0) uniform usampler2D lookup;

layout(location = 0) out uvec2 out_irradiance;

void main() {
    uvec2 from = texelFetch(lookup, ivec2(gl_FragCoord.xy), 0).rg;
    out_irradiance = load_irradiance(ivec2(from));
}
