//! The picture of `--split none`, plain deferred shading of the same lights: what errors and overheads are measured
//! against. One for each size, camera, scene of lights: what is left of a variant's settings.

use super::candidate::{changed, without_unread};
use super::what::What;
use crate::error::{ErrorKind, Result};
use crate::gpu::commands::Submits;
use crate::job::Job;
use crate::picture::Picture;
use crate::session::{Renderer, Session};
use crate::settings::Values;
use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;

/// Frames of a renderer's passes, after one that warms up.
const PASS_FRAMES: usize = 3;

/// Settings that change how a picture without subsets is made, and nothing of it: they are put at their defaults, as what
/// nothing reads is, so that a sweep of them has one reference.
const SAME_PICTURE: &[&str] = &["workgroup", "alias"];

/// Plain deferred shading at one size, from one camera, of one set of lights.
pub struct Reference {
    pub picture: Picture,
    /// Nanoseconds, and whose they are; only where whole frames are measured.
    pub cost: Option<Cost>,
}

/// What its frame costs.
pub struct Cost {
    /// Milliseconds of each of its passes: those that it has too are no overhead of a variant.
    pub pass_ms: BTreeMap<String, f64>,
    /// Nanoseconds for each light at each pixel, where all lights are summed in one pass.
    pub evaluation_ns: f64,
    /// Milliseconds of a pass that shades one light on every pixel, the G-buffer read and the irradiance written for it:
    /// Segovia's unit of overhead (table 3, SNSM).
    pub light_pass_ms: Option<f64>,
}

/// A reference, or why there is none.
pub type Found = Result<Rc<Reference>>;

/// Every reference made so far.
#[derive(Default)]
pub struct References {
    known: HashMap<String, Rc<Reference>>,
}

impl References {
    /// The reference of a variant with these values, or why there is none: the technique has no `--split none`, or no
    /// memory is left beside the variants.
    ///
    /// Errors: the device fails (exit code 4).
    pub fn of(&mut self, job: &Job, session: &Session, what: What, values: &Values) -> Result<Found> {
        let plain = match plain(job, values) {
            Ok(plain) => plain,
            Err(error) => return Ok(Err(error)),
        };
        let key = format!("{} {plain:?}", job.technique.name());
        if let Some(known) = self.known.get(&key) {
            return Ok(Ok(known.clone()));
        }
        let renderer = match session.renderer(job.technique, &plain, &[], Submits::One) {
            Ok(renderer) => renderer,
            Err(error) => return Ok(Err(error.within("--split none"))),
        };
        let made = Rc::new(Reference::new(job, session, what, renderer, &plain)?);
        self.known.insert(key, made.clone());
        Ok(Ok(made))
    }
}

/// `values` without subsets.
///
/// Errors: the technique has no subsets (exit code 2).
fn plain(job: &Job, values: &Values) -> Result<Values> {
    let plain = changed(job, values, [("split", "none")])?;
    let defaults = Job::new(&job.scene, job.technique).values;
    let same = defaults.iter().filter(|(key, _)| SAME_PICTURE.contains(key));
    changed(job, &without_unread(job.technique, &plain), same)
}

impl Reference {
    fn new(job: &Job, session: &Session, what: What, renderer: Renderer, values: &Values) -> Result<Self> {
        renderer.frame()?;
        let picture = renderer.picture()?;
        let lights = renderer.counters.get("subset_lights_per_pixel").copied().unwrap_or(0.0);
        drop(renderer);
        let passes = if what == What::Frame { pass_ms(job, session, values)? } else { None };
        let shade = format!("{}.shade", job.technique.name());
        let shade_ms = |passes: &[(String, f64)]| passes.iter().find(|(name, _)| *name == shade).map(|(_, ms)| *ms);
        let cost = match passes {
            None => None,
            Some(passes) => {
                let one_light = changed(job, values, [("vpls", "1"), ("direct", "none")])?;
                let light_pass_ms = pass_ms(job, session, &one_light)?.and_then(|passes| shade_ms(&passes));
                let evaluations = picture.extent.pixel_count() as f64 * lights;
                let evaluation_ns = 1e6 * shade_ms(&passes).unwrap_or(0.0) / evaluations.max(1.0);
                Some(Cost { pass_ms: passes.into_iter().collect(), evaluation_ns, light_pass_ms })
            }
        };
        Ok(Self { picture, cost })
    }
}

/// Median milliseconds of each device pass of these settings; None where no memory is left for the renderer.
///
/// Errors: the device fails (exit code 4).
pub fn pass_ms(job: &Job, session: &Session, values: &Values) -> Result<Option<Vec<(String, f64)>>> {
    let renderer = match session.renderer(job.technique, values, &[], Submits::PerPass) {
        Err(error) if error.kind() == ErrorKind::Memory => return Ok(None),
        renderer => renderer?,
    };
    renderer.frame()?;
    let frames = (0..PASS_FRAMES).map(|_| renderer.frame()).collect::<Result<Vec<_>>>()?;
    let times = renderer.passes().iter().enumerate().map(|(index, pass)| {
        let samples: Vec<f64> = frames
            .iter()
            .filter_map(|frame| frame.passes[index].figure_ns(renderer.clock()))
            .map(|ns| ns as f64 / 1e6)
            .collect();
        (pass.name.clone(), super::stats::median(&samples))
    });
    Ok(Some(times.collect()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::techniques;

    #[test]
    fn what_a_picture_without_subsets_does_not_read_has_one_reference() {
        let job = Job::new("cornell", techniques::find("interleaved_deferred").unwrap());
        let of = |key: &str, text: &str| plain(&job, &changed(&job, &job.values, [(key, text)]).unwrap()).unwrap();
        let first = of("pattern", "2x2");
        assert_eq!(first.text("split"), "none");
        assert_eq!(of("kernel", "7"), first);
        assert_eq!(of("direct-pattern", "2x2"), first);
        assert_eq!(of("split", "branch"), first);
        assert_ne!(of("vpls", "7"), first);
        assert_ne!(of("size", "7x7"), first);
        let deferred = Job::new("cornell", techniques::find("deferred").unwrap());
        assert!(plain(&deferred, &deferred.values).is_err());
    }
}
