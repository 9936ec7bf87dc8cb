//! `quincunx memory`: every byte of a technique, with its owner and its lifetime, as a table, as JSON, as pictures and as a page; what
//! two of them differ in; and the smallest budget.

use super::asked::Asked;
use super::job_args;
use crate::caps::{file, known};
use crate::cli::output::{folder_flag, print, print_text};
use crate::error::{Error, Result};
use crate::report::memory::MemoryReport;
use crate::report::memory::difference::{Difference, Side};
use crate::report::memory::drawing::PICTURES;
use crate::report::memory::vma;
use crate::study::heaps;
use crate::study::least::least;
use crate::study::page::{self, Shown};
use crate::study::{self, Study};
use crate::techniques::Rival;
use crate::units::Bytes;
use crate::whole_file::{make_folder, read_document, write_whole};
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Command};
use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Note above a table whose bytes no driver has rounded.
const UNROUNDED: &str = "how this driver rounds sizes has not been measured: it takes these bytes, or more\n";

/// The verb with its arguments.
pub fn command(asked: &Asked) -> Command {
    let command = Command::new("memory")
        .about("Print the memory that a technique needs: each resource with its bytes, memory type and lifetime, and the peak")
        .arg(
            Arg::new("plan")
                .long("plan")
                .action(ArgAction::SetTrue)
                .help("Compute the table without a device, from the scene and a known driver's rules"),
        )
        .arg(Arg::new("caps").long("caps").value_name("NAME|FILE").requires("plan").help(format!(
            "Driver of --plan: {}, or a file that `devices --json` has printed, of whose devices --device names \
                     one [default: {}]",
            known::names().collect::<Vec<_>>().join(", "),
            known::DEFAULT
        )))
        .arg(
            Arg::new("aov")
                .long("aov")
                .value_name("NAME,...")
                .value_delimiter(',')
                .action(ArgAction::Append)
                .help("Stages to plan for reading back: they live until the frame's end"),
        )
        .arg(folder_flag(
            "Folder to write memory-TECHNIQUE.txt, .json, .lifetimes.svg, .blocks.svg and .vma.json (the last two where memory is \
             made) and index.html to",
        ))
        .arg(
            Arg::new("smallest-budget")
                .long("smallest-budget")
                .action(ArgAction::SetTrue)
                .requires("plan")
                .conflicts_with("memory-budget")
                .help("Find a --memory-budget that is enough while a mebibyte less is not, and what is given up for it"),
        );
    job_args::with_job_args(asked, command).mut_arg("technique", |technique| {
        technique
            .action(ArgAction::Append)
            .help("Technique to plan; may be repeated; each setting must be read by one of them; with --help: list their settings")
    })
    .arg(Arg::new("other").value_name("B.json").help(
        "With SCENE also a file that -o or --json wrote: what the second differs in from the first",
    ))
}

/// Prints the table of each technique, and fails then where one does not fit --memory-budget.
pub fn run(matches: &ArgMatches, argv: &[String]) -> Result<()> {
    if let Some(other) = matches.get_one::<String>("other") {
        return difference(matches, other);
    }
    let folder = matches.get_one::<PathBuf>("output");
    if let Some(folder) = folder {
        make_folder(folder)?;
    }
    let (mut documents, mut studies, mut budget) = (Vec::new(), Vec::new(), Ok(()));
    for mut job in job_args::jobs(matches, argv)? {
        job.aovs = matches.get_many::<String>("aov").into_iter().flatten().cloned().collect();
        let (study, smallest) = if matches.get_flag("plan") {
            let asked = matches.get_one::<String>("caps").map_or(known::DEFAULT, String::as_str);
            let (name, caps) = file::asked(asked, job.device.as_deref())?;
            let smallest = matches.get_flag("smallest-budget").then(|| least(&job, &caps)).transpose()?;
            (study::planned(&job, &name, &caps)?, smallest)
        } else {
            (study::made(&job)?, None)
        };
        let technique = job.technique.name();
        let rivals = job.technique.rivals();
        let mut document = document(technique, &study, &rivals);
        if let Some(smallest) = &smallest {
            document["smallest_budget"] = smallest.json();
        }
        let beside: String = rivals
            .iter()
            .map(|rival| {
                format!("beside it {}: {} = {} ({})\n", rival.name, rival.formula, Bytes(rival.bytes), rival.paper)
            })
            .collect();
        let smallest = smallest.map_or_else(String::new, |smallest| format!("\n{}", smallest.text()));
        let heaps = heaps::text(&study);
        let unrounded = if study.is_unrounded { UNROUNDED } else { "" };
        let text = format!(
            "{technique}: {} on {}\n{unrounded}\n{}{heaps}{beside}{smallest}",
            study.scene,
            study.device,
            study.table.text()
        );
        if let Some(folder) = folder {
            let file = |extension: &str| folder.join(format!("memory-{technique}.{extension}"));
            write_whole(&file("txt"), |out| write!(out, "{text}"))?;
            write_whole(&file("json"), |out| writeln!(out, "{document:#}"))?;
            write_pictures(&study, &file)?;
        }
        if !matches.get_flag("json") {
            let gap = if documents.is_empty() { "" } else { "\n" };
            print_text(matches, &format!("{gap}{text}"))?;
        }
        documents.push(document);
        studies.push((technique, study));
    }
    if let Some(folder) = folder {
        let shown: Vec<Shown<'_>> = studies.iter().map(|(technique, study)| Shown { technique, study }).collect();
        write_whole(&folder.join("index.html"), |out| out.write_all(page::text(&shown).as_bytes()))?;
    }
    for (_, study) in studies {
        budget = budget.and(study.budget);
    }
    if matches.get_flag("json") {
        print(&format!("{:#}\n", json!({ "schema": 1, "techniques": documents })))?;
    }
    budget
}

fn document(technique: &str, study: &Study, rivals: &[Rival]) -> Value {
    let rival = |rival: &Rival| json!({ "name": rival.name, "paper": rival.paper, "formula": rival.formula, "bytes": rival.bytes });
    let rivals: Vec<Value> = rivals.iter().map(rival).collect();
    let memory = study.table.json();
    let (scene, device, is_unrounded) = (&study.scene, &study.device, study.is_unrounded);
    json!({
        "technique": technique,
        "scene": scene,
        "device": device,
        "unrounded": is_unrounded,
        "memory": memory,
        "heaps": heaps::json(study),
        "rivals": rivals,
    })
}

/// What is drawn of a study, as files.
fn write_pictures(study: &Study, file: &impl Fn(&str) -> PathBuf) -> Result<()> {
    let report = study.table.report();
    for (name, draw) in PICTURES {
        if let Some(drawing) = draw(&report) {
            write_whole(&file(&format!("{name}.svg")), |out| out.write_all(drawing.file().as_bytes()))?;
        }
    }
    match vma::document(&report, &study.caps) {
        Some(document) => write_whole(&file("vma.json"), |out| writeln!(out, "{document:#}")),
        None => Ok(()),
    }
}

/// Prints what the second of two files differs in from the first.
fn difference(matches: &ArgMatches, second: &str) -> Result<()> {
    let read_flags = ["scene", "other", "json", "quiet"];
    let is_typed = |id: &&str| matches.value_source(id) == Some(ValueSource::CommandLine);
    let ids = matches.ids().map(|id| id.as_str());
    if let Some(flag) = ids.filter(is_typed).find(|id| !read_flags.contains(id)) {
        return Err(Error::request(format!("memory A.json B.json: nothing reads --{flag} there")));
    }
    let first = matches.get_one::<String>("scene").expect("it comes before");
    let [before, after] = [first, second].map(|path| read(Path::new(path)));
    let (before, after) = (before?, after?);
    let difference = Difference::new([&before, &after].map(|(name, memory)| Side { name, memory }));
    if matches.get_flag("json") {
        print(&format!("{:#}\n", difference.json()))
    } else {
        print_text(matches, &difference.text())
    }
}

/// The memory of one technique, and what it is called: of a file of -o or --json, or of a report of `render`.
///
/// Errors: the file cannot be read, or has none or several (exit code 2).
fn read(path: &Path) -> Result<(String, MemoryReport)> {
    let failed = |why: &dyn std::fmt::Display| Error::request(format!("{}: {why}", path.display()));
    let text = read_document(path)?;
    let mut document: Value = serde_json::from_str(&text).map_err(|error| failed(&error))?;
    if let Some(techniques) = document.get_mut("techniques").and_then(Value::as_array_mut) {
        match techniques.len() {
            1 => document = techniques.remove(0),
            count => {
                let error = failed(&format!("it has {count} techniques, and one is compared"));
                return Err(error.note("memory -o writes a file for each"));
            }
        }
    }
    let memory = document.get("memory").cloned().ok_or_else(|| {
        failed(&"it has no memory").note("memory -o, memory --json and render --report write files that have")
    })?;
    let memory: MemoryReport = serde_json::from_value(memory).map_err(|error| failed(&error))?;
    let technique = document.get("technique").and_then(Value::as_str).unwrap_or_default();
    Ok((format!("{technique}, {}", path.display()), memory))
}
