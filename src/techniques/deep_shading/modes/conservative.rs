//! How every pixel that a triangle touches is drawn (`--conservative`). Clarberg & Munkberg 2014, section 4.4.

use crate::caps::Caps;
use crate::choice::choices;
use crate::settings::Values;

choices! {
    /// How every pixel that a triangle touches is drawn (`--conservative`).
    pub enum Conservative {
        /// Its hull from a geometry shader.
        "geometry" => Geometry,
        /// Its hull from vertex shaders.
        "vertex" => Vertex,
        /// By the device.
        "hardware" => Hardware,
        /// Only what it covers the middle of: samples at its rim find no colour.
        "none" => Plain,
    }
}

impl Conservative {
    /// `--conservative`, `auto` resolved.
    pub fn of(values: &Values, caps: &Caps) -> Self {
        // Never the device's own: one GPU has tried it, which left no sample without a colour, but not on hostile triangles.
        let best = if caps.features.geometry_shader { Self::Geometry } else { Self::Vertex };
        values.unless_auto("conservative", Values::choice).unwrap_or(best)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caps::known;
    use crate::techniques::deep_shading::settings::SETTINGS;

    /// A method that nobody has seen run is used only where it is asked for by name.
    #[test]
    fn the_device_s_own_conservative_rasterisation_is_never_taken_by_itself() {
        let caps = |name: &str| known::caps(name).unwrap();
        let of = |caps: &Caps, text: &str| {
            let mut values = Values::defaults(SETTINGS);
            values.set(SETTINGS.iter().find(|row| row.key == "conservative").unwrap(), text).unwrap();
            Conservative::of(&values, caps)
        };
        for gpu in ["amd-navi21", "intel-arc-a770", "nvidia-rtx-2070"] {
            assert!(caps(gpu).conservative.is_some(), "{gpu}");
            assert_eq!(of(&caps(gpu), "hardware"), Conservative::Hardware);
            assert_eq!(of(&caps(gpu), "auto"), Conservative::Geometry);
        }
        assert_eq!(of(&caps("tiler-roadmap-2022"), "auto"), Conservative::Vertex);
    }
}
