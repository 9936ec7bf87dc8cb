// A polygon over the frame with the member's picture as its texture, of which a stipple pattern lets the member's own pixels
// through, into their sums. Keller and Heidrich 2001, section 3.1. Pass: src/techniques/interleaved_sampling/combine.rs.
#version 460
#include "techniques/interleaved_sampling/combine.glsl"

layout(set = 0, binding = 3) uniform sampler2D drawn;

void main() {
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    uvec2 place = place_of(first_of_run(), pixel);
    if (place.x == NO_SAMPLE || place.y == NO_SAMPLE) {
        discard;
    }
    add_sample(first_of_run(), pixel, texelFetch(drawn, ivec2(place), 0).rgb);
}
