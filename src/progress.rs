//! Progress: work that may take long reports its start, how far it is, and its end.
//!
//! Why this way: like Ctrl-C (src/interrupt.rs), the observer belongs to the process, not to a picture, so that
//! importers and tree builders need not pass one down. The binary installs one; without one nothing is printed.

use std::fmt::Display;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// An observer of progress. Stages are nested: the last that began is the first that ends.
pub trait Progress: Send + Sync {
    /// A stage begins. `unit`: what is counted in it, in the plural; empty where nothing is counted.
    fn begins(&self, name: &str, unit: &'static str);

    /// `done` of `all` units of the innermost stage are done.
    fn reaches(&self, done: u64, all: u64);

    /// The innermost stage has ended, well or not.
    fn ends(&self);

    /// A line for the user, beside the stages.
    fn says(&self, line: &str);
}

static ONLOOKER: OnceLock<Box<dyn Progress>> = OnceLock::new();

/// Shows what begins from now on; called once, by the binary. A second call changes nothing.
pub fn install(onlooker: Box<dyn Progress>) {
    let _ = ONLOOKER.set(onlooker);
}

/// A line for the user; nothing without an observer.
pub fn say(line: impl Display) {
    if let Some(onlooker) = ONLOOKER.get() {
        onlooker.says(&line.to_string());
    }
}

/// Work that may take long; it ends when this is dropped.
#[must_use = "the stage ends when this is dropped"]
pub struct Stage {
    _made_by_begin: (),
}

impl Stage {
    /// Work that is not counted: "decoding pictures".
    pub fn begin(name: &str) -> Self {
        Self::counted(name, "")
    }

    /// Work of countable steps; `unit` in the plural: "samples".
    pub fn counted(name: &str, unit: &'static str) -> Self {
        if let Some(onlooker) = ONLOOKER.get() {
            onlooker.begins(name, unit);
        }
        Self { _made_by_begin: () }
    }

    /// The result of `work`, after which the stage ends.
    pub fn over<T>(self, work: impl FnOnce() -> T) -> T {
        work()
    }

    /// `done` of `all` steps are done. The stages inside this one have ended.
    pub fn reach(&self, done: u64, all: u64) {
        if let Some(onlooker) = ONLOOKER.get() {
            onlooker.reaches(done, all);
        }
    }
}

impl Drop for Stage {
    fn drop(&mut self) {
        if let Some(onlooker) = ONLOOKER.get() {
            onlooker.ends();
        }
    }
}

/// How far counted work is, and how long the rest takes at the speed so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pace {
    /// When the first count came, and what it was: what lies before, kept rows and what drivers compile, says nothing
    /// about speed.
    first: Option<(Instant, u64)>,
    pub done: u64,
    pub all: u64,
}

impl Pace {
    /// `done` of `all` steps are done at `now`.
    pub fn reach(&mut self, done: u64, all: u64, now: Instant) {
        self.first.get_or_insert((now, done));
        (self.done, self.all) = (done, all);
    }

    /// None before two counts differ, and when nothing is left.
    pub fn left(&self, now: Instant) -> Option<Duration> {
        let (since, before) = self.first?;
        let (done, left) = (self.done.checked_sub(before)?, self.all.saturating_sub(self.done));
        let is_known = done > 0 && left > 0;
        is_known.then(|| now.saturating_duration_since(since).mul_f64(left as f64 / done as f64))
    }
}

/// The stages that have begun and not ended, outermost first: the arithmetic of what shows them.
#[derive(Debug, Default)]
pub struct Stages {
    open: Vec<Open>,
}

#[derive(Debug)]
struct Open {
    name: String,
    unit: &'static str,
    started: Instant,
    /// What the stages inside it took.
    inside: Duration,
    pace: Pace,
}

/// A stage as it is shown.
#[derive(Clone, Debug)]
pub struct Shown {
    /// Its name after those of the stages around it.
    pub path: String,
    pub unit: &'static str,
    pub pace: Pace,
    /// Since it began. Of an ended one: without the stages inside it.
    pub took: Duration,
}

impl Stages {
    pub fn begin(&mut self, name: &str, unit: &'static str, now: Instant) {
        let (inside, pace) = Default::default();
        self.open.push(Open { name: name.to_owned(), unit, started: now, inside, pace });
    }

    pub fn reach(&mut self, done: u64, all: u64, now: Instant) {
        if let Some(stage) = self.open.last_mut() {
            stage.pace.reach(done, all, now);
        }
    }

    /// Ends the innermost stage; None where none has begun.
    pub fn end(&mut self, now: Instant) -> Option<Shown> {
        let mut shown = self.shown(self.open.len().checked_sub(1)?, now);
        let ended = self.open.pop()?;
        if let Some(around) = self.open.last_mut() {
            around.inside += shown.took;
        }
        shown.took = shown.took.saturating_sub(ended.inside);
        Some(shown)
    }

    /// The innermost stage that began at least `least` before `now`.
    pub fn current(&self, least: Duration, now: Instant) -> Option<Shown> {
        let is_long = |stage: &Open| now.saturating_duration_since(stage.started) >= least;
        Some(self.shown(self.open.iter().rposition(is_long)?, now))
    }

    fn shown(&self, index: usize, now: Instant) -> Shown {
        let stage = &self.open[index];
        let names: Vec<&str> = self.open[..=index].iter().map(|stage| stage.name.as_str()).collect();
        let took = now.saturating_duration_since(stage.started);
        Shown { path: names.join(": "), unit: stage.unit, pace: stage.pace, took }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    #[test]
    fn what_is_left_goes_by_the_speed_after_the_first_count() {
        let start = Instant::now();
        let mut pace = Pace::default();
        assert_eq!(pace.left(start), None);
        // Ten steps were there before; the first took a minute to compile.
        pace.reach(11, 20, start + 60 * SECOND);
        assert_eq!(pace.left(start + 60 * SECOND), None);
        pace.reach(14, 20, start + 66 * SECOND);
        assert_eq!(pace.left(start + 66 * SECOND), Some(12 * SECOND));
        pace.reach(20, 20, start + 78 * SECOND);
        assert_eq!(pace.left(start + 78 * SECOND), None);
        // Fewer than before are no speed.
        pace.reach(5, 20, start + 80 * SECOND);
        assert_eq!(pace.left(start + 80 * SECOND), None);
    }

    #[test]
    fn a_stage_has_its_own_time_and_the_innermost_long_one_is_current() {
        let start = Instant::now();
        let at = |seconds: u32| start + seconds * SECOND;
        let mut stages = Stages::default();
        assert!(stages.end(start).is_none() && stages.current(Duration::ZERO, start).is_none());
        stages.begin("reference", "", start);
        stages.begin("rendering", "samples", at(3));
        assert_eq!(stages.current(SECOND, at(3)).unwrap().path, "reference");
        stages.reach(4, 8, at(5));
        let current = stages.current(SECOND, at(5)).unwrap();
        assert_eq!((current.path.as_str(), current.pace.done, current.unit), ("reference: rendering", 4, "samples"));
        let inner = stages.end(at(9)).unwrap();
        assert_eq!((inner.path.as_str(), inner.took), ("reference: rendering", 6 * SECOND));
        let outer = stages.end(at(10)).unwrap();
        assert_eq!((outer.path.as_str(), outer.took), ("reference", 4 * SECOND));
    }
}
