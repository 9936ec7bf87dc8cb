//! Rows of `bench rays`, and the table of them.

use super::{Measured, Request, WalkKind};
use crate::bench::stats::{median, paired_ratio};
use crate::bench::table::{self, Table};
use crate::error::{Error, Result};
use crate::gpu::Gpu;
use crate::report::spread::Spread;
use crate::scene::Scene;
use crate::units::Bytes;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Number of the set of keys.
const SCHEMA: u32 = 1;
/// Rays that two correct walks may answer differently, because they graze an edge: a part of all. On lavapipe 22.3.6 none of
/// 262,144 did on the hall and on two maps; other drivers round otherwise.
const MOST_DIFFERING: f64 = 0.001;

/// A row for each walk.
pub fn rows(measured: &[Measured], gpu: &Gpu, scene: &Scene, request: &Request) -> Vec<Value> {
    measured.iter().map(|one| row(one, gpu, scene, request)).collect()
}

fn row(one: &Measured, gpu: &Gpu, scene: &Scene, request: &Request) -> Value {
    let [device, host, plain] = [&one.device, &one.host, &one.plain].map(|samples| samples.totals_ms());
    // Thousands a millisecond are millions a second.
    let rate = |samples: &[f64]| f64::from(request.ray_count) / median(samples) / 1e3;
    let variant = match one.kind {
        WalkKind::Ordered(index) => Some(&request.variants[index]),
        WalkKind::Plain | WalkKind::Query => None,
    };
    json!({
        "schema": SCHEMA,
        "bench": "rays",
        "device": gpu.caps.identity,
        "commit": env!("QUINCUNX_COMMIT"),
        "scene": { "name": scene.name, "hash": scene.hash, "triangles": scene.triangle_count() },
        "rays": one.rays.name(),
        "query": one.query.name(),
        "walk": one.walk(),
        "variant": variant.map_or("", |variant| &variant.label),
        "settings": variant.map(|variant| variant.values.iter().collect::<BTreeMap<_, _>>()),
        "nodes": one.size.node_count,
        "node_bytes": one.size.node_bytes,
        "stack": one.size.stack,
        "stack_entries": one.size.stack_entries,
        "ray_count": request.ray_count,
        "seed": request.seed,
        "repeat": request.repeat,
        "ms": Spread::of(&device),
        "mrays_per_s": rate(&device),
        "speed_to_plain": paired_ratio(&plain, &device).json(),
        "host_threads": rayon::current_num_threads(),
        "host_ms": Spread::of(&host),
        "host_mrays_per_s": rate(&host),
        "speed_to_host": paired_ratio(&host, &device).json(),
        "hits": one.hit_count,
        "hits_hash": one.hits_hash,
        "differing": one.differing,
    })
}

/// All rows, for a person.
pub fn text(rows: &[Value]) -> String {
    let cells = |row: &Value| {
        let word = |key: &str| row[key].as_str().unwrap_or_default().to_owned();
        let number = |key: &str| row[key].as_f64().map_or_else(String::new, |value| format!("{value:.3}"));
        let ratio = |key: &str| table::ratio(&row[key]).unwrap_or_default();
        vec![
            format!("{} {} {} {}", word("rays"), word("query"), word("walk"), word("variant")).trim_end().to_owned(),
            number("mrays_per_s"),
            ratio("speed_to_plain"),
            number("host_mrays_per_s"),
            ratio("speed_to_host"),
            row["hits"].to_string(),
            row["differing"].to_string(),
            Bytes(row["node_bytes"].as_u64().unwrap_or_default()).to_string(),
        ]
    };
    let titles = [
        "rays, query, walk",
        "Mrays/s",
        "speed to plain (95 %)",
        "host Mrays/s",
        "speed to host (95 %)",
        "hits",
        "differing",
        "nodes",
    ];
    let first = rows.first().unwrap_or(&Value::Null);
    let software = if first["device"]["type"] == "cpu" { ", software driver" } else { "" };
    format!(
        "{} ({} triangles) on {} ({}{software}), {} rays, {} rounds; host: {} threads\n{}",
        first["scene"]["name"].as_str().unwrap_or_default(),
        first["scene"]["triangles"],
        first["device"]["name"].as_str().unwrap_or_default(),
        first["device"]["driver_info"].as_str().unwrap_or_default(),
        first["ray_count"],
        first["repeat"],
        first["host_threads"],
        Table::of_lines(std::iter::once(titles.map(str::to_owned).to_vec()).chain(rows.iter().map(cells)).collect())
            .text(),
    )
}

/// Errors: a walk finds other hits than the host's (exit code 1).
pub fn judge(measured: &[Measured], request: &Request) -> Result<()> {
    let most = MOST_DIFFERING * f64::from(request.ray_count);
    match measured.iter().find(|one| one.differing as f64 > most.max(4.0)) {
        None => Ok(()),
        Some(one) => Err(Error::gate(format!(
            "bench rays: the {} walk for the {} hit of {} rays differs from the host's for {} of {} rays: edges explain {most:.0}",
            one.walk(),
            one.query.name(),
            one.rays.name(),
            one.differing,
            request.ray_count
        ))),
    }
}
