//! A group: the baseline and a few variants that are on the device together, with what their copies are compared with.

use super::candidate::{Candidate, changed};
use super::copy::BufferCopy;
use super::frames::{Sequence, VariantSequence};
use super::rounds::{self, Length, Probe, Samples};
use super::variant::Variant;
use super::what::What;
use crate::error::{Error, ErrorKind, Result};
use crate::interrupt;
use crate::job::Job;
use crate::picture::Picture;
use crate::session::Session;
use crate::settings::Values;
use crate::techniques::bench_stage::{BenchStage, Copying};
use std::collections::{HashMap, VecDeque};
use std::rc::Rc;

/// Variants in a group beside the baseline: pairs need company, and a long sweep must not need the memory of all its variants. Copies
/// have an identity each, and five of them stand in one group with their baseline, so that their own ratios are known.
pub const MOST_VARIANTS: usize = 10;

/// Place of the baseline among the probes.
pub const BASELINE: usize = 0;

/// The place among the probes of what stands beside a variant, or why it cannot.
pub type Companion = Result<usize>;

/// A variant in its group.
pub struct Member {
    /// Place in the grid.
    pub candidate: usize,
    pub variant: Rc<Variant>,
    /// Place among the probes.
    pub probe: usize,
    /// The same kernel moving each texel to its own place; for copying stages only.
    pub identity: Option<Companion>,
    /// vkCmdCopyBuffer of as many bytes; for copying stages only.
    pub copy: Option<Companion>,
}

/// The variants that are measured in turn.
pub struct Group {
    probes: Vec<Rc<dyn Probe>>,
    pub members: Vec<Member>,
    renderer_count: usize,
    /// Renderers on the device at once.
    most_renderers: usize,
    identities: HashMap<String, Companion>,
    copies: HashMap<u64, Companion>,
}

/// What rounds of a group need to know.
pub struct Measurement<'a> {
    /// The request, or one of its candidates.
    pub job: &'a Job,
    pub session: &'a Session,
    pub what: What,
    /// All variants shade as many texels a thread as `--texels` says.
    pub is_fair: bool,
    /// None without `--frames`; with it, `session` shows its first frame.
    pub sequence: Option<&'a Rc<Sequence>>,
}

impl<'a> Measurement<'a> {
    /// The same for a candidate.
    pub fn of(&self, candidate: &'a Candidate) -> Measurement<'a> {
        Measurement { job: &candidate.job, ..*self }
    }

    /// Makes a variant.
    ///
    /// Errors: as `Variant::new` has them; it cannot be fair (exit code 2).
    pub fn variant(&self, values: &Values) -> Result<Variant> {
        let mut variant = Variant::new(self.session, self.job.technique, self.what, values)?;
        variant.sequence = self.sequence.map(|sequence| VariantSequence::new(sequence, self.job.at(values)));
        if self.is_fair {
            variant.require_texels(values)?;
        }
        Ok(variant)
    }
}

impl Group {
    /// A group with the baseline, which is measured in every group and is a member of one, and with `most` variants beside it,
    /// what they are compared with among them.
    pub fn new(baseline: &Rc<Variant>, most: usize) -> Self {
        Self {
            probes: vec![baseline.clone()],
            members: Vec::new(),
            renderer_count: 1,
            most_renderers: 1 + most,
            identities: HashMap::new(),
            copies: HashMap::new(),
        }
    }

    /// Whether a variant, and its identity, still have a place.
    fn has_room(&self, what: What) -> bool {
        let next = 1 + usize::from(what.copies());
        self.members.is_empty() || self.renderer_count + next <= self.most_renderers
    }

    /// Adds the baseline as a member.
    pub fn add_baseline(
        &mut self,
        measurement: &Measurement<'_>,
        candidate: usize,
        variant: &Rc<Variant>,
        values: &Values,
    ) {
        let [identity, copy] = self.companions(measurement, variant, values);
        self.members.push(Member { candidate, variant: variant.clone(), probe: BASELINE, identity, copy });
    }

    /// Makes a variant and adds it.
    ///
    /// Errors: as `Measurement::variant` has them; and where others are in the group, memory for what stands beside it (exit
    /// code 4): with fewer of them there may be enough.
    fn add(&mut self, measurement: &Measurement<'_>, candidate: usize, values: &Values) -> Result<()> {
        let variant = Rc::new(measurement.variant(values)?);
        let [identity, copy] = self.companions(measurement, &variant, values);
        if !self.members.is_empty() {
            let refused = [&identity, &copy].into_iter().flatten().filter_map(|companion| companion.as_ref().err());
            if let Some(error) = refused.into_iter().find(|error| is_of_memory(error)) {
                return Err(error.clone());
            }
        }
        self.renderer_count += 1;
        let probe = self.push(variant.clone());
        self.members.push(Member { candidate, variant, probe, identity, copy });
        Ok(())
    }

    /// Adds as many of those that wait as have room, at least one where one is possible. Returns those that are impossible.
    ///
    /// Errors: the device fails (exit code 4); interrupted (130).
    pub fn fill(
        &mut self,
        measurement: &Measurement<'_>,
        candidates: &[Candidate],
        waiting: &mut VecDeque<usize>,
    ) -> Result<Vec<(usize, Error)>> {
        let mut refused = Vec::new();
        while self.has_room(measurement.what)
            && let Some(index) = waiting.front().copied()
        {
            interrupt::check()?;
            let candidate = &candidates[index];
            let added = match &candidate.values {
                Ok(values) => self.add(&measurement.of(candidate), index, values),
                Err(error) => Err(error.clone()),
            };
            match added {
                Ok(()) => {}
                // It may fit where fewer are.
                Err(error) if is_of_memory(&error) && !self.members.is_empty() => break,
                Err(error) if is_impossible(&error) => refused.push((index, error)),
                Err(error) => return Err(error),
            }
            waiting.pop_front();
        }
        Ok(refused)
    }

    /// Identity and copy, of a copying stage.
    fn companions(
        &mut self,
        measurement: &Measurement<'_>,
        variant: &Variant,
        values: &Values,
    ) -> [Option<Companion>; 2] {
        let Some(copying) = variant.stage.and_then(BenchStage::copying) else { return [None, None] };
        [Some(self.identity(measurement, copying, values)), Some(self.copy(measurement, variant.result_bytes()))]
    }

    fn push(&mut self, probe: Rc<dyn Probe>) -> usize {
        self.probes.push(probe);
        self.probes.len() - 1
    }

    /// Variants that differ only in what the identity settles share it.
    fn identity(&mut self, measurement: &Measurement<'_>, copying: &Copying, values: &Values) -> Companion {
        let identity = identity_values(measurement.job, copying, values)?;
        let key = format!("{identity:?}");
        if let Some(known) = self.identities.get(&key) {
            return known.clone();
        }
        // It shades nothing that is timed: it need not be fair.
        let made =
            Variant::new(measurement.session, measurement.job.technique, measurement.what, &identity).map(|variant| {
                self.renderer_count += 1;
                self.push(Rc::new(variant))
            });
        self.identities.insert(key, made.clone());
        made
    }

    fn copy(&mut self, measurement: &Measurement<'_>, bytes: u64) -> Companion {
        if let Some(known) = self.copies.get(&bytes) {
            return known.clone();
        }
        let made = BufferCopy::new(&measurement.session.gpu, bytes).map(|copy| self.push(Rc::new(copy)));
        self.copies.insert(bytes, made.clone());
        made
    }

    /// A whole frame of each member, which compiles its shaders: the members' pictures, in their order.
    ///
    /// Errors: the device fails (exit code 4); interrupted (130).
    pub fn pictures(&self) -> Result<Vec<Picture>> {
        let picture = |member: &Member| {
            interrupt::check()?;
            member.variant.renderer.frame()?;
            member.variant.renderer.picture()
        };
        self.members.iter().map(picture).collect()
    }

    /// Samples of each probe; errors as `rounds::run` has them.
    pub fn measure(&self, length: Length, progress: &mut dyn FnMut(usize, usize)) -> Result<Vec<Samples>> {
        let probes: Vec<&dyn Probe> = self.probes.iter().map(Rc::as_ref).collect();
        rounds::run(&probes, length, progress)
    }
}

/// Whether a variant that fails like this, before a frame ran, is passed over with its reason.
pub fn is_impossible(error: &Error) -> bool {
    matches!(error.kind(), ErrorKind::Request | ErrorKind::NoDevice | ErrorKind::Memory)
}

/// Whether fewer renderers on the device might help.
fn is_of_memory(error: &Error) -> bool {
    error.kind() == ErrorKind::Memory
}

/// The settings of the identity: the same kernel and storage, moving each texel to its own place.
fn identity_values(job: &Job, copying: &Copying, values: &Values) -> Result<Values> {
    let identity = changed(job, values, copying.identity_settings.iter().copied()).map_err(|error| {
        Error::request(format!("there is no copy at {} to compare with: {}", copying.identity, error.message()))
    })?;
    Ok(changed(job, &identity, copying.spare.iter().copied()).unwrap_or(identity))
}
