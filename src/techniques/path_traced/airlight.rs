//! What light the medium of `--medium` is asked for (glsl/techniques/path_traced/airlight.glsl).

use crate::error::{Error, Result};
use crate::settings::Values;
use crate::shading::medium::Medium;
use crate::techniques::Inputs;
use crate::techniques::path_traced::settings::{Airlight, Transport};

/// What the medium does to the paths of a picture; the number is the shader's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Air {
    None = 0,
    Dims = 1,
    Scatters = 2,
}

impl Air {
    /// Errors: light that a medium scatters is asked for without one, or virtual point lights in one (exit code 2).
    pub fn new(inputs: &Inputs<'_>) -> Result<(Self, Option<Medium>)> {
        let (values, medium) = (inputs.values, inputs.medium());
        let airlight = values.choice("airlight");
        let transport = values.choice("transport");
        let is_scattered = match airlight {
            Airlight::Path => matches!(transport, Transport::SingleScatter | Transport::Full),
            Airlight::Seen => true,
            Airlight::None => false,
        };
        match medium {
            None if transport == Transport::SingleScatter => {
                Err(Error::request("--transport single-scatter: there is no medium that scatters light")
                    .note("--medium 0.1,0,0 is one; without, --transport direct is the same picture"))
            }
            None if airlight != Airlight::Path => {
                let word = airlight.name();
                Err(Error::request(format!("--airlight {word}: there is no medium that scatters light")).note(format!(
                    "--medium 0.1,0,0 is one; without, --airlight {} is the same picture",
                    Airlight::Path.name()
                )))
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

/// Whether a medium scatters nothing but light of lights on the ray that is seen.
pub fn is_seen(values: &Values) -> bool {
    values.is("airlight", Airlight::Seen)
}
