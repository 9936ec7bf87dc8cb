// Readings of a texture side by side along the longer axis of what a pixel or a cone shows of it, each at the level of its
// shorter one: the anisotropic filter that Vulkan describes, in shaders. Samplers' own takes the steps of whole quads on some
// drivers and none that a shader states on others (lavapipe of Mesa 22 and 25). Each reading costs what one costs.
#ifndef SHADING_SLANTED_GLSL
#define SHADING_SLANTED_GLSL

struct Readings {
    // The longer axis from end to end, on the picture, whose sides are 1.
    vec2 longest;
    float count;
    // What a reading is as wide as, texels of the finest level.
    float width_px;
};

// One reading, in the middle, of the finest level: where nothing is slanted.
const Readings ONE_READING = Readings(vec2(0.0), 1.0, 0.0);

// `one`, `other`: steps on the picture, at a right angle on the screen or the surface. `most`: readings.
Readings readings_of(vec2 one, vec2 other, vec2 size_px, uint most) {
    vec2 along = one * size_px;
    vec2 across = other * size_px;
    // A circle through both ends becomes an ellipse, whose axes are the eigenvectors of the sum of their squares.
    float middle = 0.5 * (dot(along, along) + dot(across, across));
    float difference = 0.5 * (along.x * along.x + across.x * across.x - along.y * along.y - across.y * across.y);
    float product = along.x * along.y + across.x * across.y;
    float spread = length(vec2(difference, product));
    float long_px = sqrt(middle + spread);
    float short_px = sqrt(max(middle - spread, 0.0));
    float angle = spread > 0.0 ? 0.5 * atan(product, difference) : 0.0;
    Readings readings;
    readings.longest = vec2(cos(angle), sin(angle)) * long_px / size_px;
    // Rounding makes a circle no ellipse.
    readings.count = clamp(ceil(long_px / max(short_px, 1e-30) - 1e-3), 1.0, float(most));
    readings.width_px = long_px / readings.count;
    return readings;
}

// Where reading `index` lies, from the middle of them all; 0 the first.
vec2 place_of(Readings readings, float index) {
    return readings.longest * ((index + 1.0) / (readings.count + 1.0) - 0.5);
}

#endif
