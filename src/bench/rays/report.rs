//! Rows of `bench rays`, and the table of them.

use super::{Measured, Request, Variant, WalkKind};
use crate::bench::stats::{Ratio, median, paired_ratio};
use crate::bench::table::{self, Table};
use crate::caps::Identity;
use crate::error::{Error, Result};
use crate::gpu::Gpu;
use crate::report::nullable::or_nan;
use crate::report::spread::Spread;
use crate::scene::Scene;
use crate::units::Bytes;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Number of the set of keys.
const SCHEMA: u32 = 1;
/// Rays that two correct walks may answer differently, because they graze an edge: a part of all. On lavapipe 22.3.6 none of
/// 262,144 did on the hall and on two maps; other drivers round otherwise.
const MOST_DIFFERING: f64 = 0.001;

/// A row of `bench rays`; its fields are the keys of the JSON document, in their order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RaysRow {
    /// Number of the set of keys.
    pub schema: u32,
    /// `rays`.
    pub bench: String,
    pub device: Identity,
    /// Commit of the program.
    pub commit: String,
    pub scene: RaysScene,
    /// `incoherent` or `coherent`.
    pub rays: String,
    /// `any` or `nearest`.
    pub query: String,
    /// `plain`, `ordered` or `query`.
    pub walk: String,
    /// What tells walks in order apart; empty of the others, and where there is one.
    pub variant: String,
    /// Texts of the settings of the tree and the stack; None, and null in JSON, of a walk that reads none.
    pub settings: Option<BTreeMap<String, String>>,
    /// Nodes of the tree.
    pub nodes: usize,
    /// Bytes of the nodes.
    pub node_bytes: u64,
    /// Where waiting nodes lie; empty without a stack.
    pub stack: String,
    /// Nodes that a ray has room to let wait.
    pub stack_entries: u32,
    pub ray_count: u32,
    /// Seed of the rays.
    pub seed: u64,
    /// Rounds.
    pub repeat: usize,
    /// Milliseconds of the device; None, and null in JSON, where no round was measured.
    pub ms: Option<Spread>,
    /// Millions of rays a second on the device.
    #[serde(deserialize_with = "or_nan")]
    pub mrays_per_s: f64,
    /// Speed in parts of the plain walk's.
    pub speed_to_plain: Ratio,
    /// Threads of the host.
    pub host_threads: usize,
    /// Milliseconds of the host; None as `ms`.
    pub host_ms: Option<Spread>,
    /// Millions of rays a second on the host.
    #[serde(deserialize_with = "or_nan")]
    pub host_mrays_per_s: f64,
    /// Speed in parts of the host's.
    pub speed_to_host: Ratio,
    /// Rays that hit something.
    pub hits: usize,
    /// BLAKE3 of what each ray met, hexadecimal.
    pub hits_hash: String,
    /// Rays whose hit is not the host's.
    pub differing: usize,
}

/// The scene that rays are cast in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RaysScene {
    pub name: String,
    /// BLAKE3 of what is drawn, hexadecimal.
    pub hash: String,
    pub triangles: u64,
}

/// A row for each walk.
pub fn rows(measured: &[Measured], gpu: &Gpu, scene: &Scene, request: &Request) -> Vec<RaysRow> {
    measured.iter().map(|one| row(one, gpu, scene, request)).collect()
}

fn row(one: &Measured, gpu: &Gpu, scene: &Scene, request: &Request) -> RaysRow {
    let [device, host, plain] = [&one.device, &one.host, &one.plain].map(|samples| samples.totals_ms());
    // Thousands a millisecond are millions a second.
    let rate = |samples: &[f64]| f64::from(request.ray_count) / median(samples) / 1e3;
    let variant = match one.kind {
        WalkKind::Ordered(index) => Some(&request.variants[index]),
        WalkKind::Plain | WalkKind::Query => None,
    };
    let texts = |variant: &Variant| {
        variant.values.iter().map(|(key, text)| (key.to_owned(), text.to_owned())).collect::<BTreeMap<_, _>>()
    };
    RaysRow {
        schema: SCHEMA,
        bench: "rays".to_owned(),
        device: gpu.caps.identity.clone(),
        commit: env!("QUINCUNX_COMMIT").to_owned(),
        scene: RaysScene { name: scene.name.clone(), hash: scene.hash.clone(), triangles: scene.triangle_count() },
        rays: one.rays.name().to_owned(),
        query: one.query.name().to_owned(),
        walk: one.walk().to_owned(),
        variant: variant.map_or_else(String::new, |variant| variant.label.clone()),
        settings: variant.map(texts),
        nodes: one.size.node_count,
        node_bytes: one.size.node_bytes,
        stack: one.size.stack.to_owned(),
        stack_entries: one.size.stack_entries,
        ray_count: request.ray_count,
        seed: request.seed,
        repeat: request.repeat,
        ms: Spread::of(&device),
        mrays_per_s: rate(&device),
        speed_to_plain: paired_ratio(&plain, &device),
        host_threads: rayon::current_num_threads(),
        host_ms: Spread::of(&host),
        host_mrays_per_s: rate(&host),
        speed_to_host: paired_ratio(&host, &device),
        hits: one.hit_count,
        hits_hash: one.hits_hash.clone(),
        differing: one.differing,
    }
}

impl RaysRow {
    /// As rows are written: one line, without its end.
    pub fn line(&self) -> String {
        serde_json::to_string(self).expect("its keys are texts")
    }
}

/// All rows, at least one, for a person.
pub fn text(rows: &[RaysRow]) -> String {
    let cells = |row: &RaysRow| {
        vec![
            format!("{} {} {} {}", row.rays, row.query, row.walk, row.variant).trim_end().to_owned(),
            format!("{:.3}", row.mrays_per_s),
            table::ratio(&row.speed_to_plain),
            format!("{:.3}", row.host_mrays_per_s),
            table::ratio(&row.speed_to_host),
            row.hits.to_string(),
            row.differing.to_string(),
            Bytes(row.node_bytes).to_string(),
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
    let first = &rows[0];
    let software = if first.device.is_software() { ", software driver" } else { "" };
    format!(
        "{} ({} triangles) on {} ({}{software}), {} rays, {} rounds; host: {} threads\n{}",
        first.scene.name,
        first.scene.triangles,
        first.device.name,
        first.device.driver_info,
        first.ray_count,
        first.repeat,
        first.host_threads,
        Table::of_lines(std::iter::once(titles.map(str::to_owned).to_vec()).chain(rows.iter().map(cells)).collect())
            .text(),
    )
}

/// Errors: a walk finds other hits than the host's (exit code 1).
pub fn require_agreement(measured: &[Measured], request: &Request) -> Result<()> {
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
