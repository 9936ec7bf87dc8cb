//! `quincunx bench rays`: times of the walks of the tree on a device, beside the host.

use super::{job_args, progress};
use crate::bench::rays::{self, Request, Variant, report};
use crate::bench::sweep::{self, Point};
use crate::cli::output::{print, print_text, quiet_flag, repeat_flag};
use crate::error::{Error, Result};
use crate::gpu::{DeviceRequest, Gpu};
use crate::job::fail_on_validation;
use crate::progress::Stage;
use crate::scene;
use crate::settings::{TREE, Values};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};

pub const NAME: &str = "rays";

/// The sub-verb with its arguments.
pub fn command() -> Command {
    let number = |name: &'static str, default: &'static str, most: u64| {
        let least = if name == "seed" { 0 } else { 1 };
        let parser = value_parser!(u64).range(least..=most);
        Arg::new(name).long(name).value_name("N").value_parser(parser).default_value(default)
    };
    let flag = |name: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue);
    let command = Command::new(NAME)
        .about("Traversal of the tree of triangles, in millions of rays a second, beside the same tree on the host's threads")
        .arg(
            Arg::new("scene")
                .value_name("SCENE")
                .default_value("hall:triangles=80000")
                .help("A built-in scene or a .gltf or .glb file"),
        )
        .arg(number("rays", "262144", 1 << 24).help("Number of rays in a set"))
        .arg(repeat_flag("Number of rounds, each of which measures every walk once"))
        .arg(number("seed", "1", u64::from(u32::MAX)).help("Seed of the rays and of a built-in scene"))
        .arg(Arg::new("device").long("device").value_name("SUBSTRING|INDEX").help("Device, by a part of its name or its index in `quincunx devices`"))
        .arg(flag("validate").help("Run under the validation layer; a message fails the command"))
        .arg(quiet_flag())
        .arg(flag("json").help("Print one line of JSON for each walk on standard output"))
        .arg(
            Arg::new("sweep")
                .long("sweep")
                .value_name("KEY=V,V,...")
                .action(ArgAction::Append)
                .help("Values of one of the settings below, one axis of the grid; may be repeated"),
        );
    TREE.iter().fold(command, |command, setting| {
        command.arg(job_args::flag(setting).help_heading("Settings of the traversal"))
    })
}

/// Every combination of the swept settings, the others as the flags have them.
///
/// Errors: a key that is none of them, an impossible value (exit code 2).
fn variants(matches: &ArgMatches) -> Result<Vec<Variant>> {
    let mut values = Values::defaults(TREE);
    for setting in TREE {
        if let Some(text) = matches.get_one::<String>(setting.key) {
            values.set(setting, text)?;
        }
    }
    let sweeps: Vec<String> = matches.get_many::<String>("sweep").into_iter().flatten().cloned().collect();
    let variant = |point: &Point| {
        let mut values = values.clone();
        for (key, text) in point {
            let setting = TREE.iter().find(|setting| setting.key == key).ok_or_else(|| {
                let keys: Vec<&str> = TREE.iter().map(|setting| setting.key).collect();
                Error::request(format!("--sweep {key}: walks of the tree have no such setting"))
                    .note(format!("there are {}", keys.join(", ")))
            })?;
            values.set(setting, text)?;
        }
        let label = if point.is_empty() { String::new() } else { sweep::label(point) };
        Ok(Variant { label, values })
    };
    sweep::grid(&sweep::axes(&sweeps)?).iter().map(variant).collect()
}

/// Measures and prints; hits that differ from the host's by more than edges explain fail it.
pub fn run(matches: &ArgMatches) -> Result<()> {
    let number = |name: &str| *matches.get_one::<u64>(name).expect("it has a default");
    let request = Request {
        ray_count: number("rays") as u32,
        seed: number("seed"),
        repeat: *matches.get_one::<u32>("repeat").expect("it has a default") as usize,
        variants: variants(matches)?,
    };
    progress::install(matches.get_flag("quiet"));
    let spec = matches.get_one::<String>("scene").expect("it has a default");
    let scene = scene::load(spec, request.seed)?;
    let device = DeviceRequest {
        selector: matches.get_one::<String>("device").cloned(),
        validate: matches.get_flag("validate"),
        ..DeviceRequest::default()
    };
    let gpu = Gpu::open(&device)?;
    let stage = Stage::counted("measuring", "walks");
    let measured = rays::run(&gpu, &scene, &request, &mut |done, all| stage.reach(done as u64, all as u64))?;
    drop(stage);
    let rows = report::rows(&measured, &gpu, &scene, &request);
    if matches.get_flag("json") {
        print(&rows.iter().map(|row| format!("{}\n", row.line())).collect::<String>())?;
    } else {
        print_text(matches, &report::text(&rows))?;
    }
    report::require_agreement(&measured, &request)?;
    let log = gpu.validation_log();
    drop(gpu);
    fail_on_validation(log.as_deref())
}
