//! What the host has estimated of a component, on its way to the device.
//! reads  upload.irradiance, upload.rays, upload.guidance   host-visible buffers
//! writes rays  buffer, 4 B a texel    guidance  buffer, 4 B a tile, but with `--mode igi`
//!        irradiance  buffer, 8 B a texel

use super::estimate::{self, TileEstimate};
use crate::error::Result;
use crate::gpu::{Access, Buffer, Commands, Traffic};
use crate::memory::kinds::Use;
use crate::plan::{Plan, Resources, Shape};
use crate::techniques::adaptive_interleaved::buffers::ComponentBuffers;
use crate::techniques::adaptive_interleaved::choices::{Choices, ComponentChoice};
use crate::techniques::adaptive_interleaved::components::{Given, HostComponent, Point, Samples};
use crate::techniques::adaptive_interleaved::resources::{IRRADIANCE_BYTES, of_component};
use ash::vk::BufferUsageFlags;
use std::cell::RefCell;

/// Full name of the host's side of a buffer.
fn staged(what: &str, key: &str) -> String {
    of_component(&format!("upload.{what}"), key)
}

/// Plans the host's side of what `plan` has of the component, and the pass.
pub fn plan(plan: &mut Plan, choice: &ComponentChoice, has_guidance: bool) {
    let key = choice.component.name();
    let (texels, tiles) = (choice.extent().pixel_count(), u64::from(choice.params.tile_count));
    let mut written = vec![("irradiance", texels * IRRADIANCE_BYTES), ("rays", texels * 4)];
    written.extend(has_guidance.then_some(("guidance", tiles * 4)));
    for (what, bytes) in &written {
        let shape = Shape::Buffer { bytes: *bytes, flags: BufferUsageFlags::TRANSFER_SRC, usage: Use::Upload };
        plan.push("upload", staged(what, key), shape);
    }
    let touched = written.into_iter().map(|(what, _)| (of_component(what, key), Access::TransferWrite));
    plan.pass(of_component("upload", key), touched);
}

/// A component that the host estimates.
pub struct HostSteps {
    component: Box<dyn HostComponent>,
    irradiance: RefCell<Buffer>,
    rays: RefCell<Buffer>,
    guidance: Option<Guidance>,
}

/// Further iterations of each tile, on both sides.
struct Guidance {
    staged: RefCell<Buffer>,
    own: Buffer,
}

impl HostSteps {
    /// Takes what `plan` put in.
    pub fn new(resources: &mut Resources, choices: &Choices, choice: &ComponentChoice, samples: &Samples) -> Self {
        let key = choice.component.name();
        let mut mapped = |what: &str| RefCell::new(resources.buffer(&staged(what, key)));
        let (irradiance, rays) = (mapped("irradiance"), mapped("rays"));
        let guidance = choices.is_guided().then(|| mapped("guidance"));
        Self {
            component: choice.prepared.host(samples),
            irradiance,
            rays,
            guidance: guidance.map(|staged| Guidance { staged, own: resources.buffer(&of_component("guidance", key)) }),
        }
    }

    /// Further iterations of each tile on the device, a word each; None where no tile has any.
    pub fn guidance(&self) -> Option<&Buffer> {
        self.guidance.as_ref().map(|guidance| &guidance.own)
    }

    /// Estimates the component, and puts what it comes to where the frame takes it from. `points`: of the frame's pixels.
    ///
    /// Errors: Ctrl-C (exit code 130).
    pub fn estimate(&self, given: &Given<'_>, points: &[Point]) -> Result<()> {
        let tiles = estimate::tiles(&*self.component, given, points, self.guidance.is_some())?;
        let (mut irradiance, mut rays) = (self.irradiance.borrow_mut(), self.rays.borrow_mut());
        let irradiance: &mut [[u32; 2]] = bytemuck::cast_slice_mut(irradiance.mapped_mut());
        let rays: &mut [u32] = bytemuck::cast_slice_mut(rays.mapped_mut());
        for texel in tiles.iter().flat_map(|tile| &tile.texels) {
            irradiance[texel.index] = texel.irradiance;
            rays[texel.index] = texel.ray_count;
        }
        if let Some(Guidance { staged, .. }) = &self.guidance {
            let further: Vec<u32> = tiles.iter().map(|TileEstimate { further, .. }| *further).collect();
            staged.borrow_mut().mapped_mut().copy_from_slice(bytemuck::cast_slice(&further));
        }
        Ok(())
    }

    pub fn record(&self, cmd: &mut Commands, buffers: &ComponentBuffers) -> Result<()> {
        let mut pairs = vec![(&self.irradiance, &buffers.irradiance), (&self.rays, &buffers.rays)];
        pairs.extend(self.guidance.as_ref().map(|Guidance { staged, own }| (staged, own)));
        let bytes = pairs.iter().map(|(staged, _)| staged.borrow().bytes).sum();
        let traffic = Traffic { read_bytes: Some(bytes), written_bytes: Some(bytes), invocations: None };
        cmd.pass(&buffers.label("upload"), traffic, |cmd| {
            cmd.barriers(pairs.iter().map(|(_, target)| target.discard(Access::TransferWrite)));
            pairs.iter().for_each(|(staged, target)| cmd.copy_buffer(&staged.borrow(), target));
            Ok(())
        })
    }
}
