//! Edge-aware filters of an irradiance buffer, one file each, and the discontinuities that they stop at.
//!
//! A filter is a `FilterMethod` (what it needs, plans and counts) that builds a `FilterPass` (what it records);
//! `Filter` is the table of them. Names of passes and resources are the technique's: a filter begins them with the
//! label that it is given.

mod all;
pub mod box_filter;
pub mod discontinuity;
pub mod gauss;
pub mod gauss_fast;
pub mod gauss_pack;
pub mod upsample;

pub use all::Filter;

use crate::caps::Ability;
use crate::choice::choices;
use crate::error::Result;
use crate::gpu::shader::structs::WalkParams;
use crate::gpu::{Buffer, Commands, Edge, Gpu};
use crate::plan::{Plan, Resources};
use crate::units::Extent;
use std::sync::Arc;

/// Which discontinuities end a walk: bits of the flags (1: differs from +x, 2: from +y, 4: from +xy).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StopBits {
    pub x: u32,
    pub y: u32,
}

impl StopBits {
    /// Any of the three ends a walk in either direction: the paper's one flag.
    pub const ANY: Self = Self { x: 7, y: 7 };
    /// Only a step in the walk's own direction ends it.
    pub const DIRECTIONAL: Self = Self { x: 1, y: 2 };
}

choices! {
    /// How a walk of the Gaussian ends (`--walk-end`); the same bits.
    pub enum WalkEnd {
        /// The taps beyond weigh nothing.
        "flag" => Flag,
        /// Dynamic branching leaves the loop.
        "branch" => Branch,
    }
}

/// A separable Gaussian's shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kernel {
    /// Taps in one direction: odd, 5 to 17.
    pub taps: u32,
    /// Standard deviation in px.
    pub sigma: f32,
    pub stop_bits: StopBits,
    pub walk_end: WalkEnd,
}

impl Kernel {
    /// Taps on either side of the middle.
    pub fn radius(self) -> u32 {
        self.taps / 2
    }

    /// RADIUS and WALK_BRANCHES of walk.glsl.
    pub fn constants(self) -> [(&'static str, u32); 2] {
        [("RADIUS", self.radius()), ("WALK_BRANCHES", u32::from(self.walk_end == WalkEnd::Branch))]
    }

    /// Weight of the tap `distance_px` beside the middle, whose weight is 1.
    pub fn weight(self, distance_px: u32) -> f32 {
        ((distance_px * distance_px) as f32 * self.falloff()).exp()
    }

    /// The walk along x, or along y, for walk.glsl.
    pub fn walk(self, horizontal: bool) -> WalkParams {
        let weights = |first: u32| [0, 1, 2, 3].map(|next| self.weight(first + next));
        WalkParams {
            weights_near: weights(1),
            weights_far: weights(5),
            stop_bits: if horizontal { self.stop_bits.x } else { self.stop_bits.y },
            _unused: [0; 3],
        }
    }

    /// -1 / (2 sigma^2), in 1/px^2.
    pub fn falloff(self) -> f32 {
        -0.5 / (self.sigma * self.sigma)
    }
}

/// What a filter is made for.
#[derive(Clone, Copy)]
pub struct FilterSetup<'a> {
    /// Name of its pass; its resources' names begin with it.
    pub label: &'a str,
    /// WORKGROUP_X and WORKGROUP_Y.
    pub workgroup: &'a [(&'static str, u32)],
    /// Pixels that are filtered.
    pub extent: Extent,
    /// Texels between the rows of irradiance and flags.
    pub row_pitch: u32,
    pub kernel: Kernel,
    /// How many texels a thread filters, at least 1.
    pub texels: u32,
}

impl FilterSetup<'_> {
    /// Full name of a resource of the filter.
    pub fn resource(&self, what: &str) -> String {
        format!("{}.{what}", self.label)
    }

    /// Bytes of irradiance in frame order: 8 a texel, padding included.
    pub fn irradiance_bytes(&self) -> u64 {
        u64::from(self.row_pitch) * u64::from(self.extent.height) * 8
    }
}

/// One way to filter, before it is built.
pub trait FilterMethod: Sync {
    /// What it needs of a device beyond Vulkan 1.3, and what works without it.
    fn need(&self) -> Option<(Ability, &'static str)> {
        None
    }

    /// Texels that are blended into one, for a kernel of `kernel_taps` along each axis.
    fn taps(&self, kernel_taps: f64) -> f64;

    /// Plans its resources and its pass behind irradiance and flags in frame order, by their names; returns the name of
    /// the filtered irradiance.
    fn plan(&self, plan: &mut Plan, setup: &FilterSetup<'_>, source: String, flags: String) -> String;

    /// Takes what `plan` put in, and makes the pipelines.
    ///
    /// Errors: the device fails (exit code 4).
    fn build(&self, gpu: &Arc<Gpu>, resources: &mut Resources, setup: &FilterSetup<'_>) -> Result<Box<dyn FilterPass>>;
}

/// A filter on the device.
pub trait FilterPass {
    /// Records its pass from irradiance and flags in frame order; says how it left its result.
    fn record(&self, cmd: &mut Commands, source: Edge<'_, Buffer>, flags: Edge<'_, Buffer>)
    -> Result<Edge<'_, Buffer>>;

    /// The filtered irradiance, in frame order.
    fn irradiance(&self) -> &Buffer;
}
