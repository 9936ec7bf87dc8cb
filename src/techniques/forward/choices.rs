//! What forward shading's settings come to, for one scene and one device.

use crate::error::Result;
use crate::passes::forward::ForwardChoices;
use crate::passes::samples::Samples;
use crate::resident::Coverage;
use crate::techniques::Inputs;
use crate::techniques::forward::resources::NAME;

/// The choices that the settings make.
pub struct Choices {
    pub(super) drawing: ForwardChoices,
    /// Runs of a picture along each side of a pixel.
    pub(super) runs_per_side: u32,
}

impl Choices {
    /// Errors: as `ForwardChoices::new`.
    pub(super) fn new(inputs: &Inputs<'_>) -> Result<Self> {
        let values = inputs.values;
        let of = (inputs.scene, inputs.stats, inputs.lights);
        let on = (inputs.caps, inputs.requirements);
        Ok(Self {
            drawing: ForwardChoices::new(NAME, values, of, on, Samples::new(values))?,
            runs_per_side: values.integer("supersample") as u32,
        })
    }

    pub(super) fn coverage(&self) -> Coverage {
        if self.drawing.samples.count * self.runs_per_side > 1 { Coverage::Anywhere } else { Coverage::Middle }
    }
}
