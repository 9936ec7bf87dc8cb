// Which lights reach into a box around surface points. After shading/light.glsl.
#ifndef SHADING_LIGHT_BOX_GLSL
#define SHADING_LIGHT_BOX_GLSL

// Around surface points; least beyond greatest where there are none.
struct Box {
    vec3 least;
    vec3 greatest;
};

const Box NO_BOX = Box(vec3(1e30), vec3(-1e30));

void include_point(inout Box box, vec3 position_ws) {
    box.least = min(box.least, position_ws);
    box.greatest = max(box.greatest, position_ws);
}

bool is_touched(Box box, LightBlock light) {
    vec3 center = light.position_ws.xyz;
    vec3 away = max(max(box.least - center, center - box.greatest), vec3(0.0));
    float range = light.intensity.w;
    // A hair more than the range: rounding must never drop a light that the window still lets through.
    bool touches = dot(away, away) <= range * range * 1.0001;
    bool endless = is_directional(light) || range == 0.0;
    return box.least.x <= box.greatest.x && (endless || touches);
}

#endif
