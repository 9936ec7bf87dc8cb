//! A sweep from grid to rows: which points are possible, in which groups they are measured, what is already known.

use super::candidate::{Candidate, require_readers};
use super::frames::Sequence;
use super::group::{Group, Measurement, is_impossible};
use super::head::{Head, Rounds};
use super::machine::{Load, Ticks};
use super::page::picture_file;
use super::reference::References;
use super::rounds::Length;
use super::row::BenchRow;
use super::rows_file::RowsFile;
use super::shard::Shard;
use super::sweep::{self, Axis, NamedPoint, Part};
use super::variant::Variant;
use super::what::What;
use crate::error::{Error, ErrorKind, Result};
use crate::gpu::DeviceRequest;
use crate::interrupt;
use crate::job::{Job, fail_on_validation};
use crate::picture::Picture;
use crate::picture::image_file::{self, WriteOptions};
use crate::picture::tonemap::exposure_for;
use crate::reference::ReferenceRequest;
use crate::sequence::Frames;
use crate::settings::Values;
use crate::whole_file::make_folder;
use std::collections::VecDeque;
use std::path::Path;
use std::rc::Rc;
use std::time::{Instant, SystemTime, UNIX_EPOCH};

/// What is asked for.
pub struct Request<'a> {
    /// Scene, device, and the settings that are not swept.
    pub job: &'a Job,
    pub what: What,
    pub axes: &'a [Axis],
    /// `KEY=VALUE KEY=VALUE`, a point of the grid, or one for each point of the axes that it leaves out; or a point's name. None:
    /// the first that is possible.
    pub baseline: Option<&'a str>,
    /// Rows beside the grid.
    pub points: &'a [NamedPoint],
    /// Rounds, at least one.
    pub repeat: usize,
    /// As `rounds::Length` has it.
    pub until_interval: Option<f64>,
    /// All rows shade as many texels a thread: those of `--texels`, or one. What cannot is skipped.
    pub is_fair: bool,
    /// Measures only rows of its own; None: all of them.
    pub shard: Option<Shard>,
    /// The folder of the sweep, where the picture of each row goes; None: nowhere.
    pub pictures: Option<&'a Path>,
    /// Variants that are measured in turn, beside the baseline; up to `MOST_VARIANTS`. Rows are written when those of a group are
    /// done.
    pub group: usize,
    /// Frames of a sequence instead of one moment: only of `What::Frame`.
    pub frames: Option<&'a Frames>,
    /// No group but the first begins after it: rows that are not there then are left out. None: all are measured.
    pub deadline: Option<Instant>,
}

/// What came out.
#[derive(Debug)]
pub struct Rows {
    /// In the order of the grid: those of this run and those that were kept.
    pub rows: Vec<BenchRow>,
    /// The user stopped it: these are the rows of the groups that ended before.
    pub interrupted: bool,
    /// Whether the gates of the job's reference hold in all rows of this run.
    pub gates: Result<()>,
}

/// Observer of the progress.
pub trait Observer {
    /// A row is known, and written where rows are written.
    ///
    /// Errors: it cannot be shown (exit code 2).
    fn row(&mut self, row: &BenchRow) -> Result<()>;

    /// `done` of `all` steps of equal work, about.
    fn step(&mut self, done: usize, all: usize);

    /// A group has ended: rows that are known now, of how many.
    fn group(&mut self, known: usize, all: usize);
}

/// Measures the grid of `request`; rows that `file` holds already are taken from it, new ones are appended to it.
///
/// Errors: no point is possible, or the baseline is not, or nothing reads what is swept (exit code 2); no device (3); the
/// device fails (4); a picture holds NaN or infinity, or the validation layer has spoken (1).
pub fn run(request: &Request<'_>, file: Option<&mut RowsFile>, observer: &mut dyn Observer) -> Result<Rows> {
    let job = request.job;
    if request.is_fair && request.axes.iter().any(|axis| axis.key == "texels") {
        let why = "--fair: all rows must shade the same number of texels a thread, and --sweep texels= asks for \
                   several numbers";
        return Err(Error::request(why).note("--fair --texels 4 gives them all four"));
    }
    let grid = sweep::with_points(sweep::grid(request.axes), request.points)?;
    let mut parts = sweep::parts(&grid, request.baseline)?;
    // Rows beside the grid may have no axis in common with a baseline: the first stands for them.
    let strays = (0..grid.len()).filter(|index| parts.iter().all(|part| !part.points.contains(index)));
    let strays: Vec<usize> = strays.collect();
    if let Some(first) = parts.first_mut() {
        first.points.extend(strays);
    }
    let scene = job.load_scene()?;
    let (axes, hash) = (request.axes, scene.hash.clone());
    let scene = match request.frames {
        None => scene,
        Some(frames) => job.at(&frames.values(job, frames.first(), None)?).load_scene()?,
    };
    let session = job.open_session(&DeviceRequest { robust: false, ..job.device_request() }, scene)?;
    let sequence = request.frames.map(|frames| Sequence::new(job, frames, &session.gpu)).transpose()?.map(Rc::new);
    let candidate = |NamedPoint { name, point }: &NamedPoint| {
        Candidate::new(job, axes, point, request.is_fair, &hash).named(name.clone())
    };
    let candidates: Vec<Candidate> = grid.iter().map(candidate).collect();
    require_readers(job, axes, &candidates)?;
    if let Some(asked) = &job.reference {
        request.frames.map_or(Ok(()), |_| ReferenceRequest::check_sequence(asked))?;
        for candidate in &candidates {
            let Ok(values) = &candidate.values else { continue };
            asked.check(values.extent("size")).map_err(|error| error.within(&candidate.label))?;
        }
    }
    let Request { what, is_fair, .. } = *request;
    let mut found = Found { rows: vec![None; grid.len()], references: References::default(), gates: Ok(()) };
    let mut interrupted = false;
    let mut file = file;
    for part in &parts {
        let measurement = Measurement { job, session: &session, what, is_fair, sequence: sequence.as_ref() };
        let mut sweep =
            Sweep::start(request, measurement, (&candidates, part), &mut found, file.as_deref_mut(), &mut *observer)?;
        interrupted = match sweep.measure() {
            Err(stop) if stop.kind() == ErrorKind::Interrupted => true,
            done => done.map(|()| false)?,
        };
        if interrupted {
            break;
        }
    }
    let Found { rows, gates, .. } = found;
    let rows = rows.into_iter().flatten().collect();
    let log = session.gpu.validation_log();
    // Closing says what was leaked: only then is the log whole.
    drop(sequence);
    drop(session);
    fail_on_validation(log.as_deref())?;
    Ok(Rows { rows, interrupted, gates })
}

/// What the parts of a sweep leave.
struct Found {
    /// By place in the grid.
    rows: Vec<Option<BenchRow>>,
    references: References,
    gates: Result<()>,
}

/// A part of the grid on its way to rows.
struct Sweep<'a> {
    head: Head<'a>,
    /// The whole grid's.
    candidates: &'a [Candidate],
    /// Those of the part's places in the grid that are asked for.
    points: Vec<usize>,
    /// Place in the grid.
    baseline: usize,
    baseline_variant: Rc<Variant>,
    /// Impossible points found while the baseline was looked for.
    refused: Vec<(usize, Error)>,
    found: &'a mut Found,
    file: Option<&'a mut RowsFile>,
    observer: &'a mut dyn Observer,
    /// As `Request` has them.
    deadline: Option<Instant>,
    most: usize,
    pictures: Option<&'a Path>,
}

impl<'a> Sweep<'a> {
    /// Finds the baseline, and the rows that are kept.
    fn start(
        request: &Request<'a>,
        measurement: Measurement<'a>,
        (candidates, part): (&'a [Candidate], &'a Part),
        found: &'a mut Found,
        file: Option<&'a mut RowsFile>,
        observer: &'a mut dyn Observer,
    ) -> Result<Self> {
        let mut refused = Vec::new();
        let Part { baseline: named, points } = part;
        let tried = named.as_ref().map_or(&points[..], std::slice::from_ref);
        let first = tried.iter().copied().find_map(|index| match possible(&measurement, &candidates[index]) {
            Err(error) if is_impossible(&error) => {
                refused.push((index, error));
                None
            }
            made => Some(made.map(|variant| (index, Rc::new(variant)))),
        });
        let Some(first) = first else {
            let (index, error) = refused.swap_remove(0);
            let label = &candidates[index].label;
            return Err(match named {
                Some(_) => error.within(format!("--baseline {label:?}")),
                None if candidates.len() == 1 => error,
                None => Error::request(format!("none of the {} combinations is possible", candidates.len()))
                    .note(format!("{label}: {}", error.message())),
            });
        };
        let (baseline, baseline_variant) = first?;
        let (repeat, frames) = (request.repeat, request.frames.cloned());
        let until_interval = request.until_interval;
        let head = Head { measurement, repeat, until_interval, baseline: candidates[baseline].label.clone(), frames };
        // A row that was there has the name that this run gives it.
        let kept = |candidate: &Candidate| {
            let row = file.as_ref()?.kept(&head.row(candidate))?.clone();
            Some(BenchRow { name: candidate.name.clone(), ..row })
        };
        let is_own = |index: &usize| request.shard.is_none_or(|shard| shard.has(&head.row(&candidates[*index])));
        let points: Vec<usize> = points.iter().copied().filter(is_own).collect();
        points.iter().for_each(|index| found.rows[*index] = kept(&candidates[*index]));
        let Request { deadline, group: most, pictures, .. } = *request;
        Ok(Self {
            head,
            candidates,
            points,
            baseline,
            baseline_variant,
            refused,
            found,
            file,
            observer,
            deadline,
            most,
            pictures,
        })
    }

    fn measure(&mut self) -> Result<()> {
        for (index, error) in std::mem::take(&mut self.refused) {
            self.skip(index, &error)?;
        }
        let mut waiting: VecDeque<usize> =
            self.points.iter().copied().filter(|index| *index != self.baseline && !self.is_known(*index)).collect();
        let mut is_first = true;
        while !waiting.is_empty() || self.is_missing(self.baseline) {
            if !is_first && self.deadline.is_some_and(|deadline| Instant::now() >= deadline) {
                break;
            }
            is_first = false;
            let group = self.gather(&mut waiting)?;
            if group.members.is_empty() {
                continue;
            }
            self.measure_group(&group)?;
            let known = self.known();
            self.observer.group(known, self.found.rows.len());
        }
        Ok(())
    }

    fn known(&self) -> usize {
        self.found.rows.iter().flatten().count()
    }

    fn is_known(&self, index: usize) -> bool {
        self.found.rows[index].is_some()
    }

    /// Whether its row is asked for and not there.
    fn is_missing(&self, index: usize) -> bool {
        self.points.contains(&index) && !self.is_known(index)
    }

    /// The next group: as many of those that wait as have room.
    fn gather(&mut self, waiting: &mut VecDeque<usize>) -> Result<Group> {
        let mut group = Group::new(&self.baseline_variant, self.most);
        if self.is_missing(self.baseline) {
            let values = self.candidates[self.baseline].values.clone()?;
            let measurement = self.head.measurement.of(&self.candidates[self.baseline]);
            group.add_baseline(&measurement, self.baseline, &self.baseline_variant, &values);
            // In groups of one no row waits for another: its ratio is to itself, and it stands in every group after this.
            if self.most == 1 {
                return Ok(group);
            }
        }
        for (index, error) in group.fill(&self.head.measurement, self.candidates, waiting)? {
            self.skip(index, &error)?;
        }
        Ok(group)
    }

    fn measure_group(&mut self, group: &Group) -> Result<()> {
        let pictures = group.pictures()?;
        let repeat = self.head.repeat;
        let (known, all, members) = (self.known(), self.found.rows.len(), group.members.len());
        let observer = &mut *self.observer;
        let (started, before) = (SystemTime::now(), Ticks::now());
        let length = Length { least: repeat, until_interval: self.head.until_interval };
        let samples = group.measure(length, &mut |done, of| {
            // A step is a round of one variant; what stands beside variants has no steps of its own.
            observer.step(known * repeat + members * repeat * done / of, all * repeat);
        })?;
        let load = before.zip(Ticks::now()).and_then(|(before, after)| Load::between(before, after));
        // Nanoseconds: rows of another run, which --resume keeps, are of another group.
        let since = started.duration_since(UNIX_EPOCH).unwrap_or_default();
        let rounds = Rounds { group: since.as_nanos().to_string(), samples, load };
        for (member, picture) in group.members.iter().zip(&pictures) {
            interrupt::check()?;
            let candidate = &self.candidates[member.candidate];
            let Measurement { job, session, what, .. } = self.head.measurement.of(candidate);
            let values = candidate.values.as_ref().map_err(Error::clone)?;
            let reference = self.found.references.of(job, session, what, values)?;
            let mut row = self.head.measured(candidate, member, picture, &rounds, &reference)?;
            let asked = self.head.measurement.job.reference.as_ref();
            if let Some(sequence) = &member.variant.sequence {
                sequence.fill(&mut row, &rounds.samples[member.probe], &sequence.flicker(asked)?);
            }
            if let Some(asked) = asked {
                let first = |frames: &Frames| frames.values(&job.at(values), frames.first(), None);
                let shown = self.head.frames.as_ref().map(first).transpose()?;
                match asked.judge(picture, job.technique, shown.as_ref().unwrap_or(values), session) {
                    Ok(judged) => {
                        row.errors = Some(judged.errors);
                        let gates = judged.gates.map_err(|error| error.within(&candidate.label));
                        self.found.gates = std::mem::replace(&mut self.found.gates, Ok(())).and(gates);
                    }
                    Err(error) if is_impossible(&error) => row.errors_skipped = Some(error.message().to_owned()),
                    Err(error) => return Err(error),
                }
            }
            if let Some(folder) = self.pictures {
                write_picture(folder, &row, picture, &self.head.measurement.job.values)?;
            }
            self.emit(member.candidate, row)?;
        }
        Ok(())
    }

    fn skip(&mut self, index: usize, error: &Error) -> Result<()> {
        if self.is_missing(index) {
            let row = self.head.skipped(&self.candidates[index], error);
            self.emit(index, row)?;
        }
        Ok(())
    }

    /// A row is written before it is shown.
    fn emit(&mut self, index: usize, row: BenchRow) -> Result<()> {
        if let Some(file) = &mut self.file {
            file.append(&row)?;
        }
        self.observer.row(&row)?;
        self.found.rows[index] = Some(row);
        Ok(())
    }
}

/// Writes the picture of a row as a PNG with the request's own exposure and tone mapping, which are the same for all rows: a file is
/// named by the light, and one that is there has the same.
///
/// Errors: it cannot be written (exit code 2).
fn write_picture(folder: &Path, row: &BenchRow, picture: &Picture, values: &Values) -> Result<()> {
    let Some(file) = picture_file(folder, row).filter(|file| !file.exists()) else { return Ok(()) };
    let parent = file.parent().expect("it is in a folder");
    make_folder(parent)?;
    let exposure_ev =
        values.unless_auto("exposure", Values::number).or_else(|| exposure_for(picture)).unwrap_or_default();
    let options = WriteOptions { exposure_ev, tone_map: values.choice("tonemap"), ..WriteOptions::default() };
    image_file::write(&file, picture, &options)
}

fn possible(measurement: &Measurement<'_>, candidate: &Candidate) -> Result<Variant> {
    let values = candidate.values.as_ref().map_err(Error::clone)?;
    measurement.of(candidate).variant(values)
}
