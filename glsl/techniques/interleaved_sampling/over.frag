// A layer over what is drawn into, by fixed-function blending: light of its own, and how much it hides. Keller and Heidrich
// 2001, section 3.3. Pass: src/techniques/interleaved_sampling/over.rs.
#version 460

layout(set = 0, binding = 0) uniform sampler2D layer;

layout(location = 0) out vec4 out_color;

void main() {
    out_color = texelFetch(layer, ivec2(gl_FragCoord.xy), 0);
}
