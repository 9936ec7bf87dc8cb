//! Whether pixels have samples of their own (`--pixel-samples`).

use crate::choice::choices;
use crate::error::{Error, Result};
use crate::settings::Values;
use crate::techniques::deep_shading::modes::visibility::Visibility;
use crate::techniques::deep_shading::resources::NAME;

choices! {
    /// What places samples in a pixel, on the lens and in time (`--pixel-samples`).
    pub enum PixelSamples {
        /// Tuples, as they are.
        "shared" => Shared,
        /// Tuples whose digits a hash of the pixel turns.
        "own" => Own,
    }
}

impl PixelSamples {
    /// `--pixel-samples`, `auto` resolved.
    ///
    /// Errors: samples of a pixel's own, where tuples are drawn (exit code 2).
    pub fn of(values: &Values, visibility: Visibility) -> Result<Self> {
        let best = if visibility.tests_samples() { Self::Own } else { Self::Shared };
        let chosen = values.unless_auto("pixel-samples", Values::choice).unwrap_or(best);
        if chosen == Self::Own && best == Self::Shared {
            let why = "triangles are drawn as a tuple sees them, for all pixels that have it";
            return Err(Error::request(format!("--pixel-samples own with --visibility {}: {why}", visibility.name()))
                .within(NAME)
                .note("--visibility stochastic and ray look at each sample by itself"));
        }
        Ok(chosen)
    }
}
