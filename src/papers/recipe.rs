//! How an item is made here: commands of this program, and where in what they leave each of its numbers stands.

use crate::bench::row::BenchRow;
use serde_json::Value;

/// How much work a reproduction may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// A quarter of the sides and few rounds, to see that all of it runs, and its shape; else the paper's sizes and samples.
    pub is_quick: bool,
    /// Frames of a film, where an item is of one; None: its own number.
    pub frames: Option<u32>,
}

impl Effort {
    pub const FULL: Self = Self { is_quick: false, frames: None };
    pub const QUICK: Self = Self { is_quick: true, frames: None };

    pub fn name(self) -> &'static str {
        self.pick("full", "quick")
    }

    pub fn pick<T>(self, full: T, quick: T) -> T {
        if self.is_quick { quick } else { full }
    }

    /// Words for a picture of these pixels.
    pub fn size(self, width: u32, height: u32) -> String {
        let parts = self.pick(1, 4);
        format!("--size {}x{}", (width / parts).max(1), (height / parts).max(1))
    }
}

/// Commands, and the numbers and pictures that they leave.
#[derive(Default)]
pub struct Recipe {
    /// In their order; a step may name files of earlier ones.
    pub steps: Vec<Step>,
    pub cells: Vec<Cell>,
    pub pictures: Vec<Picture>,
    /// Made of pictures of the steps, when these are done.
    pub close_ups: Vec<CloseUp>,
}

/// One command of this program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Step {
    /// Begins the names of its files; no other step of the recipe has it.
    pub name: String,
    pub verb: Verb,
    /// A built-in scene or a file; None where the command takes none.
    pub scene: Option<String>,
    /// What follows, without what says where results go; `@FILE` is a file of an earlier step.
    pub words: Vec<String>,
}

/// What a step runs, and what it leaves.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verb {
    /// `bench WHAT`: rows.
    Bench { what: String, rounds: u32 },
    /// `render`: a picture of this extension, and its report.
    Render { extension: &'static str },
    /// `compare` of two files: its document, and a picture of what they differ by.
    Compare { files: [String; 2], picture: Differing },
    /// `memory`: its document.
    Memory,
    /// `sampling inspect` of a pattern: pictures of its samples and of its spectrum, and its document.
    Pattern { pattern: String },
}

/// What a comparison draws of what two pictures differ by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Differing {
    /// FLIP's error map, a PNG.
    Map,
    /// The powers of its frequencies, an SVG; the document has them too.
    Spectrum,
}

/// A number of ours.
pub struct Cell {
    /// Index of the item's table.
    pub table: usize,
    /// The paper's row, or one of our own.
    pub row: String,
    pub column: String,
    pub source: Source,
}

/// Where a number comes from.
pub enum Source {
    /// A row of a bench.
    Row { step: String, variant: String, figure: Figure },
    /// All rows of a bench together.
    Rows { step: String, read: ReadingOfRows, otherwise: &'static str },
    /// Something in a step's document.
    Document { step: String, read: ReadingOfDocument },
    /// Several numbers made one; there is none where one of them is missing.
    Combined { parts: Vec<Source>, combine: fn(&[f64]) -> f64 },
    /// Arithmetic on what the paper publishes, done when the recipe is made.
    Computed(f64),
}

/// What a row of a bench says.
pub struct Figure {
    pub kind: FigureKind,
    pub read: Reading,
}

/// What makes a number of a row.
pub type Reading = Box<dyn Fn(&BenchRow) -> Option<Number>>;

/// What makes a number of the rows that were measured.
pub type ReadingOfRows = Box<dyn Fn(&[&BenchRow]) -> Option<Number>>;

/// What makes a number of a document.
pub type ReadingOfDocument = Box<dyn Fn(&Value) -> Option<f64>>;

/// How a figure goes with the row's time ratio.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FigureKind {
    /// With it: the ratio of two is that of their rows, with its interval.
    Time,
    /// Against it.
    Rate,
    /// Not at all.
    Other,
}

/// A number with its bounds.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Number {
    pub value: f64,
    /// The least and the greatest of milliseconds; the 95 % interval of ratios.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bounds: Option<[f64; 2]>,
}

impl Number {
    /// One without bounds.
    pub fn exact(value: f64) -> Self {
        Self { value, bounds: None }
    }

    /// All of it times `factor`, which is positive.
    pub fn times(self, factor: f64) -> Self {
        Self { value: self.value * factor, bounds: self.bounds.map(|ends| ends.map(|end| end * factor)) }
    }

    /// What `one` is divided by it.
    pub fn divides(self, one: f64) -> Self {
        Self { value: one / self.value, bounds: self.bounds.map(|[low, high]| [one / high, one / low]) }
    }
}

/// A picture to look at.
pub struct Picture {
    pub title: String,
    /// Name of a PNG among the files of the steps.
    pub file: String,
}

/// A part of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct CloseUp {
    /// Name of a PNG among the files of the steps.
    pub of: String,
    /// Its middle, in parts of the picture's sides from the upper left corner.
    pub middle: [f32; 2],
    /// Its sides, in parts of the picture's.
    pub part: f32,
}

impl CloseUp {
    /// Name of its own file.
    pub fn file(&self) -> String {
        format!("{}.close-up.png", self.of.strip_suffix(".png").unwrap_or(&self.of))
    }
}

/// Words, as a shell would part them.
fn words(text: &str) -> Vec<String> {
    text.split_whitespace().map(str::to_owned).collect()
}

impl Step {
    /// `bench WHAT SCENE WORDS --repeat ROUNDS`.
    pub fn bench(name: impl Into<String>, what: &str, scene: &str, rounds: u32, text: &str) -> Self {
        let verb = Verb::Bench { what: what.to_owned(), rounds };
        Self { name: name.into(), verb, scene: Some(scene.to_owned()), words: words(text) }
    }

    /// `render SCENE WORDS`, into `NAME.png` or `NAME.exr`.
    pub fn render(name: impl Into<String>, extension: &'static str, scene: &str, text: &str) -> Self {
        let verb = Verb::Render { extension };
        Self { name: name.into(), verb, scene: Some(scene.to_owned()), words: words(text) }
    }

    /// `compare A B --diff NAME.png`, files of earlier steps.
    pub fn compare(name: impl Into<String>, files: [&str; 2]) -> Self {
        let verb = Verb::Compare { files: files.map(str::to_owned), picture: Differing::Map };
        Self { name: name.into(), verb, scene: None, words: Vec::new() }
    }

    /// `compare A B --spectrum NAME.svg`, files of earlier steps.
    pub fn spectrum(name: impl Into<String>, files: [&str; 2]) -> Self {
        let verb = Verb::Compare { files: files.map(str::to_owned), picture: Differing::Spectrum };
        Self { name: name.into(), verb, scene: None, words: Vec::new() }
    }

    /// `sampling inspect PATTERN`, into `NAME.png`, `NAME.spectrum.png` and `NAME.spectrum.svg`.
    pub fn pattern(name: impl Into<String>, pattern: &str) -> Self {
        Self { name: name.into(), verb: Verb::Pattern { pattern: pattern.to_owned() }, scene: None, words: Vec::new() }
    }

    /// Files of earlier steps that its command names.
    pub fn earlier_files(&self) -> impl Iterator<Item = &str> {
        let compared = if let Verb::Compare { files, .. } = &self.verb { files.as_slice() } else { &[] };
        compared.iter().map(String::as_str).chain(self.words.iter().filter_map(|word| word.strip_prefix('@')))
    }

    /// `memory SCENE WORDS --json`.
    pub fn memory(name: impl Into<String>, scene: &str, text: &str) -> Self {
        Self { name: name.into(), verb: Verb::Memory, scene: Some(scene.to_owned()), words: words(text) }
    }
}

impl Recipe {
    pub fn step(&mut self, step: Step) {
        self.steps.push(step);
    }

    /// The number of `row` and `column` in the item's table of this index.
    pub fn cell(&mut self, table: usize, row: impl Into<String>, column: impl Into<String>, source: Source) {
        self.cells.push(Cell { table, row: row.into(), column: column.into(), source });
    }

    /// Errors of a picture against another, both files of earlier steps, as cells of a row whose columns are `metrics`. The step is
    /// called as the picture, with `-errors` behind it.
    pub fn errors(&mut self, table: usize, row: &str, files: [&str; 2], metrics: &[&str]) {
        let stem = files[0].rsplit_once('.').map_or(files[0], |(stem, _)| stem);
        let step = format!("{stem}-errors");
        self.step(Step::compare(&step, files));
        for metric in metrics {
            self.cell(table, row, *metric, Source::metric(&step, metric));
        }
    }

    /// Part of a picture to look at: `part` of its sides, around `middle` (`CloseUp`).
    pub fn close_up(&mut self, title: impl Into<String>, of: impl Into<String>, middle: [f32; 2], part: f32) {
        let close_up = CloseUp { of: of.into(), middle, part };
        self.picture(title, close_up.file());
        self.close_ups.push(close_up);
    }

    pub fn picture(&mut self, title: impl Into<String>, file: impl Into<String>) {
        self.pictures.push(Picture { title: title.into(), file: file.into() });
    }
}

impl Source {
    pub fn row(step: impl Into<String>, variant: impl Into<String>, figure: Figure) -> Self {
        Self::Row { step: step.into(), variant: variant.into(), figure }
    }

    /// `otherwise`: why there may be no such number.
    pub fn rows(
        step: impl Into<String>,
        otherwise: &'static str,
        read: impl Fn(&[&BenchRow]) -> Option<Number> + 'static,
    ) -> Self {
        Self::Rows { step: step.into(), read: Box::new(read), otherwise }
    }

    /// A counter of a picture's report.
    pub fn counter(step: impl Into<String>, name: &str) -> Self {
        Self::document(step, format!("/counters/{name}"), 1.0)
    }

    /// A counter of all frames of a film's report, which `together` makes one number of.
    pub fn frames(step: impl Into<String>, name: &str, together: fn(&[f64]) -> f64) -> Self {
        let pointer = format!("/counters/{name}");
        let read = move |document: &Value| {
            let frames = document.get("frames")?.as_array()?;
            let counts = frames.iter().map(|frame| frame.pointer(&pointer)?.as_f64());
            Some(together(&counts.collect::<Option<Vec<_>>>()?))
        };
        Self::Document { step: step.into(), read: Box::new(read) }
    }

    /// A metric of a comparison.
    pub fn metric(step: impl Into<String>, name: &str) -> Self {
        Self::document(step, format!("/metrics/{name}"), 1.0)
    }

    /// What is at a JSON pointer, times a factor.
    pub fn document(step: impl Into<String>, pointer: impl Into<String>, factor: f64) -> Self {
        let pointer = pointer.into();
        let read = move |document: &Value| Some(document.pointer(&pointer)?.as_f64()? * factor);
        Self::Document { step: step.into(), read: Box::new(read) }
    }

    /// Milliseconds of passes together, by their names behind the technique's, of a report of `render --profile`.
    pub fn profiled(step: impl Into<String>, passes: &'static [&'static str]) -> Self {
        let read = |document: &Value| {
            let all = document.get("passes")?.as_array()?;
            let ms = |pass: &Value| {
                let (_, name) = pass.get("name")?.as_str()?.split_once('.')?;
                passes.contains(&name).then(|| pass.pointer("/ms/median")?.as_f64())?
            };
            all.iter().filter_map(ms).reduce(|sum, ms| sum + ms)
        };
        Self::Document { step: step.into(), read: Box::new(read) }
    }

    /// Bytes of resources together, by their names behind the technique's, times a factor, of a document of `memory`.
    pub fn planned(step: impl Into<String>, names: &'static [&'static str], factor: f64) -> Self {
        let read = move |document: &Value| {
            let all = document.pointer("/techniques/0/memory/resources")?.as_array()?;
            let bytes = |name: &&str| {
                let is_named = |resource: &&Value| {
                    let own = resource.get("name").and_then(Value::as_str).and_then(|own| own.split_once('.'));
                    own.is_some_and(|(_, own)| own == *name)
                };
                all.iter().find(is_named)?.get("bytes")?.as_f64()
            };
            Some(names.iter().map(bytes).sum::<Option<f64>>()? * factor)
        };
        Self::Document { step: step.into(), read: Box::new(read) }
    }

    pub fn combined(parts: impl IntoIterator<Item = Self>, combine: fn(&[f64]) -> f64) -> Self {
        Self::Combined { parts: parts.into_iter().collect(), combine }
    }
}
