// The number of the draw, wherever it covers a pixel. Pass: src/bench/device/triangles.rs.
#version 460
#include "bench/device/triangles.glsl"

layout(location = 0) out uint out_number;

void main() {
    // No draw has it, which nobody knows before: devices that draw in tiles, lavapipe among them, leave out what later draws cover whole, but
    // not where these may discard.
    if (params.number == 0u) {
        discard;
    }
    out_number = params.number;
}
