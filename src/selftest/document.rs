//! The self-test's results: one JSON document to send, and the lines that a person reads. Within a schema number a key
//! is only ever added.

use super::bed::Refusal;
use super::case::Twin;
use super::clocks::Clocks;
use super::{CaseResult, Outcome, Verdict};
use serde_json::{Map, Value, json};
use std::fmt::Write;

const SCHEMA: u32 = 1;

/// Cases by how they came out.
struct Counts {
    held: usize,
    failed: usize,
    refused: usize,
}

fn counts(tried: &[CaseResult]) -> Counts {
    let count = |is: fn(&Verdict) -> bool| tried.iter().filter(|tried| is(&tried.verdict)).count();
    Counts {
        held: count(|verdict| matches!(verdict, Verdict::Held)),
        failed: count(|verdict| matches!(verdict, Verdict::Failed(_))),
        refused: count(|verdict| matches!(verdict, Verdict::Refused(_))),
    }
}

/// The document. `command`: the argv that repeats it.
pub fn json(outcome: &Outcome, command: &[String]) -> Value {
    let is_software = outcome.caps.identity.is_software();
    let Counts { held, failed, refused } = counts(&outcome.tried);
    json!({
        "schema": SCHEMA,
        "quincunx": { "version": env!("CARGO_PKG_VERSION"), "commit": env!("QUINCUNX_COMMIT") },
        "command": command,
        "caps": outcome.caps,
        "robust_buffer_access": outcome.is_robust,
        "validated": outcome.is_validated,
        "cases": outcome.tried.iter().map(|tried| case(tried, is_software)).collect::<Vec<_>>(),
        "clocks": outcome.clocks,
        "closing": outcome.last_words,
        "counts": { "held": held, "failed": failed, "refused": refused },
        "failed": outcome.failed(),
        "seconds": outcome.seconds,
    })
}

fn case(tried: &CaseResult, is_software: bool) -> Value {
    let group = tried.case.group;
    let mut expected = Map::new();
    expected.insert("equal_bits".into(), json!(group.must.is_exact(is_software)));
    expected.insert(
        "bounds".into(),
        group.must.bounds(is_software).map_or(Value::Null, |bounds| {
            json!({
                "apart": bounds.apart, "rmse": bounds.rmse, "flip": bounds.flip, "mean": bounds.mean,
            })
        }),
    );
    expected.insert("why".into(), json!(group.must.why()));
    let twin = match (group.twin, tried.case.twin_settings()) {
        (Twin::Formula, _) => json!("a formula"),
        (_, Some((technique, changes))) => json!({ "technique": technique, "settings": settings(&changes) }),
        (_, None) => Value::Null,
    };
    let (verdict, failures, refused) = match &tried.verdict {
        Verdict::Held => ("held", Vec::new(), Value::Null),
        Verdict::Failed(complaints) => ("failed", complaints.clone(), Value::Null),
        Verdict::Refused(refusal) => ("refused", Vec::new(), refused(refusal)),
    };
    json!({
        "name": tried.case.name(),
        "technique": group.technique,
        "place": group.place.name(),
        "settings": settings(&tried.case.settings()),
        "twin": twin,
        "expected": expected,
        "verdict": verdict,
        "failures": failures,
        "refused": refused,
        "figures": tried.figures,
        "samples_without_colour": tried.missing_samples,
        "frame_wall_ns": tried.wall_ns,
        "frame_timestamp_ns": tried.device_ns,
        "seconds": tried.seconds,
    })
}

fn refused(refusal: &Refusal) -> Value {
    json!({ "of": refusal.of, "needs": refusal.needs, "instead": refusal.instead })
}

/// Settings that are not at their defaults; of those that are given twice the later one.
fn settings(changes: &[(&'static str, &'static str)]) -> Value {
    Value::Object(changes.iter().map(|(key, text)| ((*key).to_owned(), json!(text))).collect())
}

/// The line of a case, and one for each of its complaints.
pub fn line(tried: &CaseResult) -> String {
    let name = tried.case.name();
    let (word, rest) = match &tried.verdict {
        Verdict::Held => ("held", figures(tried)),
        Verdict::Failed(complaints) => {
            ("FAILED", complaints.iter().map(|text| format!("\n           {text}")).collect())
        }
        Verdict::Refused(refusal) => ("refused", format!("  needs {}", refusal.needs)),
    };
    format!("{word:<8}  {name}{rest}\n")
}

/// What is worth a look where a picture is not its twin to the bit.
fn figures(tried: &CaseResult) -> String {
    match tried.figures {
        Some(figures) if !figures.is_equal => {
            format!("  RMSE {:.6}, FLIP {:.6}, {:.2} % apart", figures.rmse, figures.flip, 100.0 * figures.apart)
        }
        _ => String::new(),
    }
}

/// What comes after all cases: the clocks, the counts, and what to do with the document. `file`: where it was written.
pub fn closing_text(outcome: &Outcome, file: Option<&str>) -> String {
    let mut text = outcome.clocks.as_ref().map(clock_text).unwrap_or_default();
    for words in &outcome.last_words {
        writeln!(text, "FAILED    closing: {words}").expect("writing to a string");
    }
    let Counts { held, failed, refused } = counts(&outcome.tried);
    let identity = &outcome.caps.identity;
    let (name, driver, seconds) = (&identity.name, identity.driver_text(), outcome.seconds);
    writeln!(text, "{held} held, {failed} failed, {refused} refused in {seconds:.0} s on {name} ({driver})")
        .expect("writing to a string");
    match file {
        Some(file) => {
            text + &format!(
                "{file} is the document to send: attach it to a report, whether its tests passed or failed\n"
            )
        }
        None => text + "-o FILE.json writes these results as one document to send with a report\n",
    }
}

fn clock_text(clocks: &Clocks) -> String {
    if let Some(why) = &clocks.refused {
        return format!("refused   clocks  {why}\n");
    }
    if !clocks.complaints.is_empty() {
        let complaints: String = clocks.complaints.iter().map(|text| format!("\n           {text}")).collect();
        return format!("FAILED    clocks{complaints}\n");
    }
    let ratios: Vec<String> =
        clocks.frames.iter().map(|frame| format!("{} {:.3}", frame.technique, frame.ratio)).collect();
    let calibrated = match clocks.calibrated {
        Some(calibrated) => format!("calibrated, {:.6} of the host's", calibrated.ratio),
        None => "not calibrated".to_owned(),
    };
    let (bits, period) = (clocks.timestamp_bits, clocks.timestamp_period_ns);
    format!(
        "held      clocks  {bits} bits of {period} ns, {calibrated}; by timestamps of wall time: {}\n",
        ratios.join(", ")
    )
}
