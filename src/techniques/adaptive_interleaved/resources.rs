//! The technique's name, which begins those of its passes and of what it holds.

pub const NAME: &str = "adaptive_interleaved";

/// The finished picture.
pub const COLOR: &str = "adaptive_interleaved.composite.color";

/// Irradiance of all components as it lights the frame, one behind the other, each in frame order, 8 B a pixel.
pub const FILTERED: &str = "adaptive_interleaved.filter.irradiance";

/// An empty list of virtual point lights.
pub const NO_VPLS: &str = "adaptive_interleaved.vpls";

/// A component's buffer of what each of its tiles asks for by itself, where that is not all that guides it.
pub const OWN_GUIDANCE: &str = "guidance.own";

/// Bytes of a texel's irradiance.
pub const IRRADIANCE_BYTES: u64 = 8;

/// Full name of a resource or a pass of a component, whose key ends it.
pub fn of_component(what: &str, key: &str) -> String {
    format!("{NAME}.{what}.{key}")
}
