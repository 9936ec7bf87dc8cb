//! `quincunx bench allocate`: traces of allocations through each strategy and through allocators of others.

use super::output::{self, print, print_text, quiet_flag};
use super::progress;
use crate::bench::allocate::contender::{Place, Variant};
use crate::bench::allocate::generated::{Generated, generated};
use crate::bench::allocate::rows::{self, AllocateRow};
use crate::bench::allocate::verdict::{self, Verdict, verdicts};
use crate::bench::sweep::{self, Axis, Point};
use crate::caps::{Caps, file, known};
use crate::choice::Choice;
use crate::error::{Error, Result};
use crate::gpu::{DeviceRequest, Gpu};
use crate::job::fail_on_validation;
use crate::memory::Strategy;
use crate::memory::trace::{Trace, summary};
use crate::progress::Stage;
use crate::settings::{COMMON, Setting, Values};
use crate::whole_file::{make_folder, write_whole};
use clap::{Arg, ArgAction, ArgMatches, Command};
use serde_json::json;
use std::io::Write;
use std::path::{Path, PathBuf};

pub const NAME: &str = "allocate";

/// Settings that are swept.
const STRATEGY: &str = "allocation";
const BLOCK: &str = "memory-block";

/// Said where rivals could be measured and are not built.
const NO_RIVALS: &str = "allocators of others are not in this build: cargo build --release --features rivals\n";

/// The sub-verb with its arguments.
pub fn command() -> Command {
    let flag = |name: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue);
    let names = Generated::ALL.iter().map(|one| format!("{} ({})", one.name(), one.summary()));
    Command::new(NAME)
        .about("Replay recorded and generated allocations through each strategy, without a device or on one: time, peak, waste, fragmentation")
        .arg(Arg::new("trace").value_name("TRACE").action(ArgAction::Append).help(format!(
            "A file of render --record-allocations (.jsonl), or one of {}; with count=N,seed=N after a colon; several are \
             replayed one after the other [default: all of these]",
            names.collect::<Vec<_>>().join(", ")
        )))
        .arg(
            Arg::new("sweep")
                .long("sweep")
                .value_name("KEY=V,V,...")
                .action(ArgAction::Append)
                .help(format!(
                    "Values of {STRATEGY} or {BLOCK}, one axis of the grid; may be repeated; the first row is the one that \
                     ratios are to [default: {STRATEGY}={}]",
                    Strategy::WORDS.join(",")
                )),
        )
        .arg(output::repeat_flag("Number of rounds, each of which replays a trace through every row once; intervals need three"))
        .arg(
            Arg::new("caps")
                .long("caps")
                .value_name("NAME|FILE")
                .conflicts_with("on-device")
                .help(format!("Driver whose memory types and limits hold, of `memory --plan` [default: {}]", known::DEFAULT)),
        )
        .arg(flag("on-device").help(
            "Allocate on a device: times include the driver's, and allocators of others are there where they are built \
             (--features rivals)",
        ))
        .arg(
            Arg::new("device")
                .long("device")
                .value_name("SUBSTRING|INDEX")
                .help("Device of --on-device or of the file of --caps, by a part of its name or its index in `quincunx devices`"),
        )
        .arg(flag("validate").requires("on-device").help("Run under the validation layer; a message fails the command"))
        .arg(output::folder_flag("Folder to write allocate.json and allocate.txt to"))
        .arg(quiet_flag())
        .arg(flag("json").help("Print a line of JSON for each row, and one for each comparison with others, on standard output"))
}

/// Replays, prints and writes.
pub fn run(matches: &ArgMatches, argv: &[String]) -> Result<()> {
    progress::install(matches.get_flag("quiet"));
    let variants = variants(matches)?;
    let selector = matches.get_one::<String>("device").cloned();
    if !matches.get_flag("on-device") {
        let asked = matches.get_one::<String>("caps").map_or(known::DEFAULT, String::as_str);
        let (_, caps) = file::asked(asked, selector.as_deref())?;
        return replay(matches, argv, &variants, &Place::Numbers(&caps));
    }
    let gpu =
        Gpu::open(&DeviceRequest { selector, validate: matches.get_flag("validate"), ..DeviceRequest::default() })?;
    replay(matches, argv, &variants, &Place::Device(&gpu))?;
    let log = gpu.validation_log();
    drop(gpu);
    fail_on_validation(log.as_deref())
}

/// Errors: a file is no trace, or a name is none (exit code 2).
fn traces(matches: &ArgMatches, caps: &Caps) -> Result<Vec<Trace>> {
    let trace = |text: &str| match Path::new(text).extension() {
        Some(extension) if extension == "jsonl" => Trace::read(Path::new(text)),
        _ => generated(text, caps),
    };
    match matches.get_many::<String>("trace") {
        None => Generated::WORDS.iter().map(|name| trace(name)).collect(),
        Some(names) => names.map(|name| trace(name)).collect(),
    }
}

fn replay(matches: &ArgMatches, argv: &[String], variants: &[Variant], place: &Place<'_>) -> Result<()> {
    let repeat = *matches.get_one::<u32>("repeat").expect("it has a default") as usize;
    let (mut all, mut compared, mut text): (Vec<AllocateRow>, Vec<Verdict>, String) = Default::default();
    for trace in traces(matches, place.caps())? {
        let stage = Stage::counted(&format!("replaying {}", trace.name), "replays");
        let found = rows::run(&trace, place, variants, repeat, &mut |done, all| stage.reach(done as u64, all as u64))?;
        drop(stage);
        let verdicts = verdicts(&found);
        let part =
            format!("{}: {}\n\n{}\n{}", trace.name, summary(&trace), rows::text(&found), verdict::text(&verdicts));
        text += &format!("{}\n\n", part.trim_end());
        all.extend(found);
        compared.extend(verdicts);
    }
    text += &format!(
        "replayed {}, {repeat} rounds\n",
        match place {
            Place::Numbers(caps) => format!("as numbers, under the limits of {}", caps.identity.name),
            Place::Device(gpu) => format!("on {}", gpu.caps.identity.name),
        }
    );
    if !cfg!(feature = "rivals") {
        text += NO_RIVALS;
    }
    if let Some(folder) = matches.get_one::<PathBuf>("output") {
        make_folder(folder)?;
        let commit = env!("QUINCUNX_COMMIT");
        let document = json!({ "schema": 1, "command": argv, "commit": commit, "rows": all, "verdicts": compared });
        write_whole(&folder.join("allocate.json"), |out| writeln!(out, "{document:#}"))?;
        write_whole(&folder.join("allocate.txt"), |out| out.write_all(text.as_bytes()))?;
    }
    if !matches.get_flag("json") {
        return print_text(matches, &text);
    }
    let verdict = |one: &Verdict| serde_json::to_string(one).expect("its keys are texts");
    print(
        &all.iter()
            .map(AllocateRow::line)
            .chain(compared.iter().map(verdict))
            .map(|line| line + "\n")
            .collect::<String>(),
    )
}

/// The rows of the grid, each once: where each resource has a memory block of its own, shared ones have no size.
///
/// Errors: another key, or an impossible value (exit code 2).
fn variants(matches: &ArgMatches) -> Result<Vec<Variant>> {
    let sweeps: Vec<String> = matches.get_many::<String>("sweep").into_iter().flatten().cloned().collect();
    let mut axes = sweep::axes(&sweeps)?;
    if !axes.iter().any(|axis| axis.key == STRATEGY) {
        axes.insert(0, Axis::new(STRATEGY, Strategy::WORDS));
    }
    let settings: Vec<Setting> = COMMON.iter().filter(|row| [STRATEGY, BLOCK].contains(&row.key)).copied().collect();
    let mut variants: Vec<Variant> = Vec::new();
    for point in sweep::grid(&axes) {
        let mut values = Values::defaults(&settings);
        for (key, text) in &point {
            let setting = settings.iter().find(|setting| setting.key == key).ok_or_else(|| {
                Error::request(format!("--sweep {key}: what allocates has no such setting"))
                    .note(format!("there are {STRATEGY} and {BLOCK}"))
            })?;
            values.set(setting, text)?;
        }
        let strategy: Strategy = values.choice(STRATEGY);
        let is_read = |(key, _): &&(String, String)| strategy.shares_blocks() || key != BLOCK;
        let read: Point = point.iter().filter(is_read).cloned().collect();
        let (label, block_bytes) = (sweep::label(&read), values.unless_auto(BLOCK, Values::power_of_bytes));
        if !variants.iter().any(|known| known.label == label) {
            variants.push(Variant { label, strategy, block_bytes });
        }
    }
    Ok(variants)
}
