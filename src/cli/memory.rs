//! `quincunx memory`: every byte of a technique, with its owner and its lifetime, as a table or as JSON.

use super::job_args;
use super::listed::TechniqueSelection;
use crate::caps::{file, known};
use crate::cli::output::{print, print_text};
use crate::error::{Error, Result};
use crate::study::{self, Study};
use crate::techniques::Rival;
use crate::units::Bytes;
use crate::whole_file::write_whole;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use serde_json::{Value, json};
use std::io::Write;
use std::path::PathBuf;

/// Note above a table whose bytes no driver has rounded.
const UNROUNDED: &str = "how this driver rounds sizes has not been measured: it takes these bytes, or more\n";

/// The verb with its arguments.
pub fn command(listed: &TechniqueSelection) -> Command {
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
        .arg(
            Arg::new("output")
                .short('o')
                .long("output")
                .value_name("DIR")
                .value_parser(value_parser!(PathBuf))
                .help("Folder to write memory-TECHNIQUE.txt and memory-TECHNIQUE.json to"),
        );
    job_args::with_job_args(listed, command).mut_arg("technique", |technique| {
        technique
            .action(ArgAction::Append)
            .help("Technique to plan; may be repeated; each setting must be read by one of them; with --help: list their settings")
    })
}

/// Prints the table of each technique, and fails then where one does not fit --memory-budget.
pub fn run(matches: &ArgMatches, argv: &[String]) -> Result<()> {
    let folder = matches.get_one::<PathBuf>("output");
    if let Some(folder) = folder {
        std::fs::create_dir_all(folder).map_err(|error| Error::request(format!("-o {}: {error}", folder.display())))?;
    }
    let (mut documents, mut budget) = (Vec::new(), Ok(()));
    for mut job in job_args::jobs(matches, argv)? {
        job.aovs = matches.get_many::<String>("aov").into_iter().flatten().cloned().collect();
        let study = if matches.get_flag("plan") {
            let asked = matches.get_one::<String>("caps").map_or(known::DEFAULT, String::as_str);
            let (name, caps) = file::asked(asked, job.device.as_deref())?;
            study::planned(&job, &name, &caps)?
        } else {
            study::made(&job)?
        };
        let technique = job.technique.name();
        let rivals = job.technique.rivals();
        let document = document(technique, &study, &rivals);
        let beside: String = rivals
            .iter()
            .map(|rival| {
                format!("beside it {}: {} = {} ({})\n", rival.name, rival.formula, Bytes(rival.bytes), rival.paper)
            })
            .collect();
        let unrounded = if study.is_unrounded { UNROUNDED } else { "" };
        let text =
            format!("{technique}: {} on {}\n{unrounded}\n{}{beside}", study.scene, study.device, study.table.text());
        if let Some(folder) = folder {
            let file = |extension: &str| folder.join(format!("memory-{technique}.{extension}"));
            write_whole(&file("txt"), |out| write!(out, "{text}"))?;
            write_whole(&file("json"), |out| writeln!(out, "{document:#}"))?;
        }
        if !matches.get_flag("json") {
            let gap = if documents.is_empty() { "" } else { "\n" };
            print_text(matches, &format!("{gap}{text}"))?;
        }
        budget = budget.and(study.budget);
        documents.push(document);
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
        "rivals": rivals,
    })
}
