//! Pipelines of a device by what they are made of: the next renderer that wants one shares it.
//!
//! Why not the driver's cache (VkPipelineCache): lavapipe 22.3 keeps nothing in it and translates a shader anew each time, which
//! is most of the time of a renderer of small pictures.
//!
//! A pipeline outlives the layout that it was made with (maintenance4); layouts that other renderers make of the same shaders
//! are defined alike, and sets of the one fit the other.

use super::description::{Blending, Constants, DepthBias, GraphicsDescription, StencilUse, VertexBuffer};
use super::shader::Shader;
use crate::error::Result;
use ash::vk;
use std::collections::HashMap;
use std::sync::{Arc, Mutex};

/// Above this number those that nobody uses are destroyed: long sweeps of settings must not fill memory.
const MOST_KEPT: usize = 256;

/// What a pipeline is made of.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Recipe {
    /// Where each stage's words lie, which is for good: equal addresses are equal shaders.
    shaders: Vec<(usize, usize)>,
    constants: Vec<(String, u32)>,
    drawn: Option<Drawn>,
}

/// What stages alone do not say of a graphics pipeline.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Drawn {
    vertex_buffers: Vec<VertexBuffer>,
    color_formats: Vec<vk::Format>,
    samples: (u32, bool),
    blending: Blending,
    depth: (Option<vk::Format>, bool, vk::CompareOp, bool),
    /// Bits of `depth_bias` and `conservative_margin_px`.
    depth_bias: [u32; 2],
    conservative_margin_px: Option<u32>,
    stencil: Option<StencilUse>,
    /// All of them are materials' (`resident`), which are defined alike in all scenes.
    foreign_sets: usize,
}

impl Recipe {
    fn of_shaders<'a>(shaders: impl IntoIterator<Item = &'a Shader>, constants: Constants<'_>) -> Self {
        let address = |shader: &Shader| (shader.spirv.as_ptr() as usize, shader.spirv.len());
        Self {
            shaders: shaders.into_iter().map(address).collect(),
            constants: constants.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect(),
            drawn: None,
        }
    }

    pub fn compute(shader: &Shader, constants: Constants<'_>) -> Self {
        Self::of_shaders([shader], constants)
    }

    pub fn graphics(description: &GraphicsDescription<'_>) -> Self {
        // By name, so that a field that is added is thought of here.
        let GraphicsDescription {
            vertex,
            geometry,
            fragment,
            constants,
            vertex_buffers,
            color_formats,
            samples,
            are_placed,
            blending,
            depth_format,
            depth_write,
            depth_compare,
            depth_clamp,
            depth_bias: DepthBias { slope, steps },
            conservative_margin_px,
            stencil,
            foreign_sets,
        } = *description;
        let stages = [Some(vertex), geometry, fragment].into_iter().flatten();
        let drawn = Drawn {
            vertex_buffers: vertex_buffers.to_vec(),
            color_formats: color_formats.to_vec(),
            samples: (samples, are_placed),
            blending,
            depth: (depth_format, depth_write, depth_compare, depth_clamp),
            depth_bias: [slope, steps].map(f32::to_bits),
            conservative_margin_px: conservative_margin_px.map(f32::to_bits),
            stencil,
            foreign_sets: foreign_sets.len(),
        };
        Self { drawn: Some(drawn), ..Self::of_shaders(stages, constants) }
    }
}

/// One that the store has made, and destroys when nobody uses it.
#[derive(Debug)]
pub(super) struct StoredPipeline {
    pub handle: vk::Pipeline,
}

#[derive(Default)]
pub(super) struct PipelineStore {
    made: Mutex<HashMap<Recipe, Arc<StoredPipeline>>>,
}

impl PipelineStore {
    /// The pipeline of a recipe, made unless it is there.
    ///
    /// Errors: as of `make`.
    pub fn get(
        &self,
        device: &ash::Device,
        recipe: Recipe,
        make: impl FnOnce() -> Result<vk::Pipeline>,
    ) -> Result<Arc<StoredPipeline>> {
        let mut made = self.made.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(stored) = made.get(&recipe) {
            return Ok(stored.clone());
        }
        if made.len() >= MOST_KEPT {
            made.retain(|_, stored| {
                let is_used = Arc::strong_count(stored) > 1;
                if !is_used {
                    // SAFETY: the fence of the last frame that used it was waited for.
                    unsafe { device.destroy_pipeline(stored.handle, None) };
                }
                is_used
            });
        }
        let stored = Arc::new(StoredPipeline { handle: make()? });
        made.insert(recipe, stored.clone());
        Ok(stored)
    }

    /// Destroys all of them.
    ///
    /// # Safety
    /// Nothing uses one any more.
    pub unsafe fn close(&self, device: &ash::Device) {
        let mut made = self.made.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        for (_, stored) in made.drain() {
            // SAFETY: as the caller says.
            unsafe { device.destroy_pipeline(stored.handle, None) };
        }
    }
}
