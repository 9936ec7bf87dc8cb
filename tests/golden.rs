//! Small pictures that must stay as they are, within a bound, on the pinned software driver.
//!
//! `BLESS=NAME cargo test golden` (or `BLESS=all`) rewrites a golden. A miss leaves NAME.actual.png,
//! NAME.expected.png and NAME.difference.png in target/golden/.

use crate::support;
use crate::support::Feature;
use crate::support::watched::{Changes, Watched};
use quincunx::metrics;
use quincunx::report::image_file::{self, write_srgb8};
use quincunx::report::tonemap::{Srgb8, ToneMap};
use std::path::{Path, PathBuf};

/// Greatest root mean square of the differences of all 8-bit codes. Another CPU rounds sums otherwise: some codes move by
/// one, and a pixel on an edge may fall to the other side. A quarter of all codes moved by one is 0.5; twelve pixels
/// turned from black to white are 6. What a person would call another picture is beyond 2.
const CODES_BOUND: f64 = 1.0;
const MOST_BYTES: u64 = 64 << 10;

fn golden_path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/golden").join(format!("{name}.png"))
}

fn rms_of_codes(actual: &Srgb8, expected: &Srgb8) -> f64 {
    let codes = actual.as_bytes().iter().zip(expected.as_bytes());
    let sum: f64 = codes.map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum();
    (sum / actual.as_bytes().len() as f64).sqrt()
}

/// Where a miss leaves its pictures.
fn leave(name: &str, actual: &Srgb8, expected: Option<&Srgb8>) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap().join("golden");
    std::fs::create_dir_all(&folder).unwrap();
    write_srgb8(&folder.join(format!("{name}.actual.png")), actual).unwrap();
    if let Some(expected) = expected {
        write_srgb8(&folder.join(format!("{name}.expected.png")), expected).unwrap();
        if let Ok(comparison) =
            metrics::compare(&actual.to_picture(), &expected.to_picture(), metrics::DEFAULT_THRESHOLD)
        {
            write_srgb8(&folder.join(format!("{name}.difference.png")), &comparison.error_picture()).unwrap();
        }
    }
    folder
}

/// Renders at 200x112 and holds the picture against its golden.
fn require_golden(name: &str, spec: &str, technique: &str, changes: Changes<'_>) {
    let watched = Watched::open(spec);
    if !support::has(&watched.session.gpu.caps, Feature::Pinned) {
        return;
    }
    let picture = watched.picture(technique, &support::watched::both(&[("size", "200x112")], changes));
    let actual = Srgb8::from_picture(&picture, 0.0, ToneMap::Clip);
    let path = golden_path(name);
    if std::env::var("BLESS").is_ok_and(|blessed| blessed == name || blessed == "all") {
        write_srgb8(&path, &actual).unwrap();
        let bytes = std::fs::metadata(&path).unwrap().len();
        assert!(bytes <= MOST_BYTES, "{name}: {bytes} bytes are more than a golden may have");
        println!("blessed {}", path.display());
        return;
    }
    let bless = format!("if it is right: BLESS={name} cargo test golden");
    if !path.is_file() {
        let folder = leave(name, &actual, None);
        panic!("{name}: there is no {}; the picture is in {}\n{bless}", path.display(), folder.display());
    }
    let expected = Srgb8::from_picture(&image_file::read(&path).unwrap(), 0.0, ToneMap::Clip);
    let difference = if actual.extent == expected.extent { rms_of_codes(&actual, &expected) } else { f64::INFINITY };
    if difference > CODES_BOUND {
        let folder = leave(name, &actual, Some(&expected));
        panic!(
            "{name}: {difference:.3} codes from its golden, {CODES_BOUND} are allowed; actual, expected and difference are \
             in {}\n{bless}",
            folder.display()
        );
    }
}

#[test]
fn cornell_deferred() {
    require_golden("cornell_deferred", "cornell", "deferred", &[]);
}

#[test]
fn cornell_interleaved() {
    require_golden("cornell_interleaved", "cornell", "interleaved_deferred", &[]);
}

#[test]
fn cornell_emissive() {
    let changes = [("emissive", "on"), ("direct", "none"), ("split", "none"), ("vpl-bounces", "3")];
    require_golden("cornell_emissive", "cornell", "interleaved_deferred", &changes);
}

#[test]
fn hall_interleaved() {
    require_golden("hall_interleaved", "hall:triangles=8000", "interleaved_deferred", &[]);
}

#[test]
fn lamps_deferred() {
    require_golden("lamps_deferred", "lamps", "deferred", &[("direct-shadow", "ray")]);
}

/// Shadow maps, with holes in those of the wire.
#[test]
fn fence_mapped() {
    let changes = [("direct-shadow", "map"), ("shadow-map-size", "128")];
    require_golden("fence_mapped", "fence:alpha=mask,lights=30", "forward", &changes);
}

#[test]
fn lamps_inferred() {
    require_golden("lamps_inferred", "lamps", "inferred_lighting", &[]);
}

#[test]
fn hall_inferred() {
    require_golden("hall_inferred", "hall:triangles=8000", "inferred_lighting", &[("msaa", "4")]);
}

/// The shadow of a rotor on three sheets of glass: the paper's figure 6.
#[test]
fn fence_shadows() {
    let changes = [("camera", "rotor"), ("volumes", "scissor"), ("shadow-volumes", "1")];
    require_golden("fence_shadows", "fence", "inferred_lighting", &changes);
}

#[test]
fn lamps_forward() {
    require_golden("lamps_forward", "lamps", "forward", &[("msaa", "4")]);
}

#[test]
fn chess_deep() {
    let changes = [
        ("aperture", "0.02"),
        ("spp", "4"),
        ("direct-shadow", "map"),
        ("shadow-map-size", "256"),
        ("conservative", "vertex"),
    ];
    require_golden("chess_deep", "chess:triangles=12000", "deep_shading", &changes);
}

/// By its panel alone, as photographs of the box are.
#[test]
fn cornell_path_traced() {
    require_golden("cornell_path_traced", "cornell", "path_traced", &[("punctual", "off"), ("spp", "64")]);
}

/// The files themselves: none that no test reads, none too large.
#[test]
fn every_golden_is_small_and_has_a_test() {
    let source = include_str!("golden.rs");
    for entry in std::fs::read_dir(golden_path("any").parent().unwrap()).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        let bytes = entry.metadata().unwrap().len();
        assert!(bytes <= MOST_BYTES, "{name}: {bytes} bytes");
        let stem = name.strip_suffix(".png").unwrap_or_else(|| panic!("{name} is no golden"));
        assert!(source.contains(&format!("require_golden(\"{stem}\"")), "no test reads {name}");
    }
}
