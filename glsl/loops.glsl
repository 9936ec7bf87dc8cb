// A driver may end a loop after too many iterations, without an error (src/caps/quirks.rs, `Identity::loop_end`).
// What was summed by then must not pass for a result: it becomes NaN, which fails the picture.
#ifndef LOOPS_GLSL
#define LOOPS_GLSL

#include "nan.glsl"

bool loops_were_cut = false;

// `is_done`: that what the loop was to do is done.
void expect_done(bool is_done) {
    loops_were_cut = loops_were_cut || !is_done;
}

vec3 nan_if_cut(vec3 value) {
    return loops_were_cut ? vec3(no_number()) : value;
}

#endif
