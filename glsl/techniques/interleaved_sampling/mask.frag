// The near plane where a member that is drawn has no sample, so that nothing passes the depth test there: of the one, or of each whose
// samples are the device's. Keller and Heidrich 2001, section 3.1. Pass: src/techniques/interleaved_sampling/mask.rs.
// variants: MEMBERS=one|several
#version 460
#include "techniques/interleaved_sampling/members.glsl"

void main() {
#ifdef MEMBERS_SEVERAL
    uint member = first_of_run() + uint(gl_SampleID);
    bool is_seen = member < params.members && has_sample(member, uvec2(gl_FragCoord.xy));
#else
    bool is_seen = has_sample(first_of_run(), uvec2(gl_FragCoord.xy));
#endif
    if (is_seen) {
        discard;
    }
    gl_FragDepth = 1.0;
}
