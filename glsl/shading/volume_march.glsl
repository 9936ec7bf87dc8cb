// A ray through a volume in steps of parts of a voxel, so small that finer ones change nothing to speak of: what slices of
// planes are held against. Pass: src/techniques/path_traced/sample.rs.
#ifndef SHADING_VOLUME_MARCH_GLSL
#define SHADING_VOLUME_MARCH_GLSL

#include "loops.glsl"
#include "shading/box.glsl"
#include "shading/volume.glsl"

// rgb: radiance that reaches the ray's origin from its first `limit` metres; w: part of the light from behind them that does.
// `steps`: steps for each voxel that it passes.
vec4 march(vec3 origin, vec3 direction, float limit, float steps) {
    vec3 from = (volume.voxels_from_world * vec4(origin, 1.0)).xyz;
    vec3 a_metre = mat3(volume.voxels_from_world) * direction;
    vec2 ends = in_box(vec3(0.0), volume.last.xyz, from, a_metre, 0.0, limit);
    vec4 passed = vec4(0.0, 0.0, 0.0, 1.0);
    if (!(ends.x < ends.y)) {
        return passed;
    }
    uint count = uint(ceil((ends.y - ends.x) * length(a_metre) * steps));
    float step_m = (ends.y - ends.x) / float(count);
    uint index = 0u;
    for (; index < count; index++) {
        vec4 seen = medium_at(from + a_metre * (ends.x + (float(index) + 0.5) * step_m));
        float stopped = opacity(seen.w, step_m);
        passed.rgb += passed.w * stopped * seen.rgb;
        passed.w *= 1.0 - stopped;
    }
    expect_done(index == count);
    return passed;
}

#endif
