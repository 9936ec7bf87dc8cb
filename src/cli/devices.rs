//! `quincunx devices`: every device of every driver, what it can do, and what it lacks.

use crate::error::Result;
use crate::gpu::device::{self, Listed};
use crate::units::Bytes;
use clap::{Arg, ArgAction, ArgMatches, Command};
use serde_json::json;
use std::fmt::Write;

/// The verb with its arguments.
pub fn command() -> Command {
    Command::new("devices")
        .about("List the devices, what each can do and what it lacks")
        .arg(Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print one JSON document"))
}

/// Prints the list.
///
/// Errors: no loader or no driver (exit code 3).
pub fn run(matches: &ArgMatches) -> Result<()> {
    let listed = device::list()?;
    if matches.get_flag("json") {
        let devices: Vec<_> = listed.iter().map(|one| json!({ "caps": one.caps, "missing": one.missing })).collect();
        return super::print(&format!("{:#}\n", json!({ "schema": 1, "devices": devices })));
    }
    let mut text = String::new();
    for (index, one) in listed.iter().enumerate() {
        describe(&mut text, index, one).expect("writing to a string");
    }
    super::print(&text)
}

fn describe(text: &mut String, index: usize, listed: &Listed) -> std::fmt::Result {
    let caps = &listed.caps;
    let identity = &caps.identity;
    writeln!(
        text,
        "{index}: {} ({}, {}, Vulkan {})",
        identity.name, identity.device_type, identity.driver_info, identity.api
    )?;
    if listed.missing.is_empty() {
        writeln!(text, "   fits: every technique and setting of this version runs here")?;
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
    let features = &caps.features;
    let all = [
        (features.geometry_shader, "geometry shaders"),
        (features.layer_from_vertex_shader, "layers from vertex shaders"),
        (features.shader_float16, "16-bit floats"),
        (features.conservative_rasterization, "conservative rasterisation"),
        (features.ray_query, "ray queries"),
        (features.memory_budget, "memory budget"),
        (limits.timestamp_period_ns > 0.0, "timestamps"),
    ];
    let names =
        |present: bool| -> Vec<&str> { all.iter().filter(|(has, _)| *has == present).map(|(_, name)| *name).collect() };
    writeln!(text, "   has {}", names(true).join(", "))?;
    writeln!(text, "   has no {}", names(false).join(", "))
}
