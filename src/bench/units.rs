//! Nanoseconds for each unit of a stage's work, as rows and tables have them.

use crate::techniques::bench_stage::Unit;
use serde::{Deserialize, Serialize};

/// None of what a stage's work is not counted in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct UnitTimes {
    /// One light at one pixel.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ns_per_evaluation: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ns_per_pixel: Option<f64>,
    /// One neighbour that a filter reads for a pixel.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ns_per_tap: Option<f64>,
    /// A sample of a pixel.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ns_per_sample: Option<f64>,
    /// An entry of a list.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ns_per_entry: Option<f64>,
    /// A surface that is shaded at one place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ns_per_invocation: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ns_per_triangle: Option<f64>,
    /// A shadow ray.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ns_per_ray: Option<f64>,
}

impl UnitTimes {
    pub fn get(&self, unit: Unit) -> Option<f64> {
        let mut copy = *self;
        *copy.of(unit)
    }

    pub fn set(&mut self, unit: Unit, ns: f64) {
        *self.of(unit) = Some(ns);
    }

    fn of(&mut self, unit: Unit) -> &mut Option<f64> {
        match unit {
            Unit::Evaluation => &mut self.ns_per_evaluation,
            Unit::Pixel => &mut self.ns_per_pixel,
            Unit::Tap => &mut self.ns_per_tap,
            Unit::Sample => &mut self.ns_per_sample,
            Unit::Entry => &mut self.ns_per_entry,
            Unit::Invocation => &mut self.ns_per_invocation,
            Unit::Triangle => &mut self.ns_per_triangle,
            Unit::Ray => &mut self.ns_per_ray,
        }
    }
}

/// Title of the unit's column, and digits after the point.
pub fn column(unit: Unit) -> (&'static str, usize) {
    match unit {
        Unit::Evaluation => ("ns/evaluation", 3),
        Unit::Pixel => ("ns/pixel", 2),
        Unit::Tap => ("ns/tap", 3),
        Unit::Sample => ("ns/sample", 2),
        Unit::Entry => ("ns/entry", 2),
        Unit::Invocation => ("ns/invocation", 2),
        Unit::Triangle => ("ns/triangle", 2),
        Unit::Ray => ("ns/ray", 2),
    }
}
