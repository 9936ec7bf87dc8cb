//! The table of all filters: a new one is its file, its shader, a line of the enum and one of each list here.

use super::gauss::GaussMethod;
use super::gauss_fast::GaussFastMethod;
use super::{FilterMethod, FilterPass, FilterSetup};
use crate::caps::Need;
use crate::error::Result;
use crate::gpu::Gpu;
use crate::plan::{Plan, Resources};
use std::sync::Arc;

/// The filter of `--filter`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    None,
    Gauss,
    GaussFast,
}

impl Filter {
    /// Those that filter.
    const ALL: [Self; 2] = [Self::Gauss, Self::GaussFast];

    /// What filters; None: nothing does.
    fn method(self) -> Option<&'static dyn FilterMethod> {
        match self {
            Self::None => None,
            Self::Gauss => Some(&GaussMethod),
            Self::GaussFast => Some(&GaussFastMethod),
        }
    }

    /// The value of `--filter`.
    pub fn from_setting(text: &str) -> Self {
        let is_named = |filter: &Self| filter.method().is_some_and(|method| method.name() == text);
        Self::ALL.into_iter().find(is_named).unwrap_or(Self::None)
    }

    /// What it needs of a device beyond Vulkan 1.3.
    pub fn need(self) -> Option<Need> {
        self.method()?.need()
    }

    /// Texels that are blended into one, for a kernel of `kernel_taps` along each axis; None where nothing is filtered.
    pub fn taps(self, kernel_taps: f64) -> Option<f64> {
        Some(self.method()?.taps(kernel_taps))
    }

    /// Plans its resources and its pass behind irradiance and flags in frame order, by their names; returns the name of
    /// the filtered irradiance, which is `source` where nothing is filtered.
    pub fn plan(self, plan: &mut Plan, setup: &FilterSetup<'_>, source: String, flags: String) -> String {
        match self.method() {
            Some(method) => method.plan(plan, setup, source, flags),
            None => source,
        }
    }

    /// Takes what `plan` put in, and makes the pipelines; None where nothing is filtered.
    pub fn build(
        self,
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        setup: &FilterSetup<'_>,
    ) -> Result<Option<Box<dyn FilterPass>>> {
        self.method().map(|method| method.build(gpu, resources, setup)).transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caps::Ability;

    #[test]
    fn every_filter_has_a_name_of_its_own() {
        for filter in Filter::ALL {
            assert_eq!(Filter::from_setting(filter.method().unwrap().name()), filter);
        }
        assert_eq!(Filter::from_setting("none"), Filter::None);
    }

    #[test]
    fn a_filter_says_what_it_needs_and_how_many_texels_it_blends() {
        let needs = [Filter::None, Filter::Gauss, Filter::GaussFast].map(|filter| filter.need());
        assert!(needs[0].is_none() && needs[1].is_none());
        let need = needs[2].as_ref().unwrap();
        assert_eq!((need.of.as_str(), need.ability), ("--filter gauss-fast", Ability::StoreWordPairs));
        let taps = [Filter::None, Filter::Gauss, Filter::GaussFast].map(|filter| filter.taps(7.0));
        assert_eq!(taps, [None, Some(14.0), Some(14.0)]);
    }
}
