//! The same estimator on the threads of the host (`--trace host`), as the paper has it on the cores of a processor (Dubla
//! 2009, section 4.1): what each pixel sees by a ray through the tree, and then each component tile by tile, with single
//! rays and the same samples. Tiles are the jobs of the threads; none knows of another, so that their number changes
//! nothing. What the estimate leaves is brought to the device, where the passes behind it read it as they do else.
//! reads   the scene and the tree on the host, the components' samples
//! writes  rays, guidance and irradiance of each component, as sample.rs and guide.rs have them
//!
//! Why each frame: a device's frame has this work in it, and a benchmark that left it out would compare a picture with the
//! half of one.
//!
//! Differs from the device: alpha and normal maps are read from the finest texture level; what the rasteriser's rules for
//! edges decide is a ray's.

pub mod estimate;
mod hit;
pub mod upload;

use super::components::{Given, Point};
use super::resources::NAME;
use super::steps::ComponentSteps;
use crate::bvh::shadow::ShadowRays;
use crate::error::Result;
use crate::gpu::shader::structs::LightBlock;
use crate::settings::PositionStorage;
use crate::techniques::Run;
use std::time::Instant;

/// What the host's estimate needs beside the components.
pub struct HostTrace {
    /// What reads positions on the device has them rounded so: the estimate too.
    pub position: PositionStorage,
    /// Metres that shadow rays begin off their surfaces.
    pub offset_m: f32,
    /// The scene's own.
    pub lights: Vec<LightBlock>,
}

impl HostTrace {
    /// Estimates all components, and puts what they come to where the frame takes it from. The passes, with their time in
    /// nanoseconds.
    ///
    /// Errors: the tree cannot be built (exit code 2); Ctrl-C (130).
    pub fn run(&self, run: &Run<'_>, components: &[ComponentSteps]) -> Result<Vec<(String, u64)>> {
        let shadows = ShadowRays { bvh: run.bvh.over(run.scene)?, offset_m: self.offset_m };
        let (mut passes, mut started) = (Vec::new(), Instant::now());
        let mut end_pass = |name: String| {
            let now = Instant::now();
            passes.push((name, (now - started).as_nanos() as u64));
            started = now;
        };
        let points: Vec<Point> = hit::points(run.scene, shadows.bvh, run.frame, self.position)?;
        end_pass(format!("{NAME}.hit"));
        for steps in components {
            let params = &steps.buffers.params;
            steps.estimate_on_host(&Given { params, frame: run.frame, lights: &self.lights, shadows }, &points)?;
            end_pass(steps.buffers.label("sample"));
        }
        Ok(passes)
    }
}
