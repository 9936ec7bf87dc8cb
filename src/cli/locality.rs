//! `quincunx bench locality`: what copies touch, and what caches make of it, counted without a device, beside measured times where there
//! are some.

use super::output::{self, print, print_text, quiet_flag};
use super::progress;
use crate::bench::row::BenchRow;
use crate::bench::rows_file::RowsFile;
use crate::bench::sweep::{self, Axis, Point};
use crate::bench::table::Table;
use crate::choice::Choice;
use crate::error::{Error, Result};
use crate::interrupt;
use crate::locality::case::{Case, PassCounts, cost, total};
use crate::locality::count::Counts;
use crate::locality::drawn::{self, Summary};
use crate::locality::machine::Machine;
use crate::progress::Stage;
use crate::settings::parse_sides;
use crate::techniques::interleaved_deferred::split_method::{Form, Split, StorageKind};
use crate::units::Extent;
use crate::whole_file::{make_folder, read_document, write_whole};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};

pub const NAME: &str = "locality";

/// Keys of --sweep with their values where they are not swept.
const DEFAULTS: [(&str, &str); 7] = [
    ("split", "one-pass"),
    ("pattern", "4x4"),
    ("block", "16x16"),
    ("copy", "pull"),
    ("storage", "image"),
    ("workgroup", "16x16"),
    ("size", "640x360"),
];

/// Blocks where none are named.
const BLOCKS: &[&str] = &["8", "16", "32"];

/// The axes of a command without --sweep.
const AXES: [(&str, &[&str]); 3] =
    [("pattern", &["2x2", "4x4"]), ("split", &["one-pass", "two-pass"]), ("block", BLOCKS)];

/// The sub-verb with its arguments.
pub fn command() -> Command {
    let keys: Vec<&str> = DEFAULTS.iter().map(|(key, _)| *key).collect();
    let machines: Vec<String> = Machine::all().into_iter().map(|machine| machine.name).collect();
    Command::new(NAME)
        .about("Lines, sectors and cache misses of splits and gathers, counted without a device on known or drawn machines")
        .arg(
            Arg::new("sweep")
                .long("sweep")
                .value_name("KEY=V,V,...")
                .action(ArgAction::Append)
                .help(format!("Values of one of {}, one axis of the grid; may be repeated", keys.join(", "))),
        )
        .arg(
            Arg::new("machine")
                .long("machine")
                .value_name("NAME|FILE.json")
                .action(ArgAction::Append)
                .help(format!("Machine, of {}, or a file of the same keys; may be repeated [default: all]", machines.join(", "))),
        )
        .arg(
            Arg::new("drawn")
                .long("drawn")
                .value_name("N")
                .value_parser(value_parser!(u64).range(1..=100_000))
                .conflicts_with_all(["machine", "measured"])
                .help("Draw N machines instead, and say on how many of them two passes gain, at which pattern more, and which block is best"),
        )
        .arg(
            Arg::new("seed")
                .long("seed")
                .value_name("N")
                .value_parser(value_parser!(u64))
                .default_value("1")
                .requires("drawn")
                .help("Seed of drawn machines"),
        )
        .arg(
            Arg::new("measured")
                .long("measured")
                .value_name("DIR")
                .action(ArgAction::Append)
                .value_parser(value_parser!(PathBuf))
                .help("Folder with rows of `bench split` or `bench gather`, whose times stand beside the counts; may be repeated"),
        )
        .arg(output::folder_flag("Folder to write locality.json and locality.txt to"))
        .arg(quiet_flag())
        .arg(Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print the results as JSON on standard output"))
}

/// Counts, prints and writes.
pub fn run(matches: &ArgMatches, argv: &[String]) -> Result<()> {
    progress::install(matches.get_flag("quiet"));
    let sweeps: Vec<String> = matches.get_many::<String>("sweep").into_iter().flatten().cloned().collect();
    let axes = axes(&sweeps)?;
    let (mut document, text) = match matches.get_one::<u64>("drawn") {
        Some(count) => {
            of_drawn(&axes, !sweeps.is_empty(), *count, *matches.get_one::<u64>("seed").expect("it has a default"))?
        }
        None => of_known(&axes, &machines(matches)?, &measured(matches)?)?,
    };
    document["schema"] = json!(1);
    document["command"] = json!(argv);
    document["commit"] = json!(env!("QUINCUNX_COMMIT"));
    if let Some(folder) = matches.get_one::<PathBuf>("output") {
        make_folder(folder)?;
        write_whole(&folder.join("locality.json"), |out| writeln!(out, "{document:#}"))?;
        write_whole(&folder.join("locality.txt"), |out| out.write_all(text.as_bytes()))?;
    }
    match matches.get_flag("json") {
        true => print(&format!("{document:#}\n")),
        false => print_text(matches, &text),
    }
}

fn axes(sweeps: &[String]) -> Result<Vec<Axis>> {
    if sweeps.is_empty() {
        return Ok(AXES.iter().map(|(key, values)| Axis::new(key, values)).collect());
    }
    let axes = sweep::axes(sweeps)?;
    let is_known = |axis: &&Axis| DEFAULTS.iter().any(|(key, _)| *key == axis.key);
    match axes.iter().find(|axis| !is_known(axis)) {
        Some(axis) => {
            let keys: Vec<&str> = DEFAULTS.iter().map(|(key, _)| *key).collect();
            Err(Error::request(format!("--sweep {}: locality knows no such key", axis.key))
                .note(format!("there are {}", keys.join(", "))))
        }
        None => Ok(axes),
    }
}

/// Errors: a machine is unknown, or its file is none (exit code 2).
fn machines(matches: &ArgMatches) -> Result<Vec<Machine>> {
    let Some(names) = matches.get_many::<String>("machine") else { return Ok(Machine::all()) };
    let machine = |name: &String| {
        if !name.ends_with(".json") {
            return Machine::known(name);
        }
        let text = read_document(Path::new(name))?;
        let machine: Machine = serde_json::from_str(&text)
            .map_err(|error| Error::request(format!("{name}: it is no machine: {error}")))?;
        machine.check().map_err(|error| error.within(name))?;
        Ok(machine)
    };
    names.map(machine).collect()
}

fn measured(matches: &ArgMatches) -> Result<Vec<BenchRow>> {
    let folders = matches.get_many::<PathBuf>("measured").into_iter().flatten();
    Ok(folders.map(|folder| RowsFile::rows(folder)).collect::<Result<Vec<_>>>()?.into_iter().flatten().collect())
}

/// `4x4`, or `4` for both.
fn pair(key: &str, text: &str) -> Result<[u32; 2]> {
    parse_sides(text).ok_or_else(|| Error::request(format!("--sweep {key}={text}: it must be N or NxM")))
}

fn word<T: Choice>(key: &str, text: &str) -> Result<T> {
    T::from_word(text).ok_or_else(|| Error::request(format!("--sweep {key}={text}: there is no such {key}")))
}

/// The case of a point of the grid.
fn case(point: &Point) -> Result<Case> {
    let text = |key: &str| {
        let own = point.iter().find(|(known, _)| known == key).map(|(_, text)| text.as_str());
        own.unwrap_or_else(|| DEFAULTS.iter().find(|(known, _)| *known == key).expect("a key of the table").1)
    };
    let side = |key: &str| pair(key, text(key));
    let [width, height] = side("size")?;
    Case {
        extent: Extent::new(width, height),
        split: word("split", text("split"))?,
        pattern: side("pattern")?,
        block: side("block")?,
        form: word("copy", text("copy"))?,
        storage: word("storage", text("storage"))?,
        workgroup: side("workgroup")?,
    }
    .checked()
}

/// Cases of the grid, each once: those that differ in blocks that nothing has are one.
fn cases(axes: &[Axis]) -> Result<Vec<Case>> {
    let mut cases: Vec<Case> = Vec::new();
    let same = |a: &Case, b: &Case| (a.label(), a.extent, a.workgroup) == (b.label(), b.extent, b.workgroup);
    for point in sweep::grid(axes) {
        let case = case(&point)?;
        if !cases.iter().any(|known| same(known, &case)) {
            cases.push(case);
        }
    }
    Ok(cases)
}

fn of_known(axes: &[Axis], machines: &[Machine], measured: &[BenchRow]) -> Result<(Value, String)> {
    let cases = cases(axes)?;
    let stage = Stage::counted("counting", "copies");
    let (mut rows, mut text) = (Vec::new(), String::new());
    for (done, machine) in machines.iter().enumerate() {
        let titles = [
            "copy",
            "lines",
            "sectors",
            "misses of the first",
            "of the second",
            "from memory",
            "to memory",
            "moved",
            "cost",
        ];
        let mut lines = vec![titles.map(str::to_owned).to_vec()];
        if !measured.is_empty() {
            lines[0].push("measured ms".to_owned());
        }
        for (index, case) in cases.iter().enumerate() {
            interrupt::check()?;
            let found = case.counted(machine);
            for (stage, passes) in [("split", &found.split), ("gather", &found.gather)] {
                let counts = total(passes);
                let ms = measured_ms(stage, case, measured);
                lines.push(line(&format!("{stage}: {}", case.label()), case, &counts, machine));
                if !measured.is_empty() {
                    let text = ms.map_or_else(|| "-".to_owned(), |ms| format!("{ms:.3}"));
                    lines.last_mut().expect("it was pushed").push(text);
                }
                rows.push(row(stage, case, machine, passes, &counts, ms));
            }
            stage.reach((done * cases.len() + index + 1) as u64, (machines.len() * cases.len()) as u64);
        }
        let assumed = if machine.assumed.is_empty() {
            String::new()
        } else {
            format!("; assumed: {}", machine.assumed.join(", "))
        };
        text += &format!("{} ({}{assumed})\n\n{}\n", machine.name, machine.source, Table::of_lines(lines).text());
    }
    text += "lines and sectors are those of an instruction of a warp; bytes are in parts of those that the threads ask for\n";
    Ok((json!({ "machines": machines, "rows": rows }), text))
}

fn line(name: &str, case: &Case, counts: &Counts, machine: &Machine) -> Vec<String> {
    let instructions = counts.instructions as f64;
    let asked = counts.asked_bytes as f64;
    let pixels = case.extent.pixel_count() as f64;
    let part = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
    [
        name.to_owned(),
        format!("{:.2}", part(counts.lines as f64, instructions)),
        format!("{:.2}", part(counts.sectors as f64, instructions)),
        format!("{:.1} %", 100.0 * part(counts.first_misses as f64, counts.first_reads as f64)),
        format!("{:.1} %", 100.0 * part(counts.second_misses as f64, counts.second_reads as f64)),
        format!("{:.3}", part(counts.memory_read_bytes as f64, asked)),
        format!("{:.3}", part(counts.memory_written_bytes as f64, asked)),
        format!("{:.1} B a pixel", part(asked, pixels)),
        format!("{:.1} B a pixel", cost(counts, machine) / pixels),
    ]
    .to_vec()
}

fn row(stage: &str, case: &Case, machine: &Machine, passes: &[PassCounts], counts: &Counts, ms: Option<f64>) -> Value {
    json!({
        "stage": stage,
        "case": case.label(),
        "size": case.extent.to_string(),
        "workgroup": case.workgroup,
        "machine": machine.name,
        "passes": passes,
        "total": counts,
        "cost_bytes": cost(counts, machine),
        "measured_ms": ms,
    })
}

/// The median time of the row of this stage with the settings of a case; None: there is none.
fn measured_ms(stage: &str, case: &Case, rows: &[BenchRow]) -> Option<f64> {
    let pair = |[x, y]: [u32; 2]| format!("{x}x{y}");
    let has = |row: &&BenchRow| {
        let is = |key: &str, text: &str| row.settings.get(key).is_some_and(|value| value.to_string() == text);
        row.bench == stage
            && is("split", case.split.name())
            && is("pattern", &pair(case.pattern))
            && (case.split == Split::OnePass || is("block", &pair(case.block)))
            && is("copy", case.form.name())
            && is("size", &case.extent.to_string())
            && is("workgroup", &pair(case.workgroup))
            && is("storage", case.storage.name())
    };
    Some(rows.iter().find(has)?.times_ms()?.median)
}

/// `is_typed`: whether the axes are those of --sweep.
fn of_drawn(axes: &[Axis], is_typed: bool, count: u64, seed: u64) -> Result<(Value, String)> {
    if let Some(axis) = axes.iter().find(|axis| is_typed && ["split", "pattern"].contains(&axis.key.as_str())) {
        let why = "one pass is held against two, at 2x2 and at 4x4";
        return Err(Error::request(format!("--drawn with --sweep {}=: {why}", axis.key)));
    }
    let values = |key: &str| axes.iter().find(|axis| axis.key == key).map(|axis| &axis.values[..]);
    let one = |key: &str| match values(key) {
        None => Ok(DEFAULTS.iter().find(|(known, _)| *known == key).expect("a key of the table").1.to_owned()),
        Some([only]) => Ok(only.clone()),
        Some(_) => Err(Error::request(format!("--drawn with --sweep {key}=: one value, of blocks alone several"))),
    };
    let blocks = values("block").unwrap_or_default();
    let blocks =
        if blocks.is_empty() { BLOCKS.iter().map(|text| (*text).to_owned()).collect() } else { blocks.to_vec() };
    let pairs = blocks.iter().map(|text| pair("block", text)).collect::<Result<Vec<_>>>()?;
    let [width, height] = pair("size", &one("size")?)?;
    let request = drawn::Request {
        extent: Extent::new(width, height),
        blocks: &pairs,
        form: word::<Form>("copy", &one("copy")?)?,
        storage: word::<StorageKind>("storage", &one("storage")?)?,
        workgroup: pair("workgroup", &one("workgroup")?)?,
        machines: count,
        seed,
    };
    let stage = Stage::counted("counting", "machines");
    let all = drawn::drawn(&request, &mut |done| stage.reach(done, count))?;
    drop(stage);
    let summary = Summary::of(&all);
    let text = drawn_text(&summary, &blocks, seed);
    Ok((json!({ "seed": seed, "blocks": blocks, "summary": summary, "drawn": all }), text))
}

fn drawn_text(summary: &Summary, blocks: &[String], seed: u64) -> String {
    let mut lines =
        vec![["pattern", "two passes cost less", "gain: least", "median", "most"].map(str::to_owned).to_vec()];
    lines[0].extend(blocks.iter().map(|block| format!("regret of block {block}")));
    for (index, pattern) in ["2x2", "4x4"].into_iter().enumerate() {
        let [least, median, most] = summary.gains[index].map(|gain| format!("{gain:.3}"));
        let share = format!("{:.1} %", 100.0 * summary.two_passes_win[index]);
        let mut line = vec![pattern.to_owned(), share, least, median, most];
        line.extend(summary.mean_regrets[index].iter().map(|regret| format!("{:.1} %", 100.0 * regret)));
        lines.push(line);
    }
    format!(
        "{} machines drawn from seed {seed}; gain: cost of one pass in parts of that of two with the best block; regret: mean cost \
         above that of the best block\n\n{}\nthe gain of two passes is larger at 4x4 than at 2x2 on {:.1} % of them\n",
        summary.machines,
        Table::of_lines(lines).text(),
        100.0 * summary.gain_grows
    )
}
