// Parameters that change between draws, for both stages that draw shadow maps.
#ifndef PASSES_SHADOW_MAPS_PARAMS_GLSL
#define PASSES_SHADOW_MAPS_PARAMS_GLSL

#include "resident.glsl"

struct ShadowMapsParams {
    // Clip space of the map that is drawn, depth reversed.
    mat4 clip_from_world;
    // The draw's; read for MASK surfaces only.
    MaterialBlock material;
};

layout(push_constant) uniform Push { ShadowMapsParams params; };

#endif
