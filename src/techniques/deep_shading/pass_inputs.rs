//! What passes are handed: the draw that several of them repeat, and what they touch with who touched it last.

use crate::gpu::{Bound, Buffer, Edge};
use crate::passes::shadow_maps::ShadowMaps;
use crate::resident::{DrawList, SceneGpu};
use crate::techniques::deep_shading::primitives::Primitives;
use crate::techniques::deep_shading::tuples::TupleTable;
use crate::units::Extent;

/// The draw that finds what samples see, and that passes after it repeat.
#[derive(Clone, Copy)]
pub struct DrawInputs<'a> {
    pub scene: &'a SceneGpu,
    pub list: &'a DrawList,
    pub primitives: &'a Primitives,
    pub table: &'a TupleTable,
    pub frame: Extent,
    /// What shaders of the technique may read, by name.
    pub bound: &'a [(&'static str, Bound<'a>)],
}

/// What every pass that shades touches, and who touched it last.
#[derive(Clone, Copy)]
pub struct ShadingEdges<'a> {
    pub colors: Edge<'a, Buffer>,
    pub counters: Edge<'a, Buffer>,
    /// With `--direct-shadow map`.
    pub maps: Option<Edge<'a, ShadowMaps>>,
}
