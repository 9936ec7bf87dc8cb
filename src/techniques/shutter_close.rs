//! Camera and lights when the shutter closes (`--shutter`).

use super::Inputs;
use crate::error::Result;
use crate::frame::View;
use crate::gpu::shader::structs::FrameBlock;
use crate::lights::LightSet;

/// The other end of what moves.
pub struct ShutterClose {
    pub view: View,
    pub lights: LightSet,
}

impl ShutterClose {
    /// None: nothing moves.
    ///
    /// Errors: as of the scene's own camera and lights.
    pub fn new(inputs: &Inputs<'_>) -> Result<Option<Self>> {
        let Some(scene) = &inputs.scene.closing else { return Ok(None) };
        let view = View::new(scene, inputs.values.text("camera"), inputs.view.extent)?;
        let lights = inputs.lights.closing(scene, &view, inputs.values)?;
        Ok(Some(Self { view, lights }))
    }

    /// As the frame's own: shaders read the camera of it.
    pub fn block(&self, inputs: &Inputs<'_>) -> FrameBlock {
        let background = inputs.values.color("background");
        self.view.block(&inputs.scene.bounds(), background, self.lights.ambient, 0, 0)
    }
}
