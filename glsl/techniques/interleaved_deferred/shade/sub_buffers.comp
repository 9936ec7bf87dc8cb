// Each sub-buffer shaded with its own lights: one light list for neighbouring threads. Segovia 2006, section 4.3 (SNSM).
// Pass: src/techniques/interleaved_deferred/shade/sub_buffers.rs.
// variants: POSITION=half|unorm16|depth|float STORAGE=buffer|image|layers
#version 460
#include "passes/gbuffer.glsl"
#define READS_SURFACE
#define WRITES_IRRADIANCE
#include "techniques/interleaved_deferred/sub_buffers.glsl"
#include "techniques/interleaved_deferred/shade/irradiance.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

// x: texels of a sub-buffer, row after row; z: sub-buffers.
void main() {
    uvec3 id = gl_GlobalInvocationID;
    uvec3 texel = uvec3(id.x % params.mapping.sub_width_px, id.x / params.mapping.sub_width_px, id.z);
    if (!is_in_sub_buffer(params.mapping, texel)) {
        return;
    }
    PLACE place = place_of_texel(params.mapping, texel);
    uvec2 normal_bits = load_normal(place);
    if (!has_surface(normal_bits)) {
        store_irradiance(place, uvec2(0u));
        return;
    }
    vec3 position_ws = unpack_position(frame, load_position(place), pixel_of_texel(params.mapping, texel));
    store_irradiance(place, shade_subset(subsets[id.z], position_ws, unpack_normal(normal_bits)));
}
