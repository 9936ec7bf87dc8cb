//! What compilers of GPUs make of the shaders that frames spend their time in, against figures that are kept:
//! registers, scratch, waves.
//!
//! `assets/compilers/FAMILY.json` keeps them and `docs/compilers.md` shows them; `tools/compilers --bless` writes both.

use super::{FAMILIES, Family, Null, is_refused};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::PathBuf;

/// Ways that differ in their shaders. What a family refuses is left out of its figures.
const MEASURED: [&str; 28] = [
    "interleaved_deferred",
    "interleaved_deferred --split none --cull tiled",
    "interleaved_deferred --split subsample",
    "interleaved_deferred --split two-pass",
    "interleaved_deferred --split tile --fuse on",
    "interleaved_deferred --split stencil",
    "interleaved_deferred --filter gauss-fast",
    "inferred_lighting",
    "inferred_lighting --volumes both --msaa 4",
    "inferred_lighting --volumes tiled",
    "deep_shading --spp 4 --aperture 0.1",
    "deep_shading --spp 4 --aperture 0.1 --lists linked",
    "deep_shading --spp 4 --aperture 0.1 --lists none",
    "deep_shading --spp 4 --aperture 0.1 --visibility stochastic",
    "deep_shading --spp 4 --aperture 0.1 --shade-by fragment --conservative geometry",
    "deep_shading --spp 4 --aperture 0.1 --shading ssaa",
    "deep_shading --spp 4 --aperture 0.1 --shading msaa",
    "deep_shading --spp 4 --aperture 0.1 --shading indirect-gbuffer",
    "deep_shading --spp 4 --aperture 0.1 --shading texture-space",
    "deferred",
    "deferred --direct-shadow ray",
    "forward --msaa 4",
    "forward --msaa 4 --sample-shading on",
    "forward --direct-shadow map",
    "forward --direct-shadow ray",
    "path_traced --spp 1",
    "path_traced --spp 1 --stack shared",
    "path_traced --spp 1 --rays query",
];

/// One shader's figures; where several pipelines have it, the worst of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Figures {
    /// Registers of a lane.
    vgprs: u64,
    /// Registers of all lanes of a wave together; 0 where the driver counts none.
    sgprs: u64,
    /// Workgroup memory; 0 where the driver does not say.
    lds_bytes: u64,
    /// Private memory of a lane beyond its registers.
    scratch_bytes: u64,
    /// That a SIMD (AMD) or a multiprocessor (NVIDIA) holds at once, as far as the shader decides it.
    waves: u64,
    code_bytes: u64,
}

/// Waves of a multiprocessor of Turing by a lane's registers: 65,536 for 32 waves at most, given out by 256 a wave
/// (NVIDIA, CUDA C++ Programming Guide, technical specifications of compute capability 7.5). Workgroup memory is not
/// counted.
fn turing_waves(registers: u64) -> u64 {
    (65_536 / (registers.max(1) * 32).next_multiple_of(256)).min(32)
}

impl Figures {
    /// What a line says that the layer has written.
    fn of(line: &Value) -> Self {
        let number = |name: &str| line[name].as_u64().unwrap_or_else(|| panic!("no {name}: {line}"));
        if line.get("Number of GPRs").is_some() {
            let vgprs = number("Number of GPRs");
            let (scratch_bytes, code_bytes) = (number("SLM Size"), number("Code Size"));
            return Self { vgprs, sgprs: 0, lds_bytes: 0, scratch_bytes, waves: turing_waves(vgprs), code_bytes };
        }
        Self {
            vgprs: number("VGPRs"),
            sgprs: number("SGPRs"),
            lds_bytes: number("LDS size"),
            // The driver counts that of a whole wave.
            scratch_bytes: number("Scratch size") / number("subgroup"),
            waves: number("Subgroups per SIMD"),
            code_bytes: number("Code size"),
        }
    }

    fn worst(self, other: Self) -> Self {
        Self {
            vgprs: self.vgprs.max(other.vgprs),
            sgprs: self.sgprs.max(other.sgprs),
            lds_bytes: self.lds_bytes.max(other.lds_bytes),
            scratch_bytes: self.scratch_bytes.max(other.scratch_bytes),
            waves: self.waves.min(other.waves),
            code_bytes: self.code_bytes.max(other.code_bytes),
        }
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Kept {
    driver: String,
    shaders: BTreeMap<String, Figures>,
}

fn repository() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn file_of(family: &str) -> PathBuf {
    repository().join("assets/compilers").join(format!("{family}.json"))
}

impl Kept {
    fn read(family: &str) -> Self {
        let path = file_of(family);
        let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        serde_json::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    /// A line for each shader, so that changes show.
    fn write(&self, family: &str) {
        let lines: Vec<String> = self
            .shaders
            .iter()
            .map(|(shader, figures)| format!("    {shader:?}: {}", serde_json::to_string(figures).unwrap()))
            .collect();
        let text =
            format!("{{\n  \"driver\": {:?},\n  \"shaders\": {{\n{}\n  }}\n}}\n", self.driver, lines.join(",\n"));
        std::fs::write(file_of(family), text).unwrap();
    }

    fn measure(null: &Null, family: &Family) -> Self {
        let family = family.name;
        let statistics = null.program.path("statistics.jsonl");
        let _ = std::fs::remove_file(&statistics);
        let mut driver = String::new();
        for command in MEASURED {
            let words: Vec<&str> = ["--technique"].into_iter().chain(command.split(' ')).collect();
            let ran = null.render(&words, &[("QUINCUNX_PRETEND_STATISTICS", &statistics)]);
            if ran.code == 0 {
                driver = ran.json()["device"]["driver_info"].as_str().unwrap().to_owned();
            } else {
                // The family lacks something; a wrong request would be the list's mistake.
                assert!(ran.code == 3 && is_refused(&ran), "{family}: {command} ended with {}: {}", ran.code, ran.err);
            }
        }
        let mut shaders = BTreeMap::new();
        for line in std::fs::read_to_string(&statistics).unwrap().lines() {
            let line: Value = serde_json::from_str(line).unwrap();
            let (name, figures) = (line["shader"].as_str().unwrap().to_owned(), Figures::of(&line));
            shaders.entry(name).and_modify(|so_far: &mut Figures| *so_far = so_far.worst(figures)).or_insert(figures);
        }
        Self { driver, shaders }
    }

    /// What is worse than what was kept, in words.
    fn complaints(&self, kept: &Self) -> Vec<String> {
        let mut complaints = Vec::new();
        for (shader, now) in &self.shaders {
            let Some(before) = kept.shaders.get(shader) else {
                complaints.push(format!("{shader}: not kept yet"));
                continue;
            };
            if now.scratch_bytes > before.scratch_bytes {
                let [now, before] = [now.scratch_bytes, before.scratch_bytes];
                complaints.push(format!("{shader}: {now} B of scratch a lane, {before} B before"));
            }
            if now.waves * 2 <= before.waves {
                complaints.push(format!("{shader}: {} waves, {} before", now.waves, before.waves));
            }
        }
        let gone = kept.shaders.keys().filter(|shader| !self.shaders.contains_key(*shader));
        complaints.extend(gone.map(|shader| format!("{shader}: kept, and no longer compiled")));
        complaints
    }
}

/// The rest of docs/compilers.md is written by hand.
const TABLE: &str = "<!-- From here on: tools/compilers --bless -->\n";

fn page() -> PathBuf {
    repository().join("docs/compilers.md")
}

/// All families, side by side.
fn table(families: &[(&str, Kept)]) -> String {
    let mut text = TABLE.to_owned();
    let drivers: BTreeSet<&str> = families.iter().map(|(_, kept)| &kept.driver[..]).collect();
    let _ = writeln!(text, "\n{}.\n", drivers.into_iter().collect::<Vec<_>>().join(", "));
    let names: Vec<&str> = families.iter().map(|(name, _)| *name).collect();
    let _ = writeln!(text, "| shader | {} |", names.join(" | "));
    let _ = writeln!(text, "| --- |{}", " --- |".repeat(names.len()));
    let shaders: BTreeSet<&String> = families.iter().flat_map(|(_, kept)| kept.shaders.keys()).collect();
    for shader in shaders {
        let cells: Vec<String> = families
            .iter()
            .map(|(_, kept)| {
                kept.shaders.get(shader).map_or("-".to_owned(), |of| {
                    let scratch = if of.scratch_bytes > 0 { format!("**{}**", of.scratch_bytes) } else { "0".into() };
                    format!("{}, {}, {}, {}, {scratch}, {}", of.waves, of.vgprs, of.sgprs, of.lds_bytes, of.code_bytes)
                })
            })
            .collect();
        let _ = writeln!(text, "| `{shader}` | {} |", cells.join(" | "));
    }
    text
}

#[test]
fn no_shader_takes_scratch_or_loses_half_its_waves() {
    let open = |family| Null::open(family).map(|null| (family.name, Kept::measure(&null, family)));
    let measured: Option<Vec<(&str, Kept)>> = FAMILIES.iter().map(open).collect();
    let Some(measured) = measured else { return };
    if std::env::var("BLESS").is_ok_and(|blessed| blessed == "compilers") {
        for (family, kept) in &measured {
            kept.write(family);
        }
        let text = std::fs::read_to_string(page()).unwrap();
        let by_hand = text.split_once(TABLE).map_or(&text[..], |(by_hand, _)| by_hand);
        std::fs::write(page(), by_hand.to_owned() + &table(&measured)).unwrap();
        return;
    }
    let complaints: Vec<String> = measured
        .iter()
        .flat_map(|(family, now)| {
            let lines = now.complaints(&Kept::read(family));
            lines.into_iter().map(move |line| format!("{family}, {}: {line}", now.driver))
        })
        .collect();
    let bless = "if that is meant:  tools/compilers --bless";
    assert!(complaints.is_empty(), "{} complaints\n{}\n{bless}", complaints.len(), complaints.join("\n"));
}

#[test]
fn the_page_shows_what_is_kept() {
    let families: Vec<(&str, Kept)> = FAMILIES.iter().map(|family| (family.name, Kept::read(family.name))).collect();
    let text = std::fs::read_to_string(page()).unwrap();
    let shown = text.split_once(TABLE).map(|(_, rest)| format!("{TABLE}{rest}"));
    assert!(shown.as_deref() == Some(&table(&families)), "tools/compilers --bless writes docs/compilers.md");
}

#[test]
fn waves_of_turing_are_those_that_its_registers_hold() {
    assert_eq!([16, 64, 65, 128, 129, 255].map(turing_waves), [32, 32, 28, 16, 15, 8]);
}

#[test]
fn scratch_and_halved_waves_are_complained_about_and_fewer_registers_are_not() {
    let figures = Figures { vgprs: 64, sgprs: 128, lds_bytes: 0, scratch_bytes: 0, waves: 16, code_bytes: 4096 };
    let of = |figures| Kept { driver: "Mesa".to_owned(), shaders: BTreeMap::from([("a.comp".to_owned(), figures)]) };
    let kept = of(figures);
    let complaints = |figures| of(figures).complaints(&kept);
    assert_eq!(complaints(figures), [] as [&str; 0]);
    assert_eq!(complaints(Figures { waves: 9, vgprs: 96, code_bytes: 9000, ..figures }), [] as [&str; 0]);
    assert_eq!(complaints(Figures { waves: 20, vgprs: 40, ..figures }), [] as [&str; 0]);
    assert_eq!(complaints(Figures { waves: 8, ..figures }), ["a.comp: 8 waves, 16 before"]);
    assert_eq!(complaints(Figures { scratch_bytes: 4, ..figures }), ["a.comp: 4 B of scratch a lane, 0 B before"]);
    let other = Kept { shaders: BTreeMap::from([("b.comp".to_owned(), figures)]), ..kept.clone() };
    assert_eq!(other.complaints(&kept), ["b.comp: not kept yet", "a.comp: kept, and no longer compiled"]);
}
