// Parameters of a draw of one light. Both stages of light/volumes read it.
#ifndef INFERRED_LIGHTING_LIGHT_VOLUMES_GLSL
#define INFERRED_LIGHTING_LIGHT_VOLUMES_GLSL

struct VolumesParams {
    // Index of the light.
    uint light;
};

layout(push_constant) uniform Push { VolumesParams params; };

#endif
