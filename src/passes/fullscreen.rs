//! The vertex stage of passes that run a fragment program on every pixel: one triangle, no vertex buffer.
//! Shader: fullscreen.vert.

use crate::gpu::Commands;
use crate::gpu::pipeline::{Blending, DepthBias, GraphicsDescription};
use crate::gpu::shader::Shader;
use ash::vk;

/// A pipeline of this stage and `fragment`, which writes `color_formats` and tests nothing.
pub fn description<'a>(fragment: &'a Shader, color_formats: &'a [vk::Format]) -> GraphicsDescription<'a> {
    GraphicsDescription {
        vertex: &crate::gpu::shader::passes::fullscreen::VERT,
        geometry: None,
        fragment: Some(fragment),
        constants: &[],
        vertex_buffers: &[],
        color_formats,
        samples: 1,
        are_placed: false,
        blending: Blending::Replace,
        depth_format: None,
        depth_write: false,
        depth_compare: vk::CompareOp::ALWAYS,
        depth_clamp: false,
        depth_bias: DepthBias::NONE,
        conservative_margin_px: None,
        stencil: None,
        foreign_sets: &[],
    }
}

/// Draws it, inside rendering, with the pipeline that is bound. `number`: below 4096; the fragment program reads it as
/// `in_instance`, and the triangle's depth is that many 4096ths.
pub fn draw(cmd: &Commands, number: u32) {
    draw_vertices(cmd, 3, number);
}

/// Draws a vertex stage that makes a quad of six vertices, which reads `number` as its instance.
pub fn draw_quad(cmd: &Commands, number: u32) {
    draw_vertices(cmd, 6, number);
}

fn draw_vertices(cmd: &Commands, count: u32, number: u32) {
    let (device, buffer) = (&cmd.gpu().device, cmd.buffer());
    // SAFETY: the buffer is being recorded inside rendering; the stage reads no vertex buffer.
    unsafe {
        device.cmd_set_cull_mode(buffer, vk::CullModeFlags::NONE);
        device.cmd_set_front_face(buffer, vk::FrontFace::COUNTER_CLOCKWISE);
        device.cmd_draw(buffer, count, 1, 0, number);
    }
}
