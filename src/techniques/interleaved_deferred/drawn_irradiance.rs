//! Irradiance that fragment programs draw in frame order, copied into the buffer in frame order that the filter reads.
//!
//! Why this way: a fragment program could store into the buffer itself, but only where the device has
//! fragmentStoresAndAtomics; a colour attachment and vkCmdCopyImageToBuffer with the buffer's row pitch work everywhere,
//! for 8 B a pixel more memory and one more copy.

use crate::error::Result;
use crate::gpu::shader::structs::MappingParams;
use crate::gpu::{Access, Buffer, ColorTarget, Commands, Image};
use crate::plan::{Plan, Resources};
use crate::techniques::interleaved_deferred::resources::NAME;
use ash::vk;

/// Format of the image.
pub const FORMAT: vk::Format = vk::Format::R32G32_UINT;

/// The image that is drawn into.
pub struct DrawnIrradiance {
    image: Image,
}

impl DrawnIrradiance {
    /// Plans `what`.drawn, an image of the frame's extent.
    pub fn plan(plan: &mut Plan, what: &str, mapping: &MappingParams) {
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
        plan.image("irradiance", format!("{NAME}.{what}.drawn"), mapping.extent(), FORMAT, usage);
    }

    /// What a pass touches that draws it and copies it into the buffer `what`.irradiance.
    pub fn touches(what: &str) -> [(String, Access); 3] {
        let drawn = format!("{NAME}.{what}.drawn");
        [
            (drawn.clone(), Access::ColorWrite),
            (drawn, Access::TransferRead),
            (format!("{NAME}.{what}.irradiance"), Access::TransferWrite),
        ]
    }

    /// Takes what `plan` put in.
    pub fn new(resources: &mut Resources, what: &str) -> Self {
        Self { image: resources.image(&format!("{NAME}.{what}.drawn")) }
    }

    /// Bytes of one way of the copy.
    pub fn bytes(&self) -> u64 {
        self.image.description.bytes()
    }

    /// Records `draws` into the image and the copy into `irradiance`, inside a pass.
    pub fn record(
        &self,
        cmd: &mut Commands,
        mapping: &MappingParams,
        depth: Option<(&Image, Option<f32>, Access)>,
        irradiance: &Buffer,
        draws: impl FnOnce(&mut Commands) -> Result<()>,
    ) -> Result<()> {
        cmd.barriers([self.image.discard(Access::ColorWrite)]);
        // Every pixel is drawn, so what was there before need not be loaded; a clear says so.
        let clear = Some(vk::ClearColorValue { uint32: [0; 4] });
        cmd.begin_rendering(mapping.extent(), &[ColorTarget::new(&self.image, clear)], depth);
        draws(cmd)?;
        cmd.end_rendering();
        let drawn = self.image.from(Access::ColorWrite);
        cmd.barriers([drawn.to(Access::TransferRead), irradiance.discard(Access::TransferWrite)]);
        cmd.copy_to_rows(&self.image, irradiance, mapping.row_pitch());
        Ok(())
    }
}
