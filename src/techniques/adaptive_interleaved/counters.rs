//! Where the rays went: numbers that a frame leaves, read back after it.

use super::frame::AdaptiveFrame;
use super::settings::Component;
use super::steps::ComponentSteps;
use crate::error::Result;
use crate::gpu::shader::techniques::adaptive_interleaved::bins::REFINE_LANES;
use crate::gpu::{Access, Buffer, Gpu, readback};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Keys of a component's counters: rays a pixel, iterations a texel, the part of the tiles that refine, and the part of
/// the refinement's lanes that wait for others.
struct Keys {
    rays: &'static str,
    iterations: &'static str,
    refined: &'static str,
    idle: &'static str,
}

macro_rules! keys {
    ($key:literal) => {
        Keys {
            rays: concat!("rays_", $key),
            iterations: concat!("iterations_", $key),
            refined: concat!("tiles_refined_", $key),
            idle: concat!("lanes_idle_", $key),
        }
    };
}

impl Component {
    fn keys(self) -> Keys {
        match self {
            Self::Id => keys!("id"),
            Self::Ss => keys!("ss"),
            Self::Pm => keys!("pm"),
            Self::Ao => keys!("ao"),
        }
    }
}

/// Errors: memory for the copies (exit code 4).
pub fn read(frame: &AdaptiveFrame, gpu: &Arc<Gpu>) -> Result<BTreeMap<&'static str, f64>> {
    let mut counters = BTreeMap::new();
    let pixels = frame.gbuffer.extent().pixel_count() as f64;
    let mut all_rays = 0.0;
    for steps in &frame.components {
        let keys = steps.buffers.component.keys();
        let rays: f64 = words(gpu, &steps.buffers.rays, steps.last_write())?.into_iter().map(f64::from).sum();
        all_rays += rays / pixels;
        let further = further_iterations(steps, gpu)?;
        let refined_count = further.iter().filter(|further| **further > 0).count();
        counters.insert(keys.rays, rays / pixels);
        counters.insert(keys.iterations, mean_iterations(steps, &further));
        counters.insert(keys.refined, refined_count as f64 / further.len() as f64);
        if !steps.is_on_host() {
            counters.insert(keys.idle, idle_part(further, steps.tile_lanes));
        }
    }
    counters.insert("rays", all_rays);
    Ok(counters)
}

/// Further iterations of each tile: 0 where nothing guides.
///
/// Errors: memory for the copy (exit code 4).
pub fn further_iterations(steps: &ComponentSteps, gpu: &Arc<Gpu>) -> Result<Vec<u32>> {
    match steps.guidance() {
        Some(guidance) => words(gpu, guidance, steps.last_write()),
        None => Ok(vec![0; steps.buffers.params.tile_count as usize]),
    }
}

/// A buffer of words, which `last` touched last.
///
/// Errors: memory for the copy (exit code 4).
pub fn words(gpu: &Arc<Gpu>, buffer: &Buffer, last: Access) -> Result<Vec<u32>> {
    let bytes = readback::buffer(gpu, buffer, buffer.bytes, last)?;
    Ok(bytemuck::pod_collect_to_vec(&bytes))
}

/// Mean over the component's texels.
fn mean_iterations(steps: &ComponentSteps, further: &[u32]) -> f64 {
    let params = &steps.buffers.params;
    let iterations = (0u32..)
        .zip(further)
        .map(|(tile, further)| params.texels_of(tile).count() as f64 * f64::from(params.base + further));
    iterations.sum::<f64>() / (f64::from(params.width) * f64::from(params.height))
}

/// Part of the lanes' time in the refinement in which they wait for the slowest of their workgroup: tiles are listed by
/// their iterations, the most first, and `tile_lanes` lanes of a workgroup have one.
fn idle_part(mut further: Vec<u32>, tile_lanes: u32) -> f64 {
    further.retain(|further| *further > 0);
    further.sort_unstable_by(|one, other| other.cmp(one));
    let lanes: Vec<u32> =
        further.iter().flat_map(|further| std::iter::repeat_n(*further, tile_lanes as usize)).collect();
    let (mut busy, mut held) = (0u64, 0u64);
    for group in lanes.chunks(REFINE_LANES as usize) {
        busy += group.iter().copied().map(u64::from).sum::<u64>();
        held += u64::from(group[0]) * u64::from(REFINE_LANES);
    }
    if held > 0 { 1.0 - busy as f64 / held as f64 } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_wait_where_a_workgroup_has_several_lengths_and_behind_the_last_tile() {
        assert_eq!(idle_part(vec![0, 0], 4), 0.0);
        assert_eq!(idle_part(vec![3; 16], 4), 0.0);
        // Half of the only workgroup.
        assert_eq!(idle_part(vec![3, 0, 3, 3, 3, 3, 3, 3, 3], 4), 0.5);
        // Sorted, the first workgroup has 8 throughout, the second 1.
        let mixed: Vec<u32> = (0..32).map(|tile| if tile % 2 == 0 { 8 } else { 1 }).collect();
        assert_eq!(idle_part(mixed, 4), 0.0);
        assert_eq!(idle_part([vec![2; 8], vec![1; 8]].concat(), 4), 0.25);
    }
}
