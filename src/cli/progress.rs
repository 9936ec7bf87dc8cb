//! Progress for the user, on standard error: a bar on a terminal; elsewhere a line for each stage that took over a second.

use crate::progress::{self, Progress, Shown, Stages};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// What is over sooner is not shown.
const LEAST: Duration = Duration::from_secs(1);
/// How often the bar moves.
const TICK: Duration = Duration::from_millis(200);
/// What begins the line of a stage that has ended.
const PREFIX: &str = "progress: ";

/// Shows what begins from now on, unless `quiet`.
pub fn install(quiet: bool) {
    if quiet {
        return;
    }
    match is_bar() {
        true => progress::install(Box::new(Bar::new())),
        false => progress::install(Box::new(Lines { stages: Mutex::default() })),
    }
}

/// Whether progress is a bar, and not lines.
pub fn is_bar() -> bool {
    std::io::stderr().is_terminal()
}

/// Seconds that are left, in words that follow another; nothing where they are not known.
pub fn left_words(left: Option<Duration>) -> String {
    left.map_or_else(String::new, |left| format!(", about {} s left", left.as_secs() + 1))
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

struct Lines {
    stages: Mutex<Stages>,
}

impl Progress for Lines {
    fn begins(&self, name: &str, unit: &'static str) {
        locked(&self.stages).begin(name, unit, Instant::now());
    }

    fn reaches(&self, done: u64, all: u64) {
        locked(&self.stages).reach(done, all, Instant::now());
    }

    fn ends(&self) {
        let ended = locked(&self.stages).end(Instant::now());
        if let Some(line) = ended.filter(|ended| ended.took >= LEAST).map(|ended| line(&ended)) {
            eprintln!("{line}");
        }
    }

    fn says(&self, line: &str) {
        eprintln!("{line}");
    }
}

/// Line for a stage that has ended.
fn line(ended: &Shown) -> String {
    let count = match ended.pace.all {
        0 => String::new(),
        _ => format!(" {} {}", ended.pace.done, ended.unit),
    };
    format!("{PREFIX}{}{count} took {:.1} s", ended.path, ended.took.as_secs_f64())
}

/// Drawn by a thread of its own, because work that is not counted reports nothing while it runs.
struct Bar {
    state: Arc<Mutex<Drawn>>,
}

#[derive(Default)]
struct Drawn {
    stages: Stages,
    /// While something is shown.
    bar: Option<ProgressBar>,
}

impl Bar {
    fn new() -> Self {
        let state = Arc::new(Mutex::new(Drawn::default()));
        let drawn = state.clone();
        std::thread::spawn(move || {
            loop {
                std::thread::sleep(TICK);
                locked(&drawn).draw();
            }
        });
        Self { state }
    }
}

impl Drawn {
    fn draw(&mut self) {
        let now = Instant::now();
        let Some(shown) = self.stages.current(LEAST, now) else { return };
        let is_counted = shown.pace.all > 0;
        let template = if is_counted { "{bar:30} {msg}" } else { "{spinner} {msg}" };
        let made = || ProgressBar::with_draw_target(Some(shown.pace.all), ProgressDrawTarget::stderr());
        let bar = self.bar.get_or_insert_with(made);
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_length(shown.pace.all);
        bar.set_position(shown.pace.done);
        bar.set_message(words(&shown, now));
        bar.tick();
    }
}

/// Beside the bar.
fn words(shown: &Shown, now: Instant) -> String {
    let Shown { path, unit, pace, took } = shown;
    match pace.all {
        0 => format!("{path}, {} s", took.as_secs()),
        all => format!("{path}, {} of {all} {unit}{}", pace.done, left_words(pace.left(now))),
    }
}

impl Progress for Bar {
    fn begins(&self, name: &str, unit: &'static str) {
        locked(&self.state).stages.begin(name, unit, Instant::now());
    }

    fn reaches(&self, done: u64, all: u64) {
        locked(&self.state).stages.reach(done, all, Instant::now());
    }

    fn ends(&self) {
        let mut state = locked(&self.state);
        let now = Instant::now();
        state.stages.end(now);
        if state.stages.current(LEAST, now).is_none()
            && let Some(bar) = state.bar.take()
        {
            bar.finish_and_clear();
        }
    }

    fn says(&self, line: &str) {
        match &locked(&self.state).bar {
            Some(bar) => bar.suspend(|| eprintln!("{line}")),
            None => eprintln!("{line}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(done: u64, all: u64) -> Shown {
        let mut stages = Stages::default();
        let start = Instant::now();
        stages.begin("rendering", "samples", start);
        stages.reach(1, all, start);
        stages.reach(done, all, start + Duration::from_secs(2));
        stages.current(Duration::ZERO, start + Duration::from_millis(2345)).unwrap()
    }

    #[test]
    fn counted_work_says_its_count_and_what_is_left() {
        assert_eq!(line(&shown(64, 64)), "progress: rendering 64 samples took 2.3 s");
        assert_eq!(line(&shown(0, 0)), "progress: rendering took 2.3 s");
        let later = Instant::now() + Duration::from_secs(3600);
        let text = words(&shown(3, 5), later);
        assert!(text.starts_with("rendering, 3 of 5 samples, about 36"), "{text}");
        assert_eq!(words(&shown(0, 0), later), "rendering, 2 s");
    }
}
