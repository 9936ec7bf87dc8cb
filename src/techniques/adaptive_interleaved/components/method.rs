//! What a component is asked for: Dubla 2009, Listing 1.

use super::host::HostComponent;
use crate::error::Result;
use crate::gpu::shader::structs::AdaptiveParams;
use crate::settings::Values;
use crate::techniques::Inputs;
use bytemuck::{AnyBitPattern, NoUninit};

/// One component.
pub trait ComponentMethod: Sync {
    /// Most iterations of a pixel, the initial pass's included.
    fn most_iterations(&self, values: &Values) -> u32;

    /// Pixels from one that it is estimated at to the next, in both directions.
    fn scale(&self, _: &Values) -> u32 {
        1
    }

    /// Whether each of its lights guides by itself.
    fn guides_each(&self, _: &Values) -> bool {
        false
    }

    /// Its choices for tiles of `tile_px`. None: nothing in this scene is its light; never where it is `listed` by
    /// `--components`.
    ///
    /// Errors: settings that contradict each other or the scene (exit code 2).
    fn prepare(
        &self,
        inputs: &Inputs<'_>,
        tile_px: [u32; 2],
        listed: bool,
    ) -> Result<Option<Box<dyn PreparedComponent>>>;
}

/// A component whose choices are made.
pub trait PreparedComponent {
    /// How many sources and lights its samples have.
    fn count(&self) -> SampleCount;

    /// Writes those of its numbers that no other component has.
    fn write(&self, _: &mut AdaptiveParams) {}

    /// Its samples, as many as `count` says.
    ///
    /// Errors: the tree cannot be built (exit code 2); the user has asked to stop (130).
    fn samples(&self, inputs: &Inputs<'_>) -> Result<Samples>;

    /// What estimates it on the host from these samples of its own: the twin of its shader.
    fn host(&self, samples: &Samples) -> Box<dyn HostComponent>;
}

/// How much a component's shader reads.
#[derive(Clone, Copy)]
pub struct SampleCount {
    /// Virtual point lights, or area lights.
    pub sources: u32,
    /// Bytes of all their samples.
    pub source_bytes: u64,
    /// Whether it samples the scene's own lights too.
    pub has_lights: bool,
}

/// What a component's shader reads.
pub struct Samples {
    /// The bytes of its sources, as its shader's buffer has them.
    pub sources: Vec<u8>,
    /// Numbers for the report's `counters`.
    pub counters: Vec<(&'static str, f64)>,
}

impl Samples {
    /// Its sources as the shader reads them.
    pub fn sources_as<T: AnyBitPattern + NoUninit>(&self) -> Vec<T> {
        bytemuck::pod_collect_to_vec(&self.sources)
    }
}
