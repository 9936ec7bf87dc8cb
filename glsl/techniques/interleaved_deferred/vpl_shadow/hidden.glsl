// Where it stands which lights of its subset a point does not see. The first word says whether a loop was cut short
// (loops.glsl); then come the words of each point, a bit a light in the order of the subset's virtual point lights.
// Passes: src/techniques/interleaved_deferred/vpl_shadow/.
#ifndef INTERLEAVED_DEFERRED_HIDDEN_GLSL
#define INTERLEAVED_DEFERRED_HIDDEN_GLSL

const uint LIGHTS_A_WORD = 32u;
// Words before those of the first point.
const uint HIDDEN_HEAD = 1u;

// First word of the point at `place`: `linear_of` its texel, or of its cell of the pattern with --split subsample.
uint first_hidden_word(uint place, uint words_a_point) {
    return HIDDEN_HEAD + place * words_a_point;
}

#endif
