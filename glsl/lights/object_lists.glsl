// The lights of an object and the box around it. Made by src/lights/object_lists.rs.
#ifndef LIGHTS_OBJECT_LISTS_GLSL
#define LIGHTS_OBJECT_LISTS_GLSL

struct ObjectLightsBlock {
    // World space.
    vec4 box_min_ws;
    vec4 box_max_ws;
    // A stretch of the lists' entries.
    uint first;
    uint count;
    uint _unused[2];
};

// A point of the object: what interpolation puts beside it is brought back.
vec3 inside_box(ObjectLightsBlock object, vec3 position_ws) {
    return clamp(position_ws, object.box_min_ws.xyz, object.box_max_ws.xyz);
}

#endif
