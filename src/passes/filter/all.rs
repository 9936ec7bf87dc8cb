//! The table of all filters: a new one is its file, its shader, and a line each of the enum and of `method`.

use super::gauss::GaussMethod;
use super::gauss_fast::GaussFastMethod;
use super::{FilterMethod, FilterPass, FilterSetup};
use crate::caps::Need;
use crate::choice::choices;
use crate::error::Result;
use crate::gpu::Gpu;
use crate::plan::{Plan, Resources};
use std::sync::Arc;

choices! {
    /// The filter of the interleaved irradiance (`--filter`).
    pub enum Filter {
        "gauss" => Gauss,
        "gauss-fast" => GaussFast,
        "none" => None,
    }
}

impl Filter {
    /// What filters; None: nothing does.
    fn method(self) -> Option<&'static dyn FilterMethod> {
        match self {
            Self::None => None,
            Self::Gauss => Some(&GaussMethod),
            Self::GaussFast => Some(&GaussFastMethod),
        }
    }

    /// What it needs of a device beyond Vulkan 1.3.
    pub fn need(self) -> Option<Need> {
        let (ability, instead) = self.method()?.need()?;
        Some(Need { of: format!("--filter {}", self.name()), ability, instead })
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
    fn a_filter_says_what_it_needs_and_how_many_texels_it_blends() {
        let needs = [Filter::None, Filter::Gauss, Filter::GaussFast].map(|filter| filter.need());
        assert!(needs[0].is_none() && needs[1].is_none());
        let need = needs[2].as_ref().unwrap();
        assert_eq!((need.of.as_str(), need.ability), ("--filter gauss-fast", Ability::StoreWordPairs));
        let taps = [Filter::None, Filter::Gauss, Filter::GaussFast].map(|filter| filter.taps(7.0));
        assert_eq!(taps, [None, Some(14.0), Some(14.0)]);
    }
}
