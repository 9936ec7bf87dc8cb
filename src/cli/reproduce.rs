//! `quincunx reproduce PAPER/ITEM`: a published table or figure made again, the paper's numbers beside ours.

use super::asked::{Asked, TechniqueSelection};
use super::job_args::{Row, flag, rows};
use super::output::{bare_repeat_flag, folder_flag, print, print_text, quiet_flag};
use super::progress;
use crate::error::{Error, Result};
use crate::papers::item::{Item, Paper};
use crate::papers::outcome::Outcome;
use crate::papers::recipe::Effort;
use crate::papers::reproduce::reproduce;
use crate::papers::request::Request;
use crate::papers::{self, listing, page, text};
use crate::progress::say;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use std::path::{Path, PathBuf};

const LIST: &str = "list";
const ALL: &str = "all";

/// The verb with its arguments.
pub fn command(asked: &Asked) -> Command {
    let flag_of =
        |name: &'static str, help: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue).help(help);
    let command = Command::new("reproduce")
        .about("Make a published table or figure again: the paper's numbers, ours, and what may be compared")
        .after_help(
            "Results go to DIR/PAPER/ITEM: result.md, result.json, and what the commands leave. What is there, of the same \
             commit and commands, is not made again. Any setting of `render` may be given; each command that reads it takes it.",
        )
        .arg(
            Arg::new("item")
                .value_name("PAPER/ITEM")
                .num_args(1..)
                .help("Such as segovia-2006/table-4, or a paper, for all of it; several of them"),
        )
        .arg(flag_of(LIST, "List every item of every paper, or of the named one, with its verdict"))
        .arg(flag_of(ALL, "Make every item of every paper that can be made").conflicts_with("item"))
        .arg(
            Arg::new("scene")
                .long("scene")
                .value_name("SCENE")
                .action(ArgAction::Append)
                .help("Scene in place of the item's own, a built-in one or a file; may be repeated, for a result each"),
        )
        .arg(flag_of("quick", "A quarter of the pictures' sides, and few rounds: to see that all runs, and its shape"))
        .arg(bare_repeat_flag("Rounds of measurements, in place of the item's own; intervals need three"))
        .arg(folder_flag("Folder for results").default_value("out"))
        .arg(
            Arg::new("frames")
                .long("frames")
                .value_name("N")
                .value_parser(value_parser!(u32).range(1..=100_000))
                .help("Frames of an item that is of a film, in place of its own number (clarberg-2014/figure-6)"),
        )
        .arg(
            Arg::new("only")
                .long("only")
                .value_name("STEP,...")
                .value_delimiter(',')
                .action(ArgAction::Append)
                .help("Run only steps whose names begin so"),
        )
        .arg(
            Arg::new("min-ratio")
                .long("min-ratio")
                .value_name("RATIO")
                .value_parser(finite)
                .help("Fail with exit code 1 where ours, in parts of the published, is less"),
        )
        .arg(flag_of("force", "Make anew what is there"))
        .arg(Arg::new("device").long("device").value_name("SUBSTRING|INDEX").help("Device, as of render"))
        .arg(quiet_flag())
        .arg(flag_of("json", "Print the results, or the list, as one JSON document"));
    if !asked.has_settings_of(&command) {
        return command;
    }
    rows(&TechniqueSelection::All)
        .into_iter()
        .fold(command, |command, Row { setting, .. }| command.arg(flag(setting).hide(true)))
}

/// A number that others can be less than.
fn finite(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
    number.ok_or_else(|| "it must be a number".to_owned())
}

/// Lists, or makes and prints.
pub fn run(matches: &ArgMatches) -> Result<()> {
    let named: Vec<_> = matches.get_many::<String>("item").into_iter().flatten().collect();
    let items = match &named[..] {
        [_, ..] => named.into_iter().map(|name| papers::find(name)).collect::<Result<Vec<_>>>()?.concat(),
        [] if matches.get_flag(ALL) || matches.get_flag(LIST) => papers::all(),
        [] => {
            return Err(Error::request("reproduce: it takes PAPER/ITEM, --list or --all")
                .note("quincunx reproduce --list names them"));
        }
    };
    if matches.get_flag(LIST) {
        return list(&items, matches);
    }
    let is_one = items.len() == 1;
    let effort = Effort { is_quick: matches.get_flag("quick"), frames: matches.get_one::<u32>("frames").copied() };
    let only: Vec<&String> = matches.get_many::<String>("only").into_iter().flatten().collect();
    let has_step = |item: &Item, starts: &[&String]| {
        let steps = item.recipe.map_or_else(Vec::new, |recipe| recipe(effort).steps);
        steps.iter().any(|step| starts.iter().any(|start| step.name.starts_with(start.as_str())))
    };
    if let Some(start) = only.iter().find(|start| !items.iter().any(|(_, item)| has_step(item, &[**start]))) {
        let all = items.iter().filter_map(|(_, item)| Some(item.recipe?(effort).steps)).flatten();
        let names = all.map(|step| step.name).collect::<Vec<_>>().join(", ");
        return Err(Error::request(format!("--only {start}: no step has a name that begins so"))
            .note(format!("there are the steps {names}")));
    }
    // Those that cannot be made are refused where they are asked for by name.
    let is_wanted = |item: &Item| is_one || item.recipe.is_some() && (only.is_empty() || has_step(item, &only));
    let chosen: Vec<_> = items.into_iter().filter(|(_, item)| is_wanted(item)).collect();
    progress::install(matches.get_flag("quiet"));
    let (mut made, mut first_error) = (Vec::new(), None);
    for (paper, item) in chosen {
        for request in requests(paper, item, effort, matches)? {
            match reproduce(paper, item, &request) {
                Ok(outcome) => {
                    show(&outcome, &request.folder, matches)?;
                    first_error = first_error.or_else(|| outcome.error());
                    if let Some(least) = matches.get_one::<f64>("min-ratio") {
                        first_error = first_error.or_else(|| outcome.require_ratios(*least).err());
                    }
                    made.push((outcome, request.folder));
                }
                // A setting that this item does not read, where several are asked for.
                Err(error) if !is_one && error.exit_code() == 2 => {
                    say(format!("{}/{}: {error}", paper.name, item.name));
                    first_error = first_error.or(Some(error));
                }
                Err(error) => return Err(error),
            }
        }
    }
    if matches.get_flag("json") {
        let outcomes: Vec<&Outcome> = made.iter().map(|(outcome, _)| outcome).collect();
        let document = serde_json::to_string_pretty(&outcomes).expect("its keys are texts");
        print(&format!("{document}\n"))?;
    }
    if !made.is_empty() {
        let path = matches.get_one::<PathBuf>("output").expect("it has a default").join("index.html");
        page::write(&path, &made)?;
        say(format!("wrote {}", path.display()));
    }
    first_error.map_or(Ok(()), Err)
}

fn list(items: &[(&Paper, &Item)], matches: &ArgMatches) -> Result<()> {
    if matches.get_flag("json") {
        print(&format!("{:#}\n", listing::json(items)))
    } else {
        print_text(matches, &listing::text(items))
    }
}

/// One a scene that is asked for, or one with the item's own scenes.
fn requests(paper: &Paper, item: &Item, effort: Effort, matches: &ArgMatches) -> Result<Vec<Request>> {
    let program = std::env::current_exe()
        .map_err(|error| Error::request(format!("this program cannot find itself to run its commands: {error}")))?;
    let folder = matches.get_one::<PathBuf>("output").expect("it has a default").join(paper.name).join(item.name);
    let given = |key: &'static str| Some((key.to_owned(), matches.get_one::<String>(key)?.clone()));
    let settings = rows(&TechniqueSelection::All).into_iter().filter_map(|row| given(row.setting.key)).collect();
    let request = Request {
        program,
        folder,
        effort,
        scene: None,
        rounds: matches.get_one::<u32>("repeat").copied(),
        settings,
        device: matches.get_one::<String>("device").cloned(),
        only: matches.get_many::<String>("only").into_iter().flatten().cloned().collect(),
        is_fresh: matches.get_flag("force"),
        is_quiet: matches.get_flag("quiet"),
    };
    let of_scene = |scene: &String| {
        let folder = request.folder.join(slug(scene));
        Request { scene: Some(scene.clone()), folder, ..request.clone() }
    };
    match matches.get_many::<String>("scene") {
        None => Ok(vec![request]),
        Some(scenes) => Ok(scenes.map(of_scene).collect()),
    }
}

/// A scene's name as that of a folder: a file's without its folders.
fn slug(scene: &str) -> String {
    let name = if scene.contains('/') { Path::new(scene).file_stem().and_then(|stem| stem.to_str()) } else { None };
    let kept = |letter: char| if letter.is_alphanumeric() || letter == '.' { letter } else { '-' };
    name.unwrap_or(scene).chars().map(kept).collect()
}

fn show(outcome: &Outcome, folder: &Path, matches: &ArgMatches) -> Result<()> {
    if matches.get_flag("json") {
        return Ok(());
    }
    print_text(matches, &format!("{}\nwrote {}\n\n", text::text(outcome), folder.join("result.md").display()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::sweep;
    use crate::cli::bench::require_known;
    use crate::cli::job_args;
    use crate::scene::animation::AnimationChoice;
    use std::collections::HashSet;

    /// Each step is a command that this program understands: flags, settings, techniques, scenes, stages.
    #[test]
    fn every_step_is_a_command_that_can_be() {
        let folder = tempfile::tempdir().unwrap();
        let request = Request {
            program: PathBuf::new(),
            folder: folder.path().to_owned(),
            effort: Effort::FULL,
            scene: None,
            rounds: None,
            settings: Vec::new(),
            device: None,
            only: Vec::new(),
            is_fresh: false,
            is_quiet: true,
        };
        let (mut wrong, mut scenes, mut seen) = (Vec::new(), HashSet::new(), HashSet::new());
        for (paper, item) in papers::all() {
            let Some(recipe) = item.recipe else { continue };
            for effort in [Effort::FULL, Effort::QUICK] {
                for step in recipe(effort).steps {
                    // Seeds and moments make no other commands.
                    let kind: String = step.words.join(" ").chars().filter(|letter| !letter.is_ascii_digit()).collect();
                    if !seen.insert((std::mem::discriminant(&step.verb), step.scene.clone(), kind)) {
                        continue;
                    }
                    let words = step.command(&Request { effort, ..request.clone() });
                    let argv: Vec<String> = ["quincunx".to_owned()].into_iter().chain(words).collect();
                    let checked = match crate::cli::command(&Asked::by(&argv)).try_get_matches_from(&argv) {
                        Ok(matches) => check(&matches, &argv, &mut scenes),
                        Err(error) => Err(Error::request(error.to_string())),
                    };
                    if let Err(error) = checked {
                        wrong.push(format!("{}/{}: {error}\n{}", paper.name, item.name, argv.join(" ")));
                    }
                }
            }
        }
        for scene in scenes {
            if let Err(error) = crate::scene::open(&scene, 1, &AnimationChoice::All) {
                wrong.push(error.to_string());
            }
        }
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }

    fn check(matches: &ArgMatches, argv: &[String], scenes: &mut HashSet<String>) -> Result<()> {
        match matches.subcommand().unwrap() {
            ("render", matches) => {
                let mut job = job_args::job(matches, argv)?;
                job.aovs = matches.get_many::<String>("aov").into_iter().flatten().cloned().collect();
                scenes.insert(job.scene.clone());
                job.check()
            }
            ("bench", matches) => {
                let (what, matches) = matches.subcommand().unwrap();
                let job = job_args::job(matches, argv)?;
                scenes.insert(job.scene.clone());
                job.check()?;
                let sweeps: Vec<String> = matches.get_many::<String>("sweep").into_iter().flatten().cloned().collect();
                let axes = sweep::axes(&sweeps)?;
                axes.iter().try_for_each(|axis| require_known("sweep", &axis.key))?;
                let grid = sweep::with_points(sweep::grid(&axes), &[])?;
                sweep::parts(&grid, matches.get_one::<String>("baseline").map(String::as_str))?;
                let has_stage = job.technique.bench_stages().iter().any(|stage| stage.name == what);
                if what != "frame" && !has_stage {
                    return Err(Error::request(format!("there is no stage {what}")));
                }
                Ok(())
            }
            ("memory", matches) => job_args::jobs(matches, argv).map(|_| ()),
            ("compare" | "sampling", _) => Ok(()),
            (verb, _) => Err(Error::request(format!("no step runs {verb}"))),
        }
    }

    #[test]
    fn a_scene_is_a_folders_name() {
        for (scene, name) in
            [("hall:triangles=8000", "hall-triangles-8000"), ("a/b/kaos.glb", "kaos"), ("cornell", "cornell")]
        {
            assert_eq!(slug(scene), name);
        }
    }
}
