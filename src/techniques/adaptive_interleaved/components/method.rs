//! What a component is asked for: Dubla 2009, Listing 1.

use crate::error::Result;
use crate::gpu::shader::structs::LightBlock;
use crate::settings::Values;
use crate::techniques::Inputs;

/// One component.
pub trait ComponentMethod: Sync {
    /// Most iterations of a pixel, the initial pass's included.
    fn most_iterations(&self, values: &Values) -> u32;

    /// How many sources and lights its samples have, for tiles of `tile_px`.
    ///
    /// Errors: settings that contradict each other or the scene (exit code 2).
    fn count(&self, inputs: &Inputs<'_>, tile_px: [u32; 2]) -> Result<SampleCount>;

    /// Its samples, as many as `count` says.
    ///
    /// Errors: the tree cannot be built (exit code 2); the user has asked to stop (130).
    fn samples(&self, inputs: &Inputs<'_>, tile_px: [u32; 2]) -> Result<Samples>;
}

/// How much a component's shader reads.
#[derive(Clone, Copy)]
pub struct SampleCount {
    /// Virtual point lights, or area lights.
    pub sources: u32,
    /// Bytes of all their samples.
    pub source_bytes: u64,
    /// The scene's own lights that it samples too.
    pub lights: u32,
}

/// What a component's shader reads.
pub struct Samples {
    /// The bytes of its sources, as its shader's buffer has them.
    pub sources: Vec<u8>,
    /// The scene's own lights that it samples too.
    pub lights: Vec<LightBlock>,
    /// Numbers for the report's `counters`.
    pub counters: Vec<(&'static str, f64)>,
}
