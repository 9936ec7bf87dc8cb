// A subset of the lights: its stretches of the list of virtual point lights and of the list of punctual lights. Subsets of
// a cluster share their stretch of the punctual lights.
#ifndef SHADING_SUBSET_GLSL
#define SHADING_SUBSET_GLSL

struct SubsetBlock {
    uint vpl_first;
    uint vpl_count;
    uint light_first;
    uint light_count;
};

#endif
