// Tiles that refine, sorted by their iterations, so that threads that lie together iterate as often.
#ifndef ADAPTIVE_INTERLEAVED_BINS_GLSL
#define ADAPTIVE_INTERLEAVED_BINS_GLSL

// Iterations of a pixel at most, and one more: as many as the block's lists have.
const uint BIN_COUNT = 65u;
// Threads of a workgroup of the refinement.
const uint REFINE_LANES = 64u;
// Workgroups in a row of its dispatch: no device allows fewer.
const uint REFINE_ROW = 32768u;

struct BinsBlock {
    // Workgroups of the refinement, as an indirect dispatch takes them, and the tiles that it refines.
    uint groups[3];
    uint refined_count;
    // Tiles with as many further iterations, and how many of them have their place in the list.
    uint counts[65];
    uint placed[65];
};

#endif
