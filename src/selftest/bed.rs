//! The device that cases run on, with one scene at a time; a device that is lost is opened again for the case that
//! comes next.

use super::case::{self, Place};
use crate::caps::{Caps, Need};
use crate::error::{Error, ErrorKind, Result};
use crate::gpu::commands::Submits;
use crate::gpu::timing::Clock;
use crate::gpu::validation::Message;
use crate::gpu::{DeviceRequest, Gpu};
use crate::memory::Strategy;
use crate::memory::touched::Touched;
use crate::picture::Picture;
use crate::session::{Renderer, Session};
use crate::settings::Values;
use crate::techniques::{Technique, fitness};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What a method's run left.
#[derive(Clone, Debug)]
pub struct Rendered {
    pub picture: Picture,
    pub counters: BTreeMap<&'static str, f64>,
    /// The frame's time from submit to fence; and by the device's clock, where that is read.
    pub wall_ns: u64,
    pub device_ns: Option<u64>,
}

/// What a device lacks for a method, by name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// The setting or the part of a frame that lacks it.
    pub of: String,
    pub needs: String,
    pub instead: String,
}

/// A picture, or why there can be none.
#[derive(Clone, Debug)]
pub enum RenderOutcome {
    Rendered(Rendered),
    Refused(Refusal),
}

/// Technique and settings in a place.
pub type RenderRequest<'a> = (Place, &'a str, &'a [(&'static str, &'static str)]);

/// What decides a picture: place, technique and settings.
type Key = (Place, String, Vec<(&'static str, &'static str)>);

pub struct Bed {
    request: DeviceRequest,
    caps: Caps,
    gpu: Option<Arc<Gpu>>,
    /// What it shows, by place and shutter.
    session: Option<((Place, String), Session)>,
    /// The last twin, which the methods of a group share.
    twin: Option<(Key, Result<RenderOutcome>)>,
    /// What the validation layer said while devices were closed.
    last_words: Vec<Message>,
}

impl Bed {
    /// Errors: no loader, driver or fitting device (exit code 3); the validation layer is missing (2).
    pub fn new(request: &DeviceRequest) -> Result<Self> {
        let gpu = Gpu::open(request)?;
        Ok(Self {
            request: request.clone(),
            caps: gpu.caps.clone(),
            gpu: Some(gpu),
            session: None,
            twin: None,
            last_words: Vec::new(),
        })
    }

    pub fn caps(&self) -> &Caps {
        &self.caps
    }

    /// The device, opened again where it was given up, kept its memory otherwise, or did not count what this one counts.
    ///
    /// Errors: it cannot be opened again (exit code 4).
    pub fn gpu(&mut self, strategy: Strategy, touched: Touched) -> Result<Arc<Gpu>> {
        if (strategy, touched) != (self.request.strategy, self.request.touched) {
            self.give_up();
            self.request = DeviceRequest { strategy, touched, ..self.request.clone() };
        }
        if self.gpu.is_none() {
            let again = Gpu::open(&self.request);
            // It was there before: its loss is not something that the method needs.
            let again = again.map_err(|error| Error::device(format!("opening the device again: {error}")))?;
            self.gpu = Some(again);
        }
        Ok(self.gpu.clone().expect("it was opened above"))
    }

    /// Renders a frame; a device that fails is given up. Settings of cases can be: what refuses them as a bad request is a
    /// limit of the device.
    ///
    /// Errors: NaN, memory, a device that fails (exit codes 1 and 4).
    pub fn render(&mut self, request: RenderRequest<'_>) -> Result<RenderOutcome> {
        let made = self.try_render(request);
        match made {
            Err(error) if matches!(error.kind(), ErrorKind::NoDevice | ErrorKind::Request) => {
                Ok(RenderOutcome::Refused(Refusal {
                    of: request.1.to_owned(),
                    needs: error.message().to_owned(),
                    instead: String::new(),
                }))
            }
            Err(error) if error.kind() == ErrorKind::Device => {
                self.give_up();
                Err(error)
            }
            made => made,
        }
    }

    /// The same, made once for consecutive calls that need it.
    ///
    /// Errors: as `render`.
    pub fn twin(&mut self, request: RenderRequest<'_>) -> Result<RenderOutcome> {
        let (place, technique, settings) = request;
        let key = (place, technique.to_owned(), settings.to_vec());
        if let Some((_, made)) = self.twin.as_ref().filter(|(of, _)| *of == key) {
            return made.clone();
        }
        let made = self.render(request);
        self.twin = Some((key, made.clone()));
        made
    }

    fn try_render(&mut self, (place, technique, settings): RenderRequest<'_>) -> Result<RenderOutcome> {
        let job = case::job(place, technique, settings)?;
        let session = self.showing(place, &job.values, technique)?;
        if let Some(need) = unmet(job.technique, &job.values, session) {
            let Need { of, ability, instead } = need;
            return Ok(RenderOutcome::Refused(Refusal {
                of,
                needs: ability.name().to_owned(),
                instead: instead.to_owned(),
            }));
        }
        let renderer = session.renderer(job.technique, &job.values, &[], Submits::One)?;
        let time = renderer.frame()?;
        let device_ns = if renderer.clock() == Clock::Timestamps { time.device_ns } else { None };
        let (picture, counters) = (renderer.picture()?, renderer.measured_counters()?);
        Ok(RenderOutcome::Rendered(Rendered { picture, counters, wall_ns: time.wall_ns, device_ns }))
    }

    /// A renderer with a submit a pass, in place of the method's.
    ///
    /// Errors: as `Session::renderer`, and as `gpu`.
    pub fn profiled(&mut self, (place, technique, settings): RenderRequest<'_>) -> Result<Renderer> {
        let job = case::job(place, technique, settings)?;
        self.showing(place, &job.values, technique)?.renderer(job.technique, &job.values, &[], Submits::PerPass)
    }

    /// The place as the settings have it: while a shutter is open and with a volume in it, too.
    fn showing(&mut self, place: Place, values: &Values, technique: &str) -> Result<&Session> {
        let gpu = self.gpu(values.choice("allocation"), values.choice("touched"))?;
        let of_scene = ["shutter", "volume"].map(|key| values.get(key).unwrap_or("none"));
        let key = (place, of_scene.join(" "));
        if self.session.as_ref().is_none_or(|(of, _)| *of != key) {
            self.session = None;
            let scene = match place {
                Place::Formula(form) => form.scene(),
                Place::Scene(_) => {
                    let mut job = case::job(place, technique, &[])?;
                    job.values = values.clone();
                    job.load_scene()?
                }
            };
            self.session = Some((key, Session::on(gpu, scene)?));
        }
        Ok(&self.session.as_ref().expect("it was made above").1)
    }

    /// What the validation layer has said since the last call.
    pub fn messages(&self) -> Vec<Message> {
        self.gpu.as_ref().map(|gpu| gpu.take_validation_messages()).unwrap_or_default()
    }

    /// Closes the device, and keeps what is said of it then.
    fn give_up(&mut self) {
        (self.session, self.twin) = (None, None);
        let log = self.gpu.take().and_then(|gpu| gpu.validation_log());
        self.last_words.extend(log.into_iter().flat_map(|log| log.take()));
    }

    /// Closes the device for good; what the validation layer said while that and others closed.
    pub fn close(mut self) -> Vec<Message> {
        self.give_up();
        self.last_words
    }
}

/// The first of what the settings need that the device lacks.
fn unmet(technique: &dyn Technique, values: &Values, session: &Session) -> Option<Need> {
    fitness::unmet(technique, values, &session.gpu.caps, session.stats.has_blend).into_iter().next()
}
