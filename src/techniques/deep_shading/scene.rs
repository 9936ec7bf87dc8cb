//! What the technique's shaders read of the scene: the resident buffers, where it is when the shutter closes, its lights in the
//! middle, the cameras and the tuples.

use super::choices::Choices;
use super::{NAME, full};
use crate::error::Result;
use crate::gpu::shader::structs::{FrameBlock, LightBlock};
use crate::gpu::{Access, Bound, Buffer, Gpu, upload};
use crate::passes::direct::{self, DirectGpu};
use crate::plan::Resources;
use crate::resident::{Geometry, SceneGpu, draw_blocks};
use crate::techniques::Inputs;
use crate::techniques::closing::Closing;
use glam::{Vec3, Vec4};
use std::sync::Arc;

/// Buffers beside the resident ones.
pub struct DeepScene {
    direct: DirectGpu,
    tuples: Buffer,
    space: Buffer,
    middle: Buffer,
    close_positions: Buffer,
    close_attributes: Buffer,
    close_draws: Buffer,
}

impl DeepScene {
    /// Fills the planned buffers.
    ///
    /// Errors: as of the scene's cameras and lights; memory for the uploads (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, inputs: &Inputs<'_>, resources: &mut Resources, choices: &Choices) -> Result<Self> {
        let closing = Closing::new(inputs)?;
        let mut lights = direct::light_blocks(inputs.lights, inputs.values);
        let bounds = inputs.scene.bounds();
        let background = inputs.values.color("background");
        let mut middle = inputs.view.block(&bounds, background, inputs.lights.ambient, lights.len() as u32, 0);
        if let Some(closing) = &closing {
            let ends = direct::light_blocks(&closing.lights, inputs.values);
            lights.iter_mut().zip(&ends).for_each(|(light, end)| *light = mean_light(light, end));
            middle = mean_frame(&middle, &closing.block(inputs));
        }
        let tree = choices.direct.tree(inputs.bvh, inputs.scene)?;
        let direct = DirectGpu::new(gpu, resources, NAME, &lights, false, tree)?;
        let seed = inputs.values.integer("seed") as u32;
        let tuples: Vec<_> =
            (0..choices.run_count).flat_map(|run| choices.table.tuples(inputs.view.extent, seed, run)).collect();
        let view = closing.as_ref().map(|closing| &closing.view);
        let space = choices.space.block(inputs.view, view, choices.lens, &choices.table);
        let close = inputs.scene.closing.as_deref().map(|scene| (Geometry::of(scene), draw_blocks(scene)));
        let (geometry, draws) = close.unzip();
        let of = |bytes: Option<&[u8]>| bytes.map_or(Vec::new(), <[u8]>::to_vec);
        let positions = of(geometry.as_ref().map(|geometry| bytemuck::cast_slice(&geometry.positions)));
        let attributes = of(geometry.as_ref().map(|geometry| bytemuck::cast_slice(&geometry.attributes)));
        let draws = of(draws.as_ref().map(|draws| bytemuck::cast_slice(draws)));
        let mut filled = |what: &str, bytes: &[u8]| -> Result<Buffer> {
            let buffer = resources.buffer(&full(what));
            upload::buffer(gpu, &buffer, bytes, Access::ComputeRead | Access::GraphicsRead)?;
            Ok(buffer)
        };
        Ok(Self {
            tuples: filled("tuples", bytemuck::cast_slice(&tuples))?,
            space: filled("space", bytemuck::bytes_of(&space))?,
            middle: filled("middle", bytemuck::bytes_of(&middle))?,
            close_positions: filled("close.positions", &positions)?,
            close_attributes: filled("close.attributes", &attributes)?,
            close_draws: filled("close.draws", &draws)?,
            direct,
        })
    }

    /// Everything that a shader of the technique may read of it, by name.
    pub fn bound<'a>(&'a self, frame: &'a Buffer, scene: &'a SceneGpu) -> Vec<(&'static str, Bound<'a>)> {
        let mut bound = vec![
            ("Frame", Bound::Buffer(frame)),
            ("Middle", Bound::Buffer(&self.middle)),
            ("Draws", Bound::Buffer(&scene.draws)),
            ("Deep", Bound::Buffer(&self.space)),
            ("Tuples", Bound::Buffer(&self.tuples)),
            ("Indices", Bound::Buffer(&scene.indices)),
            ("Positions", Bound::Buffer(&scene.positions)),
            ("Attributes", Bound::Buffer(&scene.attributes)),
            ("ClosePositions", Bound::Buffer(&self.close_positions)),
            ("CloseAttributes", Bound::Buffer(&self.close_attributes)),
            ("CloseDraws", Bound::Buffer(&self.close_draws)),
        ];
        bound.extend(self.direct.bound());
        if let Some(extended) = &scene.extended {
            bound.push(("ExtendedAttributes", Bound::Buffer(&extended.attributes)));
            bound.push(("Placements", Bound::Buffer(&extended.placements)));
        }
        bound
    }
}

/// A light in the middle of the exposure: as far and as strong as between its ends.
fn mean_light(open: &LightBlock, close: &LightBlock) -> LightBlock {
    let mean = |a: [f32; 4], b: [f32; 4]| (Vec4::from(a) * 0.5 + Vec4::from(b) * 0.5).to_array();
    let direction = Vec4::from(mean(open.direction_ws, close.direction_ws)).truncate();
    LightBlock {
        position_ws: mean(open.position_ws, close.position_ws),
        intensity: mean(open.intensity, close.intensity),
        direction_ws: direction.normalize_or(Vec4::from(open.direction_ws).truncate()).extend(0.0).to_array(),
        ..*open
    }
}

/// The eye and its axes between both ends; the rest is the opening's.
fn mean_frame(open: &FrameBlock, close: &FrameBlock) -> FrameBlock {
    let mean = |a: [f32; 4], b: [f32; 4]| Vec4::from(a) * 0.5 + Vec4::from(b) * 0.5;
    let direction = |a: [f32; 4], b: [f32; 4]| {
        let between: Vec3 = mean(a, b).truncate();
        between.normalize_or(Vec4::from(a).truncate()).extend(0.0).to_array()
    };
    FrameBlock {
        eye_ws: mean(open.eye_ws, close.eye_ws).to_array(),
        forward_ws: direction(open.forward_ws, close.forward_ws),
        right_ws: direction(open.right_ws, close.right_ws),
        up_ws: direction(open.up_ws, close.up_ws),
        ambient: mean(open.ambient, close.ambient).to_array(),
        ..*open
    }
}
