//! What the passes of a component share on the device: its buffers, and those that all components have.

use super::choices::{Choices, ComponentChoice};
use super::components::Samples;
use super::resources::of_component;
use super::settings::Component;
use crate::error::Result;
use crate::gpu::shader::structs::AdaptiveParams;
use crate::gpu::shader::techniques::adaptive_interleaved::bins::REFINE_ROW;
use crate::gpu::{Access, Bound, Buffer, Gpu, upload};
use crate::passes::direct::DirectGpu;
use crate::passes::gbuffer::GBuffer;
use crate::plan::Resources;
use std::sync::Arc;

/// What the passes of every component share.
pub struct Shared<'a> {
    pub frame: &'a Buffer,
    /// The scene's own lights, and the tree that shadow rays walk.
    pub direct: &'a DirectGpu,
}

/// The buffers of one component.
pub struct ComponentBuffers {
    pub component: Component,
    pub params: AdaptiveParams,
    /// Its samples: read by blended surfaces too, where they are virtual lights.
    pub sources: Buffer,
    pub rays: Buffer,
    /// As it is estimated.
    pub irradiance: Buffer,
}

impl ComponentBuffers {
    /// Takes what `plan` put in, and fills what the host makes.
    pub fn new(
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        choices: &Choices,
        choice: &ComponentChoice,
        samples: &Samples,
    ) -> Result<Self> {
        let key = choice.component.name();
        let sources = resources.buffer(&of_component("sources", key));
        if choices.has_device_samples(choice.component) {
            upload::buffer(gpu, &sources, &samples.sources, Access::ComputeRead | Access::GraphicsRead)?;
        }
        Ok(Self {
            component: choice.component,
            params: choice.params,
            sources,
            rays: resources.buffer(&of_component("rays", key)),
            irradiance: resources.buffer(&of_component("irradiance", key)),
        })
    }

    /// Bindings of estimate.glsl and of the component's own file, among others.
    pub fn bound<'a>(&'a self, shared: &Shared<'a>, gbuffer: &'a GBuffer) -> Vec<(&'static str, Bound<'a>)> {
        let mut bound = vec![
            ("Frame", Bound::Buffer(shared.frame)),
            ("BvhNodes", Bound::Buffer(&shared.direct.bvh_nodes)),
            ("BvhTriangles", Bound::Buffer(&shared.direct.bvh_triangles)),
            ("Rays", Bound::Buffer(&self.rays)),
            ("Irradiance", Bound::Buffer(&self.irradiance)),
            ("Sources", Bound::Buffer(&self.sources)),
            ("Lights", Bound::Buffer(&shared.direct.lights)),
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
