// What stops a virtual point light on its way to a surface, where Segovia 2006 has a shadow map (section 4.3): a ray that any solid
// surface ends, a walk through the tree for each point and light. After bvh_walk.glsl.
#ifndef SHADING_VPL_SHADOW_GLSL
#define SHADING_VPL_SHADOW_GLSL

bool is_hidden_from(VplBlock vpl, vec3 position_ws, vec3 normal_ws) {
    float distance;
    vec3 towards = towards_vpl(vpl, position_ws, distance);
    return occluded(position_ws, normal_ws, towards, distance);
}

#endif
