//! `quincunx devices`: every device of every driver, what it can do, and what it lacks.

use super::self_test;
use crate::caps::{Ability, Caps, Need};
use crate::cli::output::{print, print_text, quiet_flag};
use crate::error::Result;
use crate::gpu::device::{self, ListedDevice};
use crate::techniques;
use crate::techniques::fitness::{Fitness, fitness};
use crate::units::Bytes;
use clap::{Arg, ArgAction, ArgMatches, Command};
use serde_json::{Value, json};
use std::fmt::Write;

/// The verb with its arguments.
pub fn command() -> Command {
    let command = Command::new("devices")
        .about("List the devices, what each can do and what it lacks; or test one")
        .arg(Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print one JSON document"))
        .arg(quiet_flag());
    self_test::with_args(command)
}

/// Prints the list, or tests a device.
///
/// Errors: no loader or no driver (exit code 3); as `self_test::run`.
pub fn run(matches: &ArgMatches, argv: &[String]) -> Result<()> {
    if matches.get_flag(self_test::FLAG) {
        return self_test::run(matches, argv);
    }
    let listed = device::list()?;
    if matches.get_flag("json") {
        let devices: Vec<_> = listed.iter().map(document).collect();
        return print(&format!("{:#}\n", json!({ "schema": 1, "devices": devices })));
    }
    let mut text = String::new();
    for (index, one) in listed.iter().enumerate() {
        describe(&mut text, index, one).expect("writing to a string");
    }
    print_text(matches, &text)
}

/// What `--json` says of a device; no technique where it cannot be used.
fn document(listed: &ListedDevice) -> Value {
    let needs = |needs: &[Need]| -> Vec<Value> {
        let need = |need: &Need| json!({ "of": need.of, "needs": need.ability.name(), "instead": need.instead });
        needs.iter().map(need).collect()
    };
    let fitting = techniques::ALL.iter().filter(|_| listed.missing.is_empty());
    let techniques: Vec<Value> = fitting
        .map(|technique| {
            let Fitness { stopped_by, left_out, bounds } = fitness(*technique, &listed.caps);
            json!({
                "name": technique.name(),
                "runs": stopped_by.is_empty(),
                "stopped_by": needs(&stopped_by),
                "left_out": needs(&left_out),
                "bounds": bounds.iter().map(|(of, most)| json!({ "of": of, "most": most })).collect::<Vec<_>>(),
            })
        })
        .collect();
    json!({ "caps": listed.caps, "missing": listed.missing, "techniques": techniques })
}

fn describe_fitness(text: &mut String, name: &str, fitness: &Fitness) -> std::fmt::Result {
    let needs = |need: &Need| format!("{} needs {}", need.of, need.ability.name());
    if let Some(need) = fitness.stopped_by.first() {
        return writeln!(text, "   {name} does not run: {}", needs(need));
    }
    match fitness.left_out.is_empty() {
        true => writeln!(text, "   {name} runs with every setting")?,
        false => writeln!(text, "   {name} runs, but:")?,
    }
    for need in &fitness.left_out {
        let instead = if need.instead.is_empty() { String::new() } else { format!("; {}", need.instead) };
        writeln!(text, "      {}{instead}", needs(need))?;
    }
    let bounds: Vec<String> = fitness.bounds.iter().map(|(of, most)| format!("{of} to {most}")).collect();
    writeln!(text, "      {}", bounds.join("; "))
}

fn describe(text: &mut String, index: usize, listed: &ListedDevice) -> std::fmt::Result {
    let caps = &listed.caps;
    let identity = &caps.identity;
    writeln!(
        text,
        "{index}: {} ({}, {}, Vulkan {})",
        identity.name,
        identity.device_type,
        identity.driver_text(),
        identity.api
    )?;
    if listed.missing.is_empty() {
        for technique in techniques::ALL {
            describe_fitness(text, technique.name(), &fitness(*technique, caps))?;
        }
    } else {
        writeln!(text, "   cannot be used: lacks {}", listed.missing.join(", "))?;
    }
    for (number, heap) in caps.heaps.iter().enumerate() {
        let place = if heap.device_local { "device-local" } else { "host" };
        writeln!(text, "   heap {number}: {}, {place}", Bytes(heap.bytes))?;
    }
    let limits = &caps.limits;
    writeln!(
        text,
        "   storage buffers to {}, images to {} px, workgroups to {} invocations, subgroups of {}",
        Bytes(limits.max_storage_buffer_range_bytes),
        limits.max_image_side_px,
        limits.max_workgroup_invocations,
        limits.subgroup_size
    )?;
    describe_abilities(text, caps)
}

fn describe_abilities(text: &mut String, caps: &Caps) -> std::fmt::Result {
    for (has, is_there) in [("has", true), ("has no", false)] {
        let abilities = Ability::ALL.iter().filter(|ability| ability.is_there(caps) == is_there);
        let names: Vec<&str> = abilities.map(|ability| ability.short()).collect();
        if !names.is_empty() {
            writeln!(text, "   {has} {}", names.join(", "))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caps::known;

    #[test]
    fn every_ability_is_listed_among_those_that_are_there_or_those_that_are_not() {
        let listed = |name| {
            let mut text = String::new();
            describe_abilities(&mut text, &known::caps(name).unwrap()).unwrap();
            text
        };
        let text = listed("lavapipe-22.3.6");
        let (has, has_no) = text.split_once("   has no ").unwrap();
        assert!(has.starts_with("   has float depth, ") && has.ends_with(", timestamps\n"), "{text}");
        let rest = "conservative rasterisation of every triangle, barycentrics of fragments, placed samples, ray queries, memory budget\n";
        assert_eq!(has_no, format!("filtered depth, 8 samples a pixel, {rest}"));
        for name in known::names() {
            let text = listed(name);
            assert_eq!(text.matches(", ").count() + text.lines().count(), Ability::ALL.len(), "{name}: {text}");
            assert!(text.lines().all(|line| line.starts_with("   has ")), "{name}: {text}");
        }
    }
}
