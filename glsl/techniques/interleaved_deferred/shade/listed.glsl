// Texels of a list that compute shaders shade, TEXELS a thread: neighbouring threads take neighbouring texels, so that they
// are read together. Workgroup count: src/techniques/interleaved_deferred/shade/mod.rs.
#ifndef INTERLEAVED_DEFERRED_LISTED_GLSL
#define INTERLEAVED_DEFERRED_LISTED_GLSL

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

// Place in the list of a thread's i-th texel; it may lie behind the end.
uint listed(uint i) {
    return (gl_WorkGroupID.x * TEXELS + i) * gl_WorkGroupSize.x * gl_WorkGroupSize.y + gl_LocalInvocationIndex;
}

#endif
