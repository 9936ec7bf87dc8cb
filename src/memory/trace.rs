//! What was asked of memory and came back, in order: kept while a program runs, written as lines of JSON, and read again to be
//! replayed through other strategies and other allocators.
//!
//! The first line is `{"schema": 1, "trace": "allocations"}`, with who made it in `device`; each other one is a `take` or a
//! `give`. A file may come from anybody: whatever it asks for is bounded here, before anything has its size.

use super::Tiling;
use super::pool::Ask;
use crate::error::{Error, Result};
use crate::units::Bytes;
use crate::whole_file::{read_document, write_whole};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::{BTreeMap, HashSet};
use std::io::Write;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Number of the set of keys.
const SCHEMA: u32 = 1;
/// `trace` of the first line.
const KIND: &str = "allocations";
/// No resource of a file is larger: more than any heap has, and sums of a million of them stay below 2^62.
pub const MOST_BYTES: u64 = 1 << 40;
/// Takes and gives of a trace.
pub const MOST_EVENTS: usize = 1 << 20;
/// No driver asks for more.
const MOST_ALIGNMENT: u64 = 1 << 30;
/// Memory types that Vulkan has room for (VK_MAX_MEMORY_TYPES).
const MOST_TYPES: u32 = 32;
const MOST_NAME_BYTES: usize = 1000;

/// A take or a give. `Ask::alone` is of arenas.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// A number that no live allocation has, and its need.
    Take { id: u64, name: String, ask: Ask },
    /// That of a live allocation.
    Give { id: u64 },
}

/// Events in order: takes and gives fit together, whoever made it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trace {
    /// A file's path, or a generator's name.
    pub name: String,
    events: Vec<Event>,
}

/// The first line.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Head {
    schema: u32,
    trace: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    device: Option<String>,
}

/// A line of what is taken. Keys that a reader need not know have defaults.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct TakeLine {
    take: u64,
    bytes: u64,
    alignment: u64,
    memory_type: u32,
    tiling: TilingWord,
    #[serde(default, skip_serializing_if = "is_false")]
    mapped: bool,
    #[serde(default, skip_serializing_if = "is_false")]
    alone: bool,
    #[serde(default)]
    name: String,
}

/// A line of what comes back.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct GiveLine {
    give: u64,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum TilingWord {
    Linear,
    Optimal,
}

fn is_false(flag: &bool) -> bool {
    !flag
}

impl From<Tiling> for TilingWord {
    fn from(tiling: Tiling) -> Self {
        match tiling {
            Tiling::Linear => Self::Linear,
            Tiling::Optimal => Self::Optimal,
        }
    }
}

impl From<TilingWord> for Tiling {
    fn from(word: TilingWord) -> Self {
        match word {
            TilingWord::Linear => Self::Linear,
            TilingWord::Optimal => Self::Optimal,
        }
    }
}

impl Event {
    /// As it is written: one line, without its end.
    fn line(&self) -> serde_json::Result<String> {
        match self {
            Self::Give { id } => serde_json::to_string(&GiveLine { give: *id }),
            Self::Take { id, name, ask: Ask { bytes, alignment, type_index, mapped, tiling, alone } } => {
                serde_json::to_string(&TakeLine {
                    take: *id,
                    bytes: *bytes,
                    alignment: *alignment,
                    memory_type: *type_index,
                    tiling: (*tiling).into(),
                    mapped: *mapped,
                    alone: *alone,
                    name: name.clone(),
                })
            }
        }
    }

    /// Errors: what is wrong with a line, in words for who knows its number.
    fn of_line(line: &str) -> std::result::Result<Self, String> {
        let value: Value = serde_json::from_str(line).map_err(|error| format!("it is no JSON: {error}"))?;
        if value.get("give").is_some() {
            let GiveLine { give } = serde_json::from_value(value).map_err(|error| format!("give: {error}"))?;
            return Ok(Self::Give { id: give });
        }
        let take = serde_json::from_value(value).map_err(|error| format!("take: {error}"))?;
        let TakeLine { take, bytes, alignment, memory_type, tiling, mapped, alone, name } = take;
        if !(1..=MOST_BYTES).contains(&bytes) {
            return Err(format!("bytes {bytes}: a resource has 1 to {MOST_BYTES}"));
        }
        if !alignment.is_power_of_two() || alignment > MOST_ALIGNMENT {
            return Err(format!("alignment {alignment}: it is a power of two up to {MOST_ALIGNMENT}"));
        }
        if memory_type >= MOST_TYPES {
            return Err(format!("memory_type {memory_type}: there are 0 to {}", MOST_TYPES - 1));
        }
        if name.len() > MOST_NAME_BYTES {
            return Err(format!("name: {} bytes, and {MOST_NAME_BYTES} are enough", name.len()));
        }
        let ask = Ask { bytes, alignment, type_index: memory_type, mapped, tiling: tiling.into(), alone };
        Ok(Self::Take { id: take, name, ask })
    }
}

impl Trace {
    /// Errors: `events` are none, too many, take a number twice or give one that is not live (exit code 2), with its place;
    /// `first`: the line of the first.
    pub fn new(name: &str, events: Vec<Event>, first: usize) -> Result<Self> {
        let refused = |at: usize, why: String| Err(Error::request(format!("{name}:{}: {why}", first + at)));
        if events.is_empty() {
            return refused(0, "nothing is taken".to_owned());
        }
        if events.len() > MOST_EVENTS {
            return refused(MOST_EVENTS, format!("a trace has at most {MOST_EVENTS} takes and gives"));
        }
        let mut live = HashSet::new();
        for (at, event) in events.iter().enumerate() {
            match event {
                Event::Take { id, .. } if !live.insert(*id) => {
                    return refused(at, format!("take {id}: it is taken already"));
                }
                Event::Give { id } if !live.remove(id) => return refused(at, format!("give {id}: it is not taken")),
                _ => {}
            }
        }
        Ok(Self { name: name.to_owned(), events })
    }

    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// Greatest sum of what is live at once, bytes.
    pub fn peak_live_bytes(&self) -> u64 {
        let (mut live, mut sum, mut peak) = (BTreeMap::new(), 0, 0);
        for event in &self.events {
            match event {
                Event::Take { id, ask, .. } => {
                    live.insert(*id, ask.bytes);
                    sum += ask.bytes;
                    peak = peak.max(sum);
                }
                Event::Give { id } => sum -= live.remove(id).unwrap_or(0),
            }
        }
        peak
    }

    /// Writes a file that `read` reads. `device`: who was asked.
    ///
    /// Errors: it cannot be written (exit code 2).
    pub fn write(path: &Path, device: &str, events: &[Event]) -> Result<()> {
        let head = Head { schema: SCHEMA, trace: KIND.to_owned(), device: Some(device.to_owned()) };
        write_whole(path, |out| -> std::io::Result<()> {
            writeln!(out, "{}", serde_json::to_string(&head)?)?;
            events.iter().try_for_each(|event| writeln!(out, "{}", event.line()?))
        })
    }

    /// Errors: it cannot be read, is too long, or is no trace (exit code 2), with the line and what is wrong there.
    pub fn read(path: &Path) -> Result<Self> {
        Self::of_text(&path.display().to_string(), &read_document(path)?)
    }

    /// Errors: as `read`.
    pub fn of_text(name: &str, text: &str) -> Result<Self> {
        let refused = |line: usize, why: &dyn std::fmt::Display| {
            Error::request(format!("{name}:{line}: {why}")).note("docs/memory.md says what a trace holds")
        };
        let mut lines = text.lines().zip(1..).filter(|(line, _)| !line.trim().is_empty());
        let (head, at) = lines.next().ok_or_else(|| refused(1, &"it is empty"))?;
        let head: Head = serde_json::from_str(head).map_err(|error| refused(at, &format!("it is no head: {error}")))?;
        if (head.schema, head.trace.as_str()) != (SCHEMA, KIND) {
            let [theirs, ours] = [(head.schema, head.trace.as_str()), (SCHEMA, KIND)];
            return Err(refused(
                at,
                &format!("it is {} of schema {}, not {} of {}", theirs.1, theirs.0, ours.1, ours.0),
            ));
        }
        let mut events = Vec::new();
        let mut first = at + 1;
        for (line, at) in lines {
            if events.len() == MOST_EVENTS {
                return Err(refused(at, &format!("a trace has at most {MOST_EVENTS} takes and gives")));
            }
            events.push(Event::of_line(line).map_err(|error| refused(at, &error))?);
            // Empty lines are passed over: a number of a line is right as long as there are none.
            first = at + 1 - events.len();
        }
        Self::new(name, events, first)
    }
}

/// Keeps what is asked for while it runs, with the ledger's numbers as ids.
#[derive(Debug, Default)]
pub struct Recorder {
    events: Mutex<Vec<Event>>,
}

impl Recorder {
    fn push(&self, event: Event) {
        // A panic elsewhere leaves a list that is whole.
        self.events.lock().unwrap_or_else(PoisonError::into_inner).push(event);
    }

    pub fn take(&self, id: u64, ask: &Ask, name: &str) {
        self.push(Event::Take { id, name: name.to_owned(), ask: *ask });
    }

    pub fn give(&self, id: u64) {
        self.push(Event::Give { id });
    }

    /// All so far.
    pub fn events(&self) -> Vec<Event> {
        self.events.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// The bytes of a trace in words.
pub fn summary(trace: &Trace) -> String {
    let takes = trace.events.iter().filter(|event| matches!(event, Event::Take { .. })).count();
    format!("{takes} takes, {} gives, {} at most at once", trace.events.len() - takes, Bytes(trace.peak_live_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "{\"schema\": 1, \"trace\": \"allocations\"}\n";
    const TAKE: &str =
        r#"{"take": 1, "bytes": 100, "alignment": 256, "memory_type": 0, "tiling": "linear", "name": "a"}"#;

    #[test]
    fn what_is_recorded_is_read_again() {
        let recorder = Recorder::default();
        let ask = |tiling, alone: bool| Ask { bytes: 77, alignment: 64, type_index: 3, mapped: !alone, tiling, alone };
        recorder.take(4, &ask(Tiling::Optimal, false), "scene.\"texture\"");
        recorder.take(5, &ask(Tiling::Linear, true), "arena");
        recorder.give(4);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("trace.jsonl");
        Trace::write(&path, "lavapipe", &recorder.events()).unwrap();
        let trace = Trace::read(&path).unwrap();
        assert_eq!(trace.events(), recorder.events());
        assert_eq!(
            (trace.peak_live_bytes(), summary(&trace).as_str()),
            (154, "2 takes, 1 gives, 154 B at most at once")
        );
    }

    #[test]
    fn what_is_no_trace_is_refused_by_its_line_and_value() {
        let refused = |text: &str| {
            let error = Trace::of_text("t.jsonl", text).unwrap_err();
            assert_eq!(error.exit_code(), 2);
            error.to_string()
        };
        let changed = |from: &str, to: &str| {
            refused(&format!("{HEAD}{TAKE}\n{}", TAKE.replace("\"take\": 1", "\"take\": 2").replace(from, to)))
        };
        for (text, words) in [
            (refused(""), "t.jsonl:1: it is empty"),
            (refused("{}"), "t.jsonl:1: it is no head"),
            (refused("{\"schema\": 2, \"trace\": \"allocations\"}"), "t.jsonl:1: it is allocations of schema 2, not"),
            (refused(HEAD), "t.jsonl:2: nothing is taken"),
            (changed("100", "0"), "t.jsonl:3: bytes 0: a resource has 1 to"),
            (changed("100", "1099511627777"), "t.jsonl:3: bytes 1099511627777"),
            (changed("100", "-1"), "t.jsonl:3: "),
            (changed("256", "3"), "t.jsonl:3: alignment 3: it is a power of two"),
            (changed("256", "2147483648"), "t.jsonl:3: alignment 2147483648"),
            (changed("\"memory_type\": 0", "\"memory_type\": 32"), "t.jsonl:3: memory_type 32: there are 0 to 31"),
            (changed("linear", "tiled"), "t.jsonl:3: take: unknown variant `tiled`"),
            (changed("}", ", \"more\": 1}"), "t.jsonl:3: take: unknown field `more`"),
            (changed("\"bytes\": 100, ", ""), "t.jsonl:3: take: missing field `bytes`"),
            (changed("}", ""), "t.jsonl:3: it is no JSON"),
            (changed("\"take\": 2", "\"take\": 1"), "t.jsonl:3: take 1: it is taken already"),
            (refused(&format!("{HEAD}{TAKE}\n{{\"give\": 7}}")), "t.jsonl:3: give 7: it is not taken"),
        ] {
            assert!(text.contains(words), "{text} does not say {words}");
        }
        assert!(
            Trace::of_text("t", &format!("{HEAD}{TAKE}\n{{\"give\": 1}}\n{TAKE}\n")).is_ok(),
            "a number is free again"
        );
    }
}
