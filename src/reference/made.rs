//! Making a reference: found where it is kept, or rendered, after a trial that says how long it will take.

use super::cache::{Cache, CacheOutcome};
use super::recipe::Recipe;
use crate::error::Result;
use crate::gpu::commands::Submits;
use crate::interrupt;
use crate::picture::Picture;
use crate::progress::Stage;
use crate::session::Session;
use std::time::Duration;

/// Samples a pixel of the trial: enough to drown what a frame costs beside them.
const TRIAL_SAMPLES: u64 = 4;
/// References of fewer trials than this are made without one.
const WORTH_A_TRIAL: u64 = 4;

/// Observer of the making of a reference.
pub trait Watch {
    /// A sentence for the user: a broken file, a picture that cannot be kept.
    fn note(&self, text: &str);

    /// Rendering begins; `estimate` by the trial, None where there was none.
    fn begins(&self, recipe: &Recipe, estimate: Option<Duration>);
}

/// A reference that is there.
pub struct MadeReference {
    pub picture: Picture,
    /// It was kept from an earlier run: nothing was rendered.
    pub was_kept: bool,
}

/// The picture of `recipe`, of what `session` shows: kept, or made and kept. A picture that cannot be kept is noted and
/// used all the same.
///
/// Errors: impossible settings (exit code 2); the device, memory (4); the picture holds NaN or infinity (1); Ctrl-C (130):
/// nothing is kept then.
pub fn reference_picture(
    recipe: &Recipe,
    session: &Session,
    cache: &Cache,
    watch: &dyn Watch,
) -> Result<MadeReference> {
    match cache.find(recipe) {
        CacheOutcome::Whole(picture) => return Ok(MadeReference { picture, was_kept: true }),
        CacheOutcome::Broken(why) => watch.note(&format!("a kept reference is broken and is made again: {why}")),
        CacheOutcome::Nothing => {}
    }
    let estimate = trial(recipe, session)?;
    watch.begins(recipe, estimate);
    let picture = render(recipe, session)?;
    if let Err(error) = cache.keep(recipe, &picture) {
        watch.note(&format!("the reference is used but could not be kept: {}", error.message()));
    }
    Ok(MadeReference { picture, was_kept: false })
}

/// How long rendering will take; None where that is not worth a trial.
fn trial(recipe: &Recipe, session: &Session) -> Result<Option<Duration>> {
    let Some(samples) = recipe.samples().filter(|samples| *samples >= WORTH_A_TRIAL * TRIAL_SAMPLES) else {
        return Ok(None);
    };
    let _stage = Stage::begin("estimating the time that the reference takes");
    let few = recipe.with_samples(TRIAL_SAMPLES)?;
    let renderer = session.renderer(recipe.technique, &few, &[], Submits::One)?;
    // The first frame also pays for what drivers compile.
    renderer.frame()?;
    interrupt::check()?;
    let frame_ns = renderer.frame()?.figure_ns(renderer.clock());
    interrupt::check()?;
    Ok(Some(Duration::from_nanos(frame_ns).mul_f64(samples as f64 / TRIAL_SAMPLES as f64)))
}

fn render(recipe: &Recipe, session: &Session) -> Result<Picture> {
    let _stage = Stage::begin("making the reference");
    let renderer = session.renderer(recipe.technique, &recipe.values, &[], Submits::One)?;
    renderer.frame()?;
    // Ctrl-C may have left samples out.
    interrupt::check()?;
    renderer.picture()
}
