//! Where samples lie in their pixels (VK_EXT_sample_locations), the same places in every pixel.

use super::Gpu;
use ash::vk;

/// Places of all samples of a pixel.
pub(super) struct SamplePlaces {
    locations: Vec<vk::SampleLocationEXT>,
}

impl SamplePlaces {
    /// `places_px`: from the upper left corner of a pixel, as many as it has samples.
    pub fn new(places_px: impl IntoIterator<Item = [f32; 2]>) -> Self {
        Self { locations: places_px.into_iter().map(|[x, y]| vk::SampleLocationEXT { x, y }).collect() }
    }

    pub fn info(&self) -> vk::SampleLocationsInfoEXT<'_> {
        vk::SampleLocationsInfoEXT::default()
            .sample_locations_per_pixel(vk::SampleCountFlags::from_raw(self.locations.len() as u32))
            .sample_location_grid_size(vk::Extent2D { width: 1, height: 1 })
            .sample_locations(&self.locations)
    }

    /// Tells the draws that follow in a command buffer.
    pub fn set(&self, gpu: &Gpu, buffer: vk::CommandBuffer) {
        let functions = ash::ext::sample_locations::Device::new(&gpu.instance, &gpu.device);
        // SAFETY: the buffer is being recorded, on a device that was opened with the extension; the places outlive the call.
        unsafe { functions.cmd_set_sample_locations(buffer, &self.info()) };
    }
}
