//! What `--texture-limit` would free: advice when memory runs out, by the driver's own numbers.

use super::SceneStats;
use crate::error::{Error, ErrorKind};
use crate::gpu::{Buffer, Gpu, upload};
use crate::memory::Tiling;
use crate::memory::kinds::Use;
use crate::memory::refusal::MemoryDemand;
use crate::plan::{Planned, Shape};
use crate::scene::Scene;
use crate::units::Bytes;

/// Adds to an error of memory which texture limit would have left room for what was refused, and how much it frees: the
/// greatest power of two that would. Other errors, and scenes without a texture, pass unchanged.
pub fn advise(error: Error, gpu: &Gpu, scene: &Scene) -> Error {
    if error.kind() != ErrorKind::Memory {
        return error;
    }
    let Some(refusal) = gpu.memory.take_refusal() else { return error };
    let stats = SceneStats::of(scene);
    let side_px = stats.textures.iter().map(|(extent, _)| extent.width.max(extent.height)).max().unwrap_or(1);
    let Some(largest_power) = (side_px - 1).checked_ilog2() else { return error };
    let Some((_, now_bytes)) = needs(gpu, &stats) else { return error };
    let enough = (0..=largest_power).rev().map(|power| 1 << power).find_map(|limit_px| {
        let (then, then_bytes) = needs(gpu, &SceneStats::with_texture_limit(scene, limit_px))?;
        refusal.fits_with(&then).then(|| (limit_px, now_bytes - then_bytes))
    });
    error.note(match enough {
        Some((limit_px, bytes)) => format!("--texture-limit {limit_px} would free {}", Bytes(bytes)),
        None => {
            format!("no --texture-limit would suffice: all of the scene's textures take {}", Bytes(now_bytes))
        }
    })
}

/// What each of the scene's resources needs, and the staging buffer that fills it; and the sum of what the driver requires for the
/// textures themselves. None where a memory type is missing.
fn needs(gpu: &Gpu, stats: &SceneStats) -> Option<(Vec<MemoryDemand>, u64)> {
    let resident = |planned: &Planned| {
        let (requirements, usage, tiling) = match planned.shape {
            Shape::Buffer { bytes, flags, usage } => (Buffer::requirements(gpu, bytes, flags), usage, Tiling::Linear),
            Shape::Image(description) => (description.requirements(gpu), Use::Device, description.tiling(gpu)),
        };
        let ask = gpu.memory.ask(&requirements, usage, tiling).ok()?;
        Some(MemoryDemand { name: planned.name.clone(), ask, is_transient: false })
    };
    let staging = |planned: &Planned| {
        let requirements = Buffer::requirements(gpu, planned.bytes(), upload::STAGING);
        let ask = gpu.memory.ask(&requirements, Use::Upload, Tiling::Linear).ok()?;
        Some(MemoryDemand { name: upload::staging_name(&planned.name), ask, is_transient: true })
    };
    let plan = stats.plan();
    let mut all = plan.resources.iter().map(resident).collect::<Option<Vec<MemoryDemand>>>()?;
    let is_texture = |planned: &Planned| matches!(planned.shape, Shape::Image(_));
    let textures = plan.resources.iter().zip(&all).filter(|(planned, _)| is_texture(planned));
    let texture_bytes = textures.map(|(_, demand)| demand.ask.bytes).sum();
    for planned in &plan.resources {
        all.push(staging(planned)?);
    }
    Some((all, texture_bytes))
}
