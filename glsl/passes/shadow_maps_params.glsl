// Parameters that change between draws, for both stages that draw shadow maps.
#ifndef PASSES_SHADOW_MAPS_PARAMS_GLSL
#define PASSES_SHADOW_MAPS_PARAMS_GLSL

#include "resident.glsl"

struct ShadowMapsParams {
    // The draw's; read for MASK surfaces only.
    MaterialBlock material;
    // The map that is drawn.
    uint layer;
    uint _unused[3];
};

layout(push_constant) uniform Push { ShadowMapsParams params; };

#endif
