//! What passes are handed: the draw that several of them repeat, and what they touch with who touched it last.

use crate::gpu::{Access, Barrier, Bound, Buffer, Edge};
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
    /// How coarse triangles are, with `--shading-rate blur`, and what touched that last.
    pub scales: Option<Edge<'a, Buffer>>,
    /// What shaders of the technique may read, by name.
    pub bound: &'a [(&'static str, Bound<'a>)],
}

impl DrawInputs<'_> {
    pub fn scales_to(&self, access: Access) -> Option<Barrier> {
        self.scales.map(|scales| scales.to(access))
    }

    /// After draws that find what samples see.
    pub fn after_visibility(self) -> Self {
        Self { scales: self.scales.map(|scales| scales.after(Access::GraphicsRead)), ..self }
    }
}

/// What every pass that shades touches, and who touched it last.
#[derive(Clone, Copy)]
pub struct ShadingEdges<'a> {
    pub colors: Edge<'a, Buffer>,
    pub counters: Edge<'a, Buffer>,
    /// With `--direct-shadow map`.
    pub maps: Option<Edge<'a, ShadowMaps>>,
}
