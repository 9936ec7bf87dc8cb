// The near plane where the member that is drawn has no sample, so that nothing passes the depth test there. Keller and
// Heidrich 2001, section 3.1. Pass: src/techniques/interleaved_sampling/mask.rs.
#version 460
#include "techniques/interleaved_sampling/members.glsl"

void main() {
    uvec2 place = place_of(uvec2(gl_FragCoord.xy));
    if (place.x != NO_SAMPLE && place.y != NO_SAMPLE) {
        discard;
    }
    gl_FragDepth = 1.0;
}
