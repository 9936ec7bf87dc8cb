//! The medium of `--medium` as the shader takes it (glsl/techniques/path_traced/airlight.glsl): which light it is asked for,
//! and the box that it fills.

use crate::error::{Error, Result};
use crate::gpu::shader::structs::SampleParams;
use crate::scene::{Light, LightSource};
use crate::shading::medium::Medium;
use crate::techniques::Inputs;
use crate::techniques::path_traced::settings::Transport;

/// What the medium does to the paths of a picture; the number is the shader's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Air {
    None = 0,
    Dims = 1,
    Scatters = 2,
}

impl Air {
    /// Errors: light that a medium has scattered is asked for without one, or virtual point lights in one (exit code 2).
    pub fn new(inputs: &Inputs<'_>) -> Result<(Self, Option<Medium>)> {
        let (values, medium) = (inputs.values, Medium::from_values(inputs.values));
        let transport = values.choice("transport");
        let is_scattered = matches!(transport, Transport::SingleScatter | Transport::Full);
        match medium {
            None if transport == Transport::SingleScatter => {
                Err(Error::request("--transport single-scatter: there is no medium that scatters light")
                    .note("--medium 0.1,0,0 is one; without, --transport direct is the same picture"))
            }
            None => Ok((Self::None, None)),
            Some(_) if !values.is_on("vpl-visibility") => {
                Err(Error::request("--vpl-visibility off: virtual point lights ignore --medium")
                    .note("--vpl-visibility on, or --medium none"))
            }
            Some(medium) if is_scattered && medium.scattering > 0.0 => Ok((Self::Scatters, Some(medium))),
            Some(medium) => Ok((Self::Dims, Some(medium))),
        }
    }
}

/// Writes the medium and its box: around all that is drawn while animations play, the eye, and the lights that are
/// somewhere. Outside it, light from the sun and the sky comes undimmed.
pub fn write<'a>(
    params: &mut SampleParams,
    medium: &Medium,
    inputs: &Inputs<'_>,
    lights: impl Iterator<Item = &'a Light>,
) {
    let mut bounds = inputs.scene.lasting_bounds();
    bounds.include(inputs.view.eye());
    for light in lights {
        if let LightSource::At(position) = light.source() {
            bounds.include(position);
        }
    }
    params.medium_min_ws = bounds.min.extend(0.0).to_array();
    params.medium_max_ws = bounds.max.extend(0.0).to_array();
    params.scattering = medium.scattering as f32;
    params.extinction = medium.extinction() as f32;
    params.asymmetry = medium.asymmetry as f32;
}
