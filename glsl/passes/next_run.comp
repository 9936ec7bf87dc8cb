// Makes a frame's numbers those of its next run, where runs differ by nothing else. Pass: src/passes/next_run.rs.
#version 460
#include "frame.glsl"

layout(local_size_x = 1) in;

layout(std430, set = 0, binding = 0) buffer Frame { FrameBlock frame; };

void main() {
    frame.sample_index++;
}
