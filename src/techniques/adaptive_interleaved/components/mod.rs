//! Components of the light: what each has of its own (Dubla 2009, Listing 1: getSample, contrib,
//! getRefinementInformation, getAdaptiveGuidance, refinementConditions, getIterations). A component is a file here,
//! which makes its samples and uses them on the host, and one in glsl/techniques/adaptive_interleaved/components, which
//! uses them on the device.

mod ao;
mod area_samples;
mod host;
mod id;
mod method;
mod pm;
mod ss;

pub use host::{Estimate, Given, HostComponent, LUMINANCE, Point};
pub use method::{PreparedComponent, Samples};

use super::settings::Component;
use method::ComponentMethod;

impl Component {
    /// What estimates it.
    pub fn method(self) -> &'static dyn ComponentMethod {
        match self {
            Self::Id => &id::IndirectDiffuse,
            Self::Ss => &ss::SoftShadows,
            Self::Pm => &pm::Airlight,
            Self::Ao => &ao::AmbientOcclusion,
        }
    }
}
