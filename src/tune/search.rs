//! The search: pictures first, then the times of those candidates whose pictures are near enough.

use super::halving::{FIRST_ROUNDS, Rung, halve};
use super::judge::Judge;
use super::request::Request;
use super::shown::{Counts, Shown};
use super::space::Space;
use super::stand::Stand;
use crate::bench::candidate::{Candidate, require_readers};
use crate::bench::group::Measurement;
use crate::bench::sweep::Point;
use crate::bench::what::What;
use crate::error::{Error, Result};
use crate::gpu::DeviceRequest;
use crate::job::fail_on_validation;
use crate::picture::Picture;
use crate::progress::say;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::time::Instant;

/// Candidates that are left when halving ends.
const FINALISTS: usize = 4;
/// As many candidates are measured, if there are so many, however few a share of all of them is.
const LEAST_DRAWN: usize = 24;
/// The search takes this part of the frames that measuring all candidates would.
const SHARE_OF_SWEEP: f64 = 0.1;
/// Frames that a drawn candidate costs, all rungs together, the baseline's part among them (a test counts them).
const FRAMES_A_DRAWN: f64 = 3.7;
/// Parts of the time after which nothing more is measured: pictures, candidates for the first time, candidates again.
const PICTURES_UNTIL: f64 = 0.3;
const FIRST_UNTIL: f64 = 0.55;
const AGAIN_UNTIL: f64 = 0.75;
/// Members of a class that are tried until one can be measured: many a combination is refused when it is made.
const MOST_TRIED: usize = 8;

/// What the search left, before its result is measured as rows.
pub struct Found {
    pub space: Space,
    /// The fastest first, at least one.
    pub finalists: Vec<usize>,
    pub counts: Counts,
    pub shown: Vec<Shown>,
    pub rungs: Vec<Rung>,
}

/// Rounds with warm-up and picture, of all candidates: what a full sweep would take.
fn sweep_frames(candidates: usize, repeat: usize) -> usize {
    candidates * (repeat + 2)
}

/// How many candidates are measured.
fn drawn_count(candidates: usize, neighbours: usize, repeat: usize) -> usize {
    let share = SHARE_OF_SWEEP * sweep_frames(candidates, repeat) as f64;
    let last = sweep_frames(neighbours + FINALISTS, repeat) as f64;
    candidates.min(LEAST_DRAWN.max(((share - last) / FRAMES_A_DRAWN).max(0.0) as usize))
}

/// Errors: as `tune`.
pub fn search(request: &Request<'_>, begun: Instant) -> Result<Found> {
    let job = request.job;
    let scene = job.load_scene()?;
    let hash = scene.hash.clone();
    let space = Space::new(job, request.axes, &hash)?;
    require_readers(job, request.axes, &space.candidates)?;
    say(format!(
        "{} combinations, {} that differ, {} pictures",
        space.combinations,
        space.candidates.len(),
        space.classes.len()
    ));
    let session = job.open_session(&DeviceRequest { robust: false, ..job.device_request() }, scene)?;
    let asked = Candidate::new(job, &[], &Point::new(), false, &hash);
    let asked_values = asked.values.as_ref().map_err(Error::clone)?;
    let measurement = Measurement { job, session: &session, what: What::Frame, is_fair: false, sequence: None };
    let baseline = Rc::new(measurement.variant(asked_values)?);
    let mut stand = Stand {
        measurement,
        candidates: &space.candidates,
        baseline,
        first_until: begun + request.time.mul_f64(FIRST_UNTIL),
        again_until: begun + request.time.mul_f64(AGAIN_UNTIL),
        frames: 0,
        refused: Vec::new(),
    };
    let mut judge = Judge::new(job, &session, request.bounds);
    let mut known = BTreeMap::new();
    let until = begun + request.time.mul_f64(PICTURES_UNTIL);
    let shown = look(&space, &mut stand, until, &mut judge, &mut known)?;
    let near: Vec<usize> = (0..shown.len()).filter(|class| shown[*class].is_near).collect();
    if near.is_empty() {
        return Err(none_is_near(&shown, stand.refused.first(), &judge));
    }
    say(format!("{} of {} pictures are near enough", near.len(), shown.len()));
    let possible: usize = near.iter().map(|class| space.classes[*class].members.len()).sum();
    let neighbours: usize = request.axes.iter().map(|axis| axis.values.len() - 1).sum();
    let was_refused = |place: &usize| stand.refused.iter().any(|(refused, _)| refused == place);
    let left = space.in_turn(&near).into_iter().filter(|place| !was_refused(place));
    let mut drawn: Vec<usize> = left.take(drawn_count(possible, neighbours, request.repeat)).collect();
    let is_near = |place: &usize| near.iter().any(|class| space.classes[*class].members.contains(place));
    // What was asked for stands against the others, first.
    if let Some(asked) = space.asked.filter(is_near) {
        drawn.retain(|place| *place != asked);
        drawn.insert(0, asked);
    }
    known.retain(|place, _| is_near(place));
    let (finalists, rungs) = halve(&drawn, FINALISTS, &mut known, &mut stand)?;
    if finalists.is_empty() {
        return Err(Error::request("no candidate could be measured in the time").note("--search-time has more"));
    }
    let counts = Counts {
        combinations: space.combinations,
        candidates: space.candidates.len(),
        pictures: space.classes.len(),
        near_pictures: near.len(),
        near_candidates: possible,
        measured: known.len(),
        refused: stand.refused.len(),
        search_frames: stand.frames,
        sweep_frames: sweep_frames(possible, request.repeat),
    };
    drop(stand);
    drop(judge);
    let log = session.gpu.validation_log();
    drop(session);
    fail_on_validation(log.as_deref())?;
    Ok(Found { space, finalists, counts, shown, rungs })
}

/// A picture of each class, judged: of one member, or of another where that one is refused.
fn look(
    space: &Space,
    stand: &mut Stand<'_>,
    until: Instant,
    judge: &mut Judge<'_>,
    known: &mut BTreeMap<usize, Vec<f64>>,
) -> Result<Vec<Shown>> {
    let mut shown: Vec<Shown> = space.classes.iter().map(|class| Shown::unseen(&class.label)).collect();
    for turn in 0..MOST_TRIED {
        let unseen: Vec<(usize, usize)> = (0..shown.len())
            .filter(|class| shown[*class].errors.is_none())
            .filter_map(|class| Some((*space.classes[class].members.get(turn)?, class)))
            .collect();
        let members: Vec<usize> = unseen.iter().map(|(member, _)| *member).collect();
        let mut judged = |place: usize, picture: &Picture| {
            let (_, class) = unseen.iter().find(|(member, _)| *member == place).expect("it is one of those");
            shown[*class] = judge.judged(&space.candidates[place], picture, &space.classes[*class].label)?;
            Ok(())
        };
        let found = stand.measure(&members, FIRST_ROUNDS, until, Some(&mut judged))?;
        known.extend(found);
    }
    Ok(shown)
}

fn none_is_near(shown: &[Shown], refused: Option<&(usize, Error)>, judge: &Judge<'_>) -> Error {
    match judge.nearest(shown) {
        Some((nearest, words)) => Error::request(format!("none of the {} pictures is near enough", shown.len()))
            .note(format!("the nearest is that of {nearest}: {words}")),
        None => {
            let why = refused.map_or("there was no time", |(_, error)| error.message());
            Error::request(format!("none of the {} pictures could be made: {why}", shown.len()))
                .note("--search-time has more of it")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::group::MOST_VARIANTS;
    use crate::tune::halving::Trial;

    /// Frames as `Stand` counts them, of candidates that are alike.
    #[derive(Default)]
    struct Counted {
        frames: usize,
    }

    impl Trial for Counted {
        fn ratios(&mut self, candidates: &[usize], rounds: usize) -> Result<Vec<(usize, Vec<f64>)>> {
            let probes = candidates.len() + candidates.len().div_ceil(MOST_VARIANTS);
            self.frames += probes * (rounds + 1);
            Ok(candidates.iter().map(|place| (*place, vec![1.0; rounds])).collect())
        }
    }

    #[test]
    fn a_search_takes_a_tenth_of_a_sweep_where_that_is_enough_for_a_few() {
        for (candidates, neighbours, repeat) in [(500, 12, 10), (1000, 12, 10), (4000, 16, 20)] {
            let drawn: Vec<usize> = (0..drawn_count(candidates, neighbours, repeat)).collect();
            let mut counted = Counted::default();
            halve(&drawn, FINALISTS, &mut BTreeMap::new(), &mut counted).unwrap();
            let all = counted.frames + sweep_frames(neighbours + FINALISTS, repeat);
            let share = all as f64 / sweep_frames(candidates, repeat) as f64;
            assert!((share - SHARE_OF_SWEEP).abs() < 0.005, "{candidates}: {share}");
        }
        assert_eq!((drawn_count(12, 9, 10), drawn_count(100, 9, 10)), (12, LEAST_DRAWN));
    }
}
