//! Stages that `--aov` names: what a technique does not have at all, and what it does not make with these settings, is refused
//! before anything is drawn.

use super::{Inputs, Prepared, Technique};
use crate::error::{Error, Result};

/// Errors: `technique` has no stage of one of these names (exit code 2).
pub fn require_known(technique: &dyn Technique, asked: &[String]) -> Result<()> {
    let (name, all) = (technique.name(), technique.aovs());
    match asked.iter().find(|asked| !all.contains(&asked.as_str())) {
        None => Ok(()),
        Some(unknown) => {
            Err(Error::request(format!("--aov {unknown}: {name} has no such stage")).note(listed("it has", all)))
        }
    }
}

/// Errors: as `require_known`, and the settings that `prepared` was made with leave one of them out (exit code 2).
pub fn require_made(
    technique: &dyn Technique,
    prepared: &dyn Prepared,
    inputs: &Inputs<'_>,
    asked: &[String],
) -> Result<()> {
    require_known(technique, asked)?;
    if asked.is_empty() {
        return Ok(());
    }
    let left_out = prepared.stages_left_out(inputs);
    let found = asked.iter().find_map(|asked| left_out.iter().find(|(stage, _)| stage == asked));
    let Some((stage, why)) = found else { return Ok(()) };
    let is_made = |known: &&str| left_out.iter().all(|(stage, _)| stage != known);
    let made: Vec<&str> = technique.aovs().iter().copied().filter(is_made).collect();
    Err(Error::request(format!("--aov {stage}: {} does not make it: {why}", technique.name()))
        .note(listed("with these settings it has", &made)))
}

fn listed(begin: &str, stages: &[&str]) -> String {
    if stages.is_empty() { format!("{begin} none") } else { format!("{begin} {}", stages.join(", ")) }
}

#[cfg(test)]
mod tests {
    use crate::caps::known;
    use crate::job::Job;
    use crate::settings::Kind;
    use crate::study;
    use crate::techniques::{ALL, settings_of};

    /// Whatever the settings: what they leave out is not planned, and is refused with those that they make; the others are planned.
    #[test]
    fn a_stage_is_refused_where_no_pass_makes_it_and_only_there() {
        let caps = known::caps(known::DEFAULT).unwrap();
        let (mut made, mut refused) = (0, 0);
        for technique in ALL {
            let mut changes = vec![("size", "8x8"), ("pattern", "1x1"), ("stereo", "0.1")];
            for setting in settings_of(*technique) {
                let Kind::Choice(choices) = setting.kind else { continue };
                changes.extend(choices.iter().map(|choice| (setting.key, *choice)));
            }
            for (key, text) in changes {
                let mut job = Job::new("cornell", *technique);
                job.set("size", "16x8").unwrap();
                if job.set(key, text).is_err() || study::planned(&job, known::DEFAULT, &caps).is_err() {
                    // Another technique's setting, or one that needs a second one or a device that has more.
                    continue;
                }
                let (mut own, mut told) = (Vec::new(), Vec::new());
                for stage in technique.aovs() {
                    job.aovs = vec![(*stage).to_owned()];
                    let what = format!("{} --{key} {text} --aov {stage}", technique.name());
                    let Err(error) = study::planned(&job, known::DEFAULT, &caps) else {
                        made += 1;
                        own.push((*stage).to_owned());
                        continue;
                    };
                    refused += 1;
                    let text = error.to_string();
                    assert_eq!(error.exit_code(), 2, "{what}: {text}");
                    assert!(
                        text.starts_with(&format!("--aov {stage}: {} does not make it: ", technique.name())),
                        "{text}"
                    );
                    let (_, others) = text.split_once("with these settings it has ").unwrap();
                    let others = others.lines().next().unwrap().split(", ").filter(|other| *other != "none");
                    told.push((what, others.map(str::to_owned).collect::<Vec<_>>()));
                }
                for (what, others) in told {
                    assert_eq!(others, own, "{what}: what it says that there is");
                }
            }
        }
        assert!(made > 100 && refused > 20, "{made} made, {refused} refused");
    }
}
