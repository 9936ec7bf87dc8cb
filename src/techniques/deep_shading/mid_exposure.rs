//! The scene in the middle of the exposure, where it is shaded: what moves is halfway between its places when the shutter opens
//! and when it closes.
//!
//! Where a draw and its vertices both move, shading takes the mean of places in the world (corners.glsl), shadow maps that of
//! `Exposure`.

use crate::error::Result;
use crate::gpu::shader::structs::FrameBlock;
use crate::lights::LightSet;
use crate::scene::Scene;
use crate::techniques::Inputs;
use crate::techniques::exposure::{Exposure, turned};
use crate::techniques::shutter_close::ShutterClose;
use glam::Vec4;

/// Half of the way through the exposure.
pub struct MidExposure {
    /// Meshes, draws and lights; no pictures of its own.
    pub scene: Scene,
    pub lights: LightSet,
    pub closing: ShutterClose,
}

impl MidExposure {
    /// None: nothing moves.
    ///
    /// Errors: as of the scene's own camera and lights.
    pub fn new(inputs: &Inputs<'_>) -> Result<Option<Self>> {
        let Some(exposure) = Exposure::new(inputs)? else { return Ok(None) };
        let (mut scene, lights) = (exposure.opening(), exposure.lights_at(0.5));
        exposure.pose(&mut scene, 0.5);
        Ok(Some(Self { scene, lights, closing: exposure.closing }))
    }

    /// `open`, the frame's own block, with the eye and its axes in the middle.
    pub fn frame(&self, inputs: &Inputs<'_>, open: &FrameBlock) -> FrameBlock {
        let close = self.closing.block(inputs);
        let mean = |a: [f32; 4], b: [f32; 4]| Vec4::from(a).midpoint(Vec4::from(b));
        let direction = |a: [f32; 4], b: [f32; 4]| turned(Vec4::from(a).truncate(), mean(a, b).truncate()).extend(0.0);
        FrameBlock {
            eye_ws: mean(open.eye_ws, close.eye_ws).to_array(),
            forward_ws: direction(open.forward_ws, close.forward_ws).to_array(),
            right_ws: direction(open.right_ws, close.right_ws).to_array(),
            up_ws: direction(open.up_ws, close.up_ws).to_array(),
            ambient: self.lights.ambient.extend(0.0).to_array(),
            ..*open
        }
    }
}
