//! Settings chosen by measuring them here: of all combinations of some settings those whose pictures are near enough, and of these the
//! fastest on this device.
//!
//! Pictures come first: settings that change nothing of a picture (`Setting::changes`) share one, and of each one candidate is judged.
//! Candidates with pictures that are near enough are halved (halving.rs), each measured beside the settings as they were asked for.
//! The fastest then stands against its neighbours, which differ from it in one setting, in rows of `bench`: they say what each choice is
//! worth, and where one of them is faster, it takes the place of the first.

pub mod halving;
mod judge;
pub mod request;
mod search;
pub mod shown;
pub mod space;
mod stand;
pub mod tuned;

use crate::bench::group::MOST_VARIANTS;
use crate::bench::row::BenchRow;
use crate::bench::rows_file::RowsFile;
use crate::bench::run::{self, Observer};
use crate::bench::sweep::{NamedPoint, Point, label};
use crate::bench::what::What;
use crate::error::{Error, Result};
use crate::progress::{Stage, say};
use request::Request;
use search::Found;
use std::time::Instant;
use tuned::Tuned;

/// How often a neighbour may take the place of the fastest.
const MOST_MOVES: usize = 3;

/// Searches. `file`: where the rows of the last measurement go.
///
/// Errors: nothing is possible, or no picture is near enough (exit code 2); no device (3); the device fails (4); a picture holds NaN or
/// infinity, or the validation layer has spoken (1); interrupted (130).
pub fn tune(request: &Request<'_>, file: Option<&mut RowsFile>) -> Result<Tuned> {
    let begun = Instant::now();
    let found = search::search(request, begun)?;
    let deadline = begun + request.time;
    let (rows, chosen, moves) = settle(request, &found, deadline, file)?;
    Tuned::new(request, found, rows, chosen, moves, begun.elapsed())
}

/// The fastest in rows beside the other finalists and its neighbours, until none of these is faster and near enough: the rows of the last
/// time, the place of the chosen one among the candidates, and how often it moved.
fn settle(
    request: &Request<'_>,
    found: &Found,
    deadline: Instant,
    mut file: Option<&mut RowsFile>,
) -> Result<(Vec<BenchRow>, usize, usize)> {
    let (space, mut chosen) = (&found.space, found.finalists[0]);
    let mut moves = 0;
    loop {
        let mut places = vec![chosen];
        let others = found.finalists.iter().copied().chain(space.neighbours(request.job, request.axes, chosen));
        others.for_each(|place| {
            if !places.contains(&place) {
                places.push(place);
            }
        });
        let point = |place: &usize| NamedPoint { name: None, point: space.points[*place].clone() };
        let points: Vec<NamedPoint> = places.iter().map(point).collect();
        let named = label(&points[0].point);
        say(format!("fastest so far: {named}; {} others beside it", places.len() - 1));
        let bench = run::Request {
            job: request.job,
            what: What::Frame,
            axes: &[],
            baseline: Some(&named),
            points: &points,
            repeat: request.repeat,
            until_interval: None,
            is_fair: false,
            shard: None,
            pictures: request.folder,
            group: MOST_VARIANTS,
            frames: None,
            // The first time it is measured whatever the time: without it there is no result.
            deadline: (moves > 0).then_some(deadline),
        };
        let measured = run::run(&bench, file.as_deref_mut(), &mut Measuring::default())?;
        if measured.interrupted {
            return Err(Error::interrupted("interrupted; nothing is chosen"));
        }
        let asked = label(&Point::new());
        let own = measured.rows.iter().find(|row| row.variant == label(&space.points[chosen]));
        let is_other = |row: &&BenchRow| own.is_none_or(|own| row.settings != own.settings);
        // The request's own settings may not be among those that are searched.
        let candidates =
            measured.rows.iter().filter(|row| row.variant != asked || space.asked.is_some()).filter(is_other);
        let faster = tuned::faster(candidates, request.bounds);
        let next = faster.and_then(|row| match row.variant == asked {
            true => space.asked,
            false => places.iter().copied().find(|place| label(&space.points[*place]) == row.variant),
        });
        match next.filter(|next| *next != chosen && moves < MOST_MOVES && Instant::now() < deadline) {
            Some(next) => chosen = next,
            None => return Ok((measured.rows, chosen, moves)),
        }
        moves += 1;
    }
}

/// Rounds of rows, shown as progress.
#[derive(Default)]
struct Measuring {
    stage: Option<Stage>,
}

impl Observer for Measuring {
    fn row(&mut self, _: &BenchRow) -> Result<()> {
        Ok(())
    }

    fn step(&mut self, done: usize, all: usize) {
        let stage = self.stage.get_or_insert_with(|| Stage::counted("comparing", "rounds of a variant"));
        stage.reach(done as u64, all as u64);
    }

    fn group(&mut self, _: usize, _: usize) {
        self.stage = None;
    }
}
