//! The fast Gaussian: half-texel fetches that let the sampler blend two texels and their flags at once. Segovia 2006,
//! section 4.5 and figure 4b. Shader: gauss_fast.comp; gauss_pack.comp makes its image.
//! reads  an irradiance buffer and flags      writes  two images between, then the target buffer

use super::gauss_pack::GaussPack;
use super::{FilterMethod, FilterPass, FilterSetup, Kernel, StopBits};
use crate::caps::Ability;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::sampler::Sampler;
use crate::gpu::shader::passes::filter::gauss_fast as shader;
use crate::gpu::shader::structs::{GaussFastParams, GaussPackParams};
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Image, Traffic};
use crate::plan::{Plan, Resources};
use crate::units::Extent;
use ash::vk;
use std::sync::Arc;

/// The filter of `--filter gauss-fast`.
pub struct GaussFastMethod;

impl FilterMethod for GaussFastMethod {
    fn need(&self) -> Option<(Ability, &'static str)> {
        Some((Ability::StoreWordPairs, "--filter gauss filters in buffers"))
    }

    fn taps(&self, kernel_taps: f64) -> f64 {
        2.0 * kernel_taps
    }

    fn plan(&self, plan: &mut Plan, setup: &FilterSetup<'_>, source: String, flags: String) -> String {
        let (read, written, sampled) = (Access::ComputeRead, Access::ComputeWrite, Access::ComputeSample);
        let mut touches = vec![(source, read), (flags, read)];
        for image in ["packed", "rows"].map(|what| setup.resource(what)) {
            let usage = vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::SAMPLED;
            plan.image("filter", &image, setup.extent, vk::Format::R16G16B16A16_SFLOAT, usage);
            touches.extend([(image.clone(), written), (image, sampled)]);
        }
        let irradiance = setup.resource("irradiance");
        plan.buffer("filter", &irradiance, setup.irradiance_bytes());
        touches.push((irradiance.clone(), written));
        plan.pass(setup.label.to_owned(), touches);
        irradiance
    }

    fn build(&self, gpu: &Arc<Gpu>, resources: &mut Resources, setup: &FilterSetup<'_>) -> Result<Box<dyn FilterPass>> {
        Ok(Box::new(GaussFast::new(gpu, resources, setup)?))
    }
}

struct GaussFast {
    label: String,
    packed: Image,
    rows: Image,
    irradiance: Buffer,
    pack: GaussPack,
    horizontal: ComputePipeline,
    vertical: ComputePipeline,
    linear: Sampler,
    extent: Extent,
    row_pitch: u32,
    kernel: Kernel,
}

impl GaussFast {
    fn new(gpu: &Arc<Gpu>, resources: &mut Resources, setup: &FilterSetup<'_>) -> Result<Self> {
        let FilterSetup { label, workgroup, extent, row_pitch, kernel, .. } = *setup;
        Ok(Self {
            label: label.to_owned(),
            packed: resources.image(&setup.resource("packed")),
            rows: resources.image(&setup.resource("rows")),
            irradiance: resources.buffer(&setup.resource("irradiance")),
            pack: GaussPack::new(gpu, workgroup)?,
            horizontal: ComputePipeline::new(gpu, &shader::COMP_IMAGE, workgroup)?,
            vertical: ComputePipeline::new(gpu, &shader::COMP_BUFFER, workgroup)?,
            linear: Sampler::clamped(gpu, vk::Filter::LINEAR)?,
            extent,
            row_pitch,
            kernel,
        })
    }

    fn params(&self, horizontal: bool) -> GaussFastParams {
        GaussFastParams {
            width_px: self.extent.width,
            height_px: self.extent.height,
            row_pitch: self.row_pitch,
            horizontal: u32::from(horizontal),
            radius: self.kernel.radius(),
            falloff: self.kernel.falloff(),
        }
    }
}

impl FilterPass for GaussFast {
    fn record(
        &self,
        cmd: &mut Commands,
        source: Edge<'_, Buffer>,
        flags: Edge<'_, Buffer>,
    ) -> Result<Edge<'_, Buffer>> {
        let Self { packed, rows: half_way, irradiance: target, .. } = self;
        let pixels = self.extent.pixel_count();
        // The middle, and a fetch for each pair of taps on either side; a fetch touches two texels.
        let fetches = 1 + 2 * u64::from(self.kernel.radius().div_ceil(2));
        let traffic = Traffic {
            read_bytes: Some(pixels * (8 + 4) + 2 * pixels * fetches * 8),
            written_bytes: Some(3 * pixels * 8),
            invocations: Some(3 * pixels),
        };
        cmd.pass(&self.label, traffic, |cmd| {
            cmd.barriers([
                source.to(Access::ComputeRead),
                flags.to(Access::ComputeRead),
                packed.discard(Access::ComputeWrite),
                half_way.discard(Access::ComputeWrite),
                target.discard(Access::ComputeWrite),
            ]);
            let StopBits { x: stop_bits_x, y: stop_bits_y } = self.kernel.stop_bits;
            let Extent { width: width_px, height: height_px } = self.extent;
            let params = GaussPackParams { width_px, height_px, row_pitch: self.row_pitch, stop_bits_x, stop_bits_y };
            self.pack.record(cmd, &params, source.resource, flags.resource, packed)?;
            cmd.barriers([packed.from(Access::ComputeWrite).to(Access::ComputeSample)]);
            let sampled = |image| Bound::Sampled(image, self.linear.handle, Access::ComputeSample);
            let groups = self.horizontal.groups([self.extent.width, self.extent.height, 1]);
            let params = self.params(true);
            let bound = [("source", sampled(packed)), ("target", Bound::Storage(half_way))];
            cmd.dispatch(&self.horizontal, bytemuck::bytes_of(&params), &bound, groups)?;
            cmd.barriers([half_way.from(Access::ComputeWrite).to(Access::ComputeSample)]);
            let params = self.params(false);
            let bound = [("source", sampled(half_way)), ("Target", Bound::Buffer(target))];
            cmd.dispatch(&self.vertical, bytemuck::bytes_of(&params), &bound, groups)
        })?;
        Ok(target.from(Access::ComputeWrite))
    }

    fn irradiance(&self) -> &Buffer {
        &self.irradiance
    }
}
