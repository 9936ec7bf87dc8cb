//! The way of a reproduction: recipe, steps, numbers, documents.

use super::found::Found;
use super::item::{Item, Paper};
use super::outcome::{Outcome, outcome};
use super::recipe::{Effort, Recipe};
use super::request::Request;
use super::{close_up, step_run, text};
use crate::error::{Error, Result};
use crate::progress::say;
use crate::report::command_line::command_line;
use crate::whole_file::write_whole;
use std::io::Write;

/// Commit of this program.
const COMMIT: &str = env!("QUINCUNX_COMMIT");

/// Whether another number of frames makes other steps.
fn reads_frames(recipe: Option<fn(Effort) -> Recipe>, effort: Effort) -> bool {
    let steps = |frames| recipe.map(|recipe| recipe(Effort { frames: Some(frames), ..effort }).steps);
    steps(1) != steps(2)
}

/// Runs what is missing of an item, and writes `result.json` and `result.md` beside what its steps leave.
///
/// Errors: the item cannot be made here, a setting fits no step, or a file cannot be written (exit code 2); Ctrl-C (130).
/// Steps that fail are told of in what comes back.
pub fn reproduce(paper: &Paper, item: &Item, request: &Request) -> Result<Outcome> {
    let name = format!("{}/{}", paper.name, item.name);
    let Some(recipe) = item.recipe else {
        return Err(Error::request(format!("{name} cannot be made here: {}", item.verdict.reason())));
    };
    let mut recipe: Recipe = recipe(request.effort);
    request.check(&name, &recipe.steps)?;
    if let Some(frames) = request.effort.frames
        && !reads_frames(item.recipe, request.effort)
    {
        return Err(Error::request(format!("--frames {frames}: {name} is of no film")));
    }
    recipe.steps.retain(|step| request.wants(step));
    std::fs::create_dir_all(&request.folder)
        .map_err(|error| Error::request(format!("-o {}: {error}", request.folder.display())))?;
    let mut found = Found::default();
    for (index, step) in recipe.steps.iter().enumerate() {
        let command = command_line(&step.command(request));
        say(format!("{name}, step {} of {}: quincunx {command}", index + 1, recipe.steps.len()));
        let (left, written) = step_run::run(step, request, COMMIT)?;
        found.latest = found.latest.max(written);
        found.steps.insert(step.name.clone(), left);
    }
    recipe.close_ups.iter().try_for_each(|close_up| close_up::write(close_up, &request.folder))?;
    let outcome = outcome(paper, item, &recipe, &found, request, COMMIT);
    let document = serde_json::to_string_pretty(&outcome).expect("its keys are texts");
    write_whole(&request.folder.join("result.json"), |out| writeln!(out, "{document}"))?;
    write_whole(&request.folder.join("result.md"), |out| write!(out, "{}", text::text(&outcome)))?;
    Ok(outcome)
}
