//! A sampler, destroyed when it is dropped.

use super::Gpu;
use crate::error::{Error, Result};
use ash::vk;
use std::sync::Arc;

pub struct Sampler {
    gpu: Arc<Gpu>,
    pub handle: vk::Sampler,
}

impl Sampler {
    /// Errors: the driver refuses (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, name: &str, info: &vk::SamplerCreateInfo<'_>) -> Result<Self> {
        // SAFETY: a live device; the info's pointers outlive the call.
        let handle = unsafe { gpu.device.create_sampler(info, None) }
            .map_err(|result| Error::device(format!("creating a sampler: {result}")))?;
        gpu.name(handle, name);
        if let Some(marks) = &gpu.marks {
            marks.sampler(handle, info);
        }
        Ok(Self { gpu: gpu.clone(), handle })
    }

    /// Clamped to the edge, finest level only; linear or nearest.
    pub fn clamped(gpu: &Arc<Gpu>, filter: vk::Filter) -> Result<Self> {
        let edge = vk::SamplerAddressMode::CLAMP_TO_EDGE;
        let info = vk::SamplerCreateInfo::default()
            .mag_filter(filter)
            .min_filter(filter)
            .address_mode_u(edge)
            .address_mode_v(edge)
            .address_mode_w(edge);
        let name = if filter == vk::Filter::LINEAR { "sampler.linear" } else { "sampler.nearest" };
        Self::new(gpu, name, &info)
    }
}

impl Drop for Sampler {
    fn drop(&mut self) {
        // SAFETY: the fence of the last frame that used it was waited for.
        unsafe { self.gpu.device.destroy_sampler(self.handle, None) };
    }
}
