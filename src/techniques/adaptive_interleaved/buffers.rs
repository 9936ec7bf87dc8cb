//! What the passes of a component share on the device: its buffers, and those that all components have.

use super::choices::ComponentChoice;
use super::components::Samples;
use super::resources::{NAME, of_component};
use super::settings::Component;
use crate::bvh::Bvh;
use crate::bvh::flat::flattened;
use crate::error::Result;
use crate::gpu::shader::structs::AdaptiveParams;
use crate::gpu::shader::techniques::adaptive_interleaved::bins::REFINE_ROW;
use crate::gpu::{Access, Bound, Buffer, Gpu, upload};
use crate::passes::gbuffer::GBuffer;
use crate::plan::Resources;
use std::sync::Arc;

/// The tree that shadow rays walk.
pub struct TreeGpu {
    nodes: Buffer,
    triangles: Buffer,
}

impl TreeGpu {
    /// Takes the planned buffers and fills them.
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, tree: &Bvh) -> Result<Self> {
        let mut filled = |what: &str, bytes: &[u8]| {
            let buffer = resources.buffer(&format!("{NAME}.{what}"));
            upload::buffer(gpu, &buffer, bytes, Access::ComputeRead)?;
            Result::Ok(buffer)
        };
        Ok(Self {
            nodes: filled("bvh.nodes", bytemuck::cast_slice(&flattened(&tree.nodes)))?,
            triangles: filled("bvh.triangles", bytemuck::cast_slice(&tree.triangles))?,
        })
    }
}

/// What the passes of every component share.
pub struct Shared<'a> {
    pub frame: &'a Buffer,
    pub tree: &'a TreeGpu,
    pub irradiance: &'a Buffer,
}

/// The buffers of one component.
pub struct ComponentBuffers {
    pub component: Component,
    pub params: AdaptiveParams,
    sources: Buffer,
    lights: Buffer,
    pub rays: Buffer,
}

impl ComponentBuffers {
    /// Takes what `plan` put in, and fills what the host makes.
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, choice: &ComponentChoice, samples: &Samples) -> Result<Self> {
        let key = choice.component.name();
        let mut filled = |what: &str, bytes: &[u8]| {
            let buffer = resources.buffer(&of_component(what, key));
            upload::buffer(gpu, &buffer, bytes, Access::ComputeRead)?;
            Result::Ok(buffer)
        };
        let sources = filled("sources", &samples.sources)?;
        let lights = filled("lights", bytemuck::cast_slice(&samples.lights))?;
        Ok(Self {
            component: choice.component,
            params: choice.params,
            sources,
            lights,
            rays: resources.buffer(&of_component("rays", key)),
        })
    }

    /// Bindings of estimate.glsl and of the component's own file, among others.
    pub fn bound<'a>(&'a self, shared: &Shared<'a>, gbuffer: &'a GBuffer) -> Vec<(&'static str, Bound<'a>)> {
        let mut bound = vec![
            ("Frame", Bound::Buffer(shared.frame)),
            ("BvhNodes", Bound::Buffer(&shared.tree.nodes)),
            ("BvhTriangles", Bound::Buffer(&shared.tree.triangles)),
            ("Rays", Bound::Buffer(&self.rays)),
            ("Irradiance", Bound::Buffer(shared.irradiance)),
            ("Sources", Bound::Buffer(&self.sources)),
            ("Lights", Bound::Buffer(&self.lights)),
        ];
        bound.extend(gbuffer.bound_surface());
        bound
    }

    /// Full name of one of its passes.
    pub fn label(&self, step: &str) -> String {
        of_component(step, self.component.name())
    }
}

/// Workgroups in rows of `REFINE_ROW`, which every device allows.
pub fn rows_of_groups(count: u32) -> [u32; 3] {
    [count.min(REFINE_ROW), count.div_ceil(REFINE_ROW), 1]
}
