//! `quincunx bench locality`: what passes touch, and what caches make of it, counted without a device, beside measured times where there
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
use crate::locality::case::{Case, CopyStage};
use crate::locality::count::Counts;
use crate::locality::drawn::{self, Summary};
use crate::locality::filter::FilterCase;
use crate::locality::insert::InsertCase;
use crate::locality::machine::Machine;
use crate::locality::shade::ShadeCase;
use crate::locality::stage::{PassCounts, StageKind, Studied, cost, pair_text, total};
use crate::progress::Stage;
use crate::settings::parse_sides;
use crate::techniques::interleaved_deferred::split_method::{Form, StorageKind};
use crate::units::Extent;
use crate::whole_file::{make_folder, read_document, write_whole};
use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::str::FromStr;

pub const NAME: &str = "locality";

/// Keys of --sweep with their values where they are not swept.
const DEFAULTS: [(&str, &str); 15] = [
    ("split", "one-pass"),
    ("pattern", "4x4"),
    ("block", "16x16"),
    ("copy", "pull"),
    ("storage", "image"),
    ("workgroup", "16x16"),
    ("size", "640x360"),
    ("texels", "1"),
    ("vpls", "64"),
    ("filter", "gauss"),
    ("kernel", "5"),
    ("spp", "8"),
    ("tuples", "auto"),
    ("triangle", "8"),
    ("blur", "0"),
];

/// Stages where none are named.
const STAGES: &str = "split,gather";

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
        .about(
            "Lines, sectors and cache misses of splits, gathers and other stages, counted without a device on known or drawn machines",
        )
        .arg(
            Arg::new("stage")
                .long("stage")
                .value_name("STAGE,...")
                .value_delimiter(',')
                .value_parser(PossibleValuesParser::new(StageKind::WORDS))
                .default_value(STAGES)
                .help(
                    "Stages to count: split and gather of interleaved_deferred, its shading (shade), the discontinuities with the filter \
                     (filter), and list insertion of deep_shading (insert)",
                ),
        )
        .arg(
            Arg::new("sweep")
                .long("sweep")
                .value_name("KEY=V,V,...")
                .action(ArgAction::Append)
                .help(format!(
                    "Values of one of {}, one axis of the grid, for the stages that know it; may be repeated",
                    keys.join(", ")
                )),
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
                .conflicts_with_all(["machine", "measured", "stage"])
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
                .help("Folder with rows of `bench split`, `gather`, `shade` or `filter`, whose times stand beside the counts; may be repeated"),
        )
        .arg(output::folder_flag("Folder to write locality.json and locality.txt to"))
        .arg(quiet_flag())
        .arg(Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print the results as JSON on standard output"))
}

/// Counts, prints and writes.
pub fn run(matches: &ArgMatches, argv: &[String]) -> Result<()> {
    progress::install(matches.get_flag("quiet"));
    let sweeps: Vec<String> = matches.get_many::<String>("sweep").into_iter().flatten().cloned().collect();
    let stages = stages(matches);
    let axes = axes(&sweeps, &stages)?;
    let (mut document, text) = match matches.get_one::<u64>("drawn") {
        Some(count) => {
            of_drawn(&axes, !sweeps.is_empty(), *count, *matches.get_one::<u64>("seed").expect("it has a default"))?
        }
        None => of_known(&stages, &axes, &machines(matches)?, &measured(matches)?)?,
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

/// Each once, in the order of a frame.
fn stages(matches: &ArgMatches) -> Vec<StageKind> {
    let named: Vec<&String> = matches.get_many("stage").expect("it has a default").collect();
    StageKind::ALL.iter().copied().filter(|stage| named.iter().any(|name| *name == stage.name())).collect()
}

fn axes(sweeps: &[String], stages: &[StageKind]) -> Result<Vec<Axis>> {
    if sweeps.is_empty() {
        return Ok(AXES.iter().map(|(key, values)| Axis::new(key, values)).collect());
    }
    let axes = sweep::axes(sweeps)?;
    let names = |stages: &[StageKind]| stages.iter().map(|stage| stage.name()).collect::<Vec<_>>().join(",");
    let know = |key: &str| -> Vec<StageKind> {
        StageKind::ALL.iter().copied().filter(|stage| stage.keys().contains(&key)).collect()
    };
    let is_known = |axis: &&Axis| know(&axis.key).iter().any(|stage| stages.contains(stage));
    match axes.iter().find(|axis| !is_known(axis)) {
        Some(axis) => {
            let keys = DEFAULTS.iter().map(|(key, _)| *key);
            let keys: Vec<&str> = keys.filter(|key| know(key).iter().any(|stage| stages.contains(stage))).collect();
            let others = know(&axis.key);
            let elsewhere =
                if others.is_empty() { String::new() } else { format!("; --stage {} knows it", names(&others)) };
            Err(Error::request(format!("--sweep {}: --stage {} knows no such key", axis.key, names(stages)))
                .note(format!("there are {}{elsewhere}", keys.join(", "))))
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

fn number<T: FromStr>(key: &str, text: &str, what: &str) -> Result<T> {
    text.parse().map_err(|_| Error::request(format!("--sweep {key}={text}: it must be {what}")))
}

/// A stage at a point of the grid.
fn study(stage: StageKind, point: &Point) -> Result<Box<dyn Studied>> {
    let text = |key: &str| {
        let own = point.iter().find(|(known, _)| known == key).map(|(_, text)| text.as_str());
        own.unwrap_or_else(|| DEFAULTS.iter().find(|(known, _)| *known == key).expect("a key of the table").1)
    };
    let side = |key: &str| pair(key, text(key));
    let whole = |key: &str| number::<u32>(key, text(key), "a whole number");
    let [width, height] = side("size")?;
    let extent = Extent::new(width, height);
    let case = || {
        Case {
            extent,
            split: word("split", text("split"))?,
            pattern: side("pattern")?,
            block: side("block")?,
            form: word("copy", text("copy"))?,
            storage: word("storage", text("storage"))?,
            workgroup: side("workgroup")?,
        }
        .checked()
    };
    Ok(match stage {
        StageKind::Split | StageKind::Gather => {
            Box::new(CopyStage { case: case()?, is_back: stage == StageKind::Gather })
        }
        StageKind::Shade => Box::new(
            ShadeCase {
                extent,
                split: word("split", text("split"))?,
                pattern: side("pattern")?,
                block: side("block")?,
                storage: word("storage", text("storage"))?,
                workgroup: side("workgroup")?,
                texels: whole("texels")?,
                vpls: whole("vpls")?,
            }
            .checked()?,
        ),
        StageKind::Filter => Box::new(
            FilterCase {
                extent,
                filter: word("filter", text("filter"))?,
                taps: whole("kernel")?,
                pattern: side("pattern")?,
                texels: whole("texels")?,
                workgroup: side("workgroup")?,
            }
            .checked()?,
        ),
        StageKind::Insert => {
            let samples = whole("spp")?;
            let tuples = if text("tuples") == "auto" { samples } else { whole("tuples")? };
            let triangle_px = whole("triangle")?;
            let blur_px = number("blur", text("blur"), "a number")?;
            Box::new(InsertCase { extent, samples, tuples, triangle_px, blur_px }.checked()?)
        }
    })
}

/// The stages of the grid, each once: those that differ in what they do not read are one.
fn studies(stages: &[StageKind], axes: &[Axis]) -> Result<Vec<Box<dyn Studied>>> {
    let mut studies: Vec<Box<dyn Studied>> = Vec::new();
    let key = |study: &dyn Studied| (study.stage(), study.label(), study.extent(), study.workgroup());
    for point in sweep::grid(axes) {
        for stage in stages {
            let study = study(*stage, &point)?;
            if !studies.iter().any(|known| key(known.as_ref()) == key(study.as_ref())) {
                studies.push(study);
            }
        }
    }
    Ok(studies)
}

fn of_known(
    stages: &[StageKind],
    axes: &[Axis],
    machines: &[Machine],
    measured: &[BenchRow],
) -> Result<(Value, String)> {
    let studies = studies(stages, axes)?;
    let is_copied = stages.iter().all(|stage| matches!(stage, StageKind::Split | StageKind::Gather));
    let what = if is_copied { "copy" } else { "stage" };
    let stage = Stage::counted("counting", if is_copied { "copies" } else { "stages" });
    let (mut rows, mut text) = (Vec::new(), String::new());
    for (done, machine) in machines.iter().enumerate() {
        let titles = [
            what,
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
        for (index, study) in studies.iter().enumerate() {
            interrupt::check()?;
            let passes = study.counted(machine);
            let counts = total(&passes);
            let ms = measured_ms(study.as_ref(), measured);
            lines.push(line(study.as_ref(), &counts, machine));
            if !measured.is_empty() {
                let text = ms.map_or_else(|| "-".to_owned(), |ms| format!("{ms:.3}"));
                lines.last_mut().expect("it was pushed").push(text);
            }
            rows.push(row(study.as_ref(), machine, &passes, &counts, ms));
            stage.reach((done * studies.len() + index + 1) as u64, (machines.len() * studies.len()) as u64);
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

fn line(study: &dyn Studied, counts: &Counts, machine: &Machine) -> Vec<String> {
    let instructions = counts.instructions as f64;
    let asked = counts.asked_bytes as f64;
    let pixels = study.extent().pixel_count() as f64;
    let part = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
    [
        format!("{}: {}", study.stage().name(), study.label()),
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

fn row(study: &dyn Studied, machine: &Machine, passes: &[PassCounts], counts: &Counts, ms: Option<f64>) -> Value {
    json!({
        "stage": study.stage().name(),
        "case": study.label(),
        "size": study.extent().to_string(),
        "workgroup": study.workgroup(),
        "machine": machine.name,
        "passes": passes,
        "total": counts,
        "cost_bytes": cost(counts, machine),
        "measured_ms": ms,
    })
}

/// The median time of the row of this stage with its settings; None: there is none.
fn measured_ms(study: &dyn Studied, rows: &[BenchRow]) -> Option<f64> {
    let own = [("size", study.extent().to_string()), ("workgroup", pair_text(study.workgroup()))];
    let settings: Vec<(&str, String)> = study.settings().into_iter().chain(own).collect();
    let has = |row: &&BenchRow| {
        let is = |(key, text): &(&str, String)| row.settings.get(*key).is_some_and(|value| value.to_string() == *text);
        row.bench == study.stage().name() && settings.iter().all(is)
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
