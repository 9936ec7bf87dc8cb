//! The picture of a technique's plain form (`Technique::plain`): what errors and overheads are measured against. One
//! for each size, camera, scene of lights: what is left of a variant's settings.

use super::candidate::{changed, without_unread};
use super::what::What;
use crate::error::{Error, ErrorKind, Result};
use crate::gpu::commands::Submits;
use crate::job::Job;
use crate::picture::Picture;
use crate::session::{Renderer, Session};
use crate::settings::Values;
use crate::techniques::bench_stage::{PlainForm, flags};
use crate::techniques::{self, Technique};
use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;

/// Frames of a renderer's passes, after one that warms up.
const PASS_FRAMES: usize = 3;

/// The plain form at one size, from one camera, of one set of lights.
pub struct Reference {
    pub picture: Picture,
    /// Nanoseconds, and whose they are; only where whole frames of one run are measured.
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
    /// The reference of a variant with these values, or why there is none: the technique has no plain form, or no
    /// memory is left beside the variants.
    ///
    /// Errors: the device fails (exit code 4).
    pub fn of(&mut self, job: &Job, session: &Session, what: What, values: &Values) -> Result<Found> {
        let Some(form) = job.technique.plain() else { return Ok(Err(without_plain(job.technique))) };
        let plain = match plain(form, job, values) {
            Ok(plain) => plain,
            Err(error) => return Ok(Err(error)),
        };
        let key = format!("{} {plain:?}", job.technique.name());
        if let Some(known) = self.known.get(&key) {
            return Ok(Ok(known.clone()));
        }
        let renderer = match session.renderer(job.technique, &plain, &[], Submits::One) {
            Ok(renderer) => renderer,
            Err(error) => return Ok(Err(error.within(flags(form.settings)))),
        };
        let made = Rc::new(Reference::new(form, (job, session, what), renderer, &plain)?);
        self.known.insert(key, made.clone());
        Ok(Ok(made))
    }
}

/// Why `technique` has no reference.
fn without_plain(technique: &dyn Technique) -> Error {
    let has = |other: &&dyn Technique| Some(format!("{} has {}", other.name(), flags(other.plain()?.settings)));
    let others: Vec<String> = techniques::ALL.iter().filter_map(has).collect();
    Error::request(format!("{} has no plain form to compare with; {}", technique.name(), others.join(", ")))
}

/// `values` of the plain form: what changes nothing of it, and what nothing reads, is at its default, so that a sweep
/// of these has one reference.
///
/// Errors: they are impossible (exit code 2).
fn plain(form: &PlainForm, job: &Job, values: &Values) -> Result<Values> {
    let plain = changed(job, values, form.settings.iter().copied())?;
    let defaults = Job::new(&job.scene, job.technique).values;
    let same = defaults.iter().filter(|(key, _)| form.same_picture.contains(key));
    changed(job, &without_unread(job.technique, &plain), same)
}

impl Reference {
    fn new(
        form: &PlainForm,
        (job, session, what): (&Job, &Session, What),
        renderer: Renderer,
        values: &Values,
    ) -> Result<Self> {
        renderer.frame()?;
        let picture = renderer.picture()?;
        let lights = renderer.counters.get(form.lights_per_pixel).copied().unwrap_or(0.0);
        let is_one_frame = what == What::Frame && !renderer.is_in_parts();
        drop(renderer);
        let passes = if is_one_frame { pass_ms(job, session, values)? } else { None };
        let light = format!("{}.{}", job.technique.name(), form.light_pass);
        let light_ms = |passes: &[(String, f64)]| passes.iter().find(|(name, _)| *name == light).map(|(_, ms)| *ms);
        let cost = match passes {
            None => None,
            Some(passes) => {
                let one_light = changed(job, values, form.one_light.iter().copied())?;
                let light_pass_ms = pass_ms(job, session, &one_light)?.and_then(|passes| light_ms(&passes));
                let evaluations = picture.extent.pixel_count() as f64 * lights;
                let evaluation_ns = 1e6 * light_ms(&passes).unwrap_or(0.0) / evaluations.max(1.0);
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

    #[test]
    fn what_a_picture_without_subsets_does_not_read_has_one_reference() {
        let job = Job::new("cornell", techniques::find("interleaved_deferred").unwrap());
        let form = job.technique.plain().unwrap();
        let of =
            |key: &str, text: &str| plain(form, &job, &changed(&job, &job.values, [(key, text)]).unwrap()).unwrap();
        let first = of("pattern", "2x2");
        assert_eq!(first.text("split"), "none");
        assert_eq!(of("kernel", "7"), first);
        assert_eq!(of("direct-pattern", "2x2"), first);
        assert_eq!(of("split", "branch"), first);
        assert_ne!(of("vpls", "7"), first);
        assert_ne!(of("size", "7x7"), first);
        for key in ["workgroup", "alias"] {
            let other = if key == "alias" { "off" } else { "16x4" };
            assert_eq!(of(key, other), first, "{key}");
        }
        let why = without_plain(techniques::find("deferred").unwrap());
        let told = "deferred has no plain form to compare with; interleaved_deferred has --split none";
        assert_eq!(why.message(), told);
    }
}
