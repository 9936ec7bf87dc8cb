// One triangle that covers the frame, for passes that run a fragment program on each pixel. Draws: src/passes/fullscreen.rs.
// portable: yes
#version 460

// Which of several draws this is: its first instance.
layout(location = 0) flat out uint out_instance;

void main() {
    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0;
    out_instance = gl_InstanceIndex;
    // The number in 4096ths as depth, the same all over: a depth test can choose by it. Times a power of two is exact on
    // every device; a quotient may be off by its last bits.
    gl_Position = vec4(corner, float(gl_InstanceIndex) * (1.0 / 4096.0), 1.0);
}
