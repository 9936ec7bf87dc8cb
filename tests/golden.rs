//! Small pictures that must stay as they are, within a bound, on the pinned software driver.
//!
//! `BLESS=NAME cargo test golden` (or `BLESS=all`) rewrites a golden. A miss leaves NAME.actual.png,
//! NAME.expected.png and NAME.difference.png in target/golden/.

use crate::support;
use crate::support::Feature;
use crate::support::watched::{Changes, Watched};
use quincunx::metrics;
use quincunx::picture::image_file::write_srgb8;
use quincunx::picture::tonemap::{Srgb8, ToneMap, linear_from_srgb};
use quincunx::picture::{Picture, image_file};
use quincunx::units::Extent;
use std::fmt;
use std::path::{Path, PathBuf};

/// Most pixels of a hundred that may differ at all, and most of a thousand by more than one code. Drivers compile shaders for
/// what the CPU has; with AVX2 and without (GALLIUM_OVERRIDE_CPU_CAPS=avx) every golden is the same to the bit, so this is
/// room for CPUs that nobody has tried: sums that round otherwise move a code by one, and a pixel on an edge or of a shadow
/// may fall to the other side. What the bounds are to catch is far beyond them: with a weight of the filter as large as its
/// neighbour's, a third of cornell_interleaved differs and a tenth by more than one code; with ten times the threshold of
/// positions, 7 % of hall_interleaved and 3 %; with 1.3 times, 3 % and 1 %.
const MOST_DIFFERING_PERCENT: f64 = 1.0;
const MOST_FAR_PER_MILLE: f64 = 1.0;
const MOST_BYTES: u64 = 64 << 10;

fn golden_path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/golden").join(format!("{name}.png"))
}

/// How far two pictures of one size are apart, in 8-bit codes.
struct Difference {
    pixel_count: usize,
    /// Pixels of which some code differs, and by more than one.
    differing_count: usize,
    far_count: usize,
    greatest: u8,
    mean: f64,
}

impl Difference {
    fn of(actual: &Srgb8, expected: &Srgb8) -> Self {
        let steps: Vec<u8> = actual.as_bytes().iter().zip(expected.as_bytes()).map(|(a, b)| a.abs_diff(*b)).collect();
        let beyond = |codes: u8| steps.chunks_exact(3).filter(|pixel| pixel.iter().any(|step| *step > codes)).count();
        Self {
            pixel_count: steps.len() / 3,
            differing_count: beyond(0),
            far_count: beyond(1),
            greatest: steps.iter().copied().max().unwrap_or(0),
            mean: steps.iter().map(|step| f64::from(*step)).sum::<f64>() / steps.len() as f64,
        }
    }

    fn is_within_bounds(&self) -> bool {
        let part = |count: usize| count as f64 / self.pixel_count as f64;
        100.0 * part(self.differing_count) <= MOST_DIFFERING_PERCENT
            && 1000.0 * part(self.far_count) <= MOST_FAR_PER_MILLE
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { pixel_count, differing_count, far_count, greatest, mean } = self;
        write!(
            out,
            "{differing_count} of {pixel_count} pixels differ, {far_count} by more than one code; {greatest} codes at most, \
             {mean:.4} on average"
        )
    }
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
    assert_eq!(actual.extent, expected.extent, "{name}");
    let difference = Difference::of(&actual, &expected);
    if !difference.is_within_bounds() {
        let folder = leave(name, &actual, Some(&expected));
        panic!(
            "{name}: {difference}; {MOST_DIFFERING_PERCENT} % may differ, and {MOST_FAR_PER_MILLE} in a thousand by more than one; \
             actual, expected and difference are in {}\n{bless}",
            folder.display()
        );
    }
}

/// One pixel in a hundred may differ by a code, and one in a thousand by any number of them.
#[test]
fn differences_are_counted_by_pixels() {
    let extent = Extent::new(100, 10);
    let of = |changed: &[(usize, u8)]| {
        let mut picture = Picture::filled(extent, [0.1; 3]);
        let plain = Srgb8::from_picture(&picture, 0.0, ToneMap::Clip);
        let green = plain.as_bytes()[1];
        for (pixel, codes) in changed {
            picture.pixels[*pixel][1] = linear_from_srgb(f64::from(green + codes) / 255.0) as f32;
        }
        Difference::of(&Srgb8::from_picture(&picture, 0.0, ToneMap::Clip), &plain)
    };
    let ten: Vec<(usize, u8)> = (0..10).map(|pixel| (37 * pixel, 1)).collect();
    let eleven = [&ten[..], &[(999, 1)]].concat();
    assert!(of(&ten).is_within_bounds() && !of(&eleven).is_within_bounds());
    assert!(of(&[(3, 90)]).is_within_bounds() && !of(&[(3, 2), (4, 2)]).is_within_bounds());
    let Difference { pixel_count, differing_count, far_count, greatest, mean } = of(&[(3, 90), (500, 1)]);
    assert_eq!((pixel_count, differing_count, far_count, greatest), (1000, 2, 1, 90));
    assert!((mean - 91.0 / 3000.0).abs() < 1e-12);
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
        ("shade-by", "fragment"),
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
