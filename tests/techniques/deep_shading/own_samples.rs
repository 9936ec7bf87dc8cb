//! `--pixel-samples own`: pixels have samples of their own, whose errors are noise and no pattern; stochastic rasterisation finds the
//! ones that rays find on the host, by either of its tests; more of them come to what path tracing sees.

use super::{DEEP, SIZE};
use crate::support::difference::rmse;
use crate::support::moving::moving;
use crate::support::placing_steps;
use crate::support::watched::{Changes, Watched, both};
use quincunx::gpu::commands::Submits;
use quincunx::picture::Picture;

const STOCHASTIC: (&str, &str) = ("visibility", "stochastic");
const RAY: (&str, &str) = ("visibility", "ray");
const OWN: (&str, &str) = ("pixel-samples", "own");
const SHARED: (&str, &str) = ("pixel-samples", "shared");
const FULL: (&str, &str) = ("coverage-test", "full");

/// The triangles that samples see, one a pixel.
fn seen(watched: &Watched, changes: Changes<'_>) -> Vec<u32> {
    let stage = "visibility.spids";
    let common = both(&[SIZE, ("spp", "1"), ("tuples", "16")], changes);
    watched.integers(&watched.render_stages(DEEP, &common, &[stage]), stage)
}

/// The part of them that two lists differ in.
fn apart(one: &[u32], other: &[u32]) -> f64 {
    one.iter().zip(other).filter(|(a, b)| a != b).count() as f64 / one.len() as f64
}

/// A hall under a lens, and the fence's rotor, which turns by a quarter of a turn, its panes glass or with holes, under one too.
fn blurred() -> [(Watched, Vec<(&'static str, &'static str)>); 3] {
    let fence = |spec| Watched::with_scene(moving(spec, [0.0, 0.1]));
    let rotor = vec![("camera", "rotor"), ("aperture", "0.1"), ("focus", "4")];
    [
        (Watched::open("hall:triangles=8000"), vec![("aperture", "0.3"), ("focus", "6")]),
        (fence("fence:lights=6"), rotor.clone()),
        (fence("fence:lights=6,alpha=mask"), rotor),
    ]
}

/// Rays meet a triangle where floats say, and so do the tests: what differs are edges, and holes, which rays read finer.
#[test]
fn stochastic_rasterisation_finds_the_samples_that_rays_find() {
    for (watched, common) in blurred() {
        let [drawn, traced] = [STOCHASTIC, RAY].map(|kind| seen(&watched, &both(&common, &[kind, OWN])));
        let shared = seen(&watched, &both(&common, &[STOCHASTIC, SHARED]));
        let (far, other) = (apart(&drawn, &traced), apart(&drawn, &shared));
        println!("{common:?}: {far} differ from rays, {other} from samples that pixels share");
        assert!(far < 0.02 * placing_steps(&watched.session.gpu.caps), "{common:?}: {far}");
        assert!(other > 0.1, "{common:?}: {other}");
        assert_eq!(seen(&watched, &both(&common, &[STOCHASTIC])), drawn, "{common:?}: auto");
        assert_eq!(seen(&watched, &both(&common, &[RAY])), traced, "{common:?}: auto");
    }
}

/// Edges are placed by fewer products: a sample that is as near to one as rounding may be on its other side.
#[test]
fn the_reduced_test_sees_what_the_full_one_does() {
    let more: [Changes<'_>; 4] = [
        &[],
        &[("sample-tests", "layers")],
        &[SHARED, ("polygon-from", "vertex")],
        &[("stereo", "0.065"), ("stereo-eyes", "right")],
    ];
    for ((watched, common), more) in blurred().into_iter().zip([&more[..], &more[..2], &more[..1]]) {
        for more in more {
            let common = both(&both(&common, &[STOCHASTIC]), more);
            let [full, reduced] = [&[FULL][..], &[]].map(|test| seen(&watched, &both(&common, test)));
            let far = apart(&full, &reduced);
            assert!(full.iter().filter(|id| **id != u32::MAX).count() > full.len() / 4, "{common:?}");
            assert!(far < 5e-4, "{common:?}: {far}");
        }
        let own = [SIZE, ("shading", "msaa"), ("spp", "2")];
        let [full, reduced] = [&[FULL][..], &[]].map(|test| watched.picture(DEEP, &both(&both(&common, &own), test)));
        let far = rmse(&full, &reduced);
        assert!(far < 1e-3, "{common:?}: {far}");
    }
}

/// How much the errors of pixels beside each other have in common: 1 where they are the same, 0 where they have nothing to do with
/// each other.
fn correlation(picture: &Picture, reference: &Picture, width: usize) -> f64 {
    let error = |(a, b): (&[f32; 3], &[f32; 3])| (0..3).map(|channel| f64::from(a[channel] - b[channel])).sum::<f64>();
    let errors: Vec<f64> = picture.pixels.iter().zip(&reference.pixels).map(error).collect();
    let rows = || errors.chunks(width).flat_map(|row| row.windows(2));
    let product = |one: usize, other: usize| rows().map(|pair| pair[one] * pair[other]).sum::<f64>();
    product(0, 1) / (product(0, 0) * product(1, 1)).sqrt()
}

/// Each pixel's error is its own, where pixels that share their samples have an edge's steps in common (figure 10): by every way
/// to them, and for multisampling.
#[test]
fn errors_of_neighbours_have_little_in_common() {
    // The box is the same with every seed.
    let watched = Watched::open("cornell");
    let common = [("size", "160x90"), ("aperture", "0.2"), ("brdf", "lambert"), ("reconstruct", "off")];
    let of = |more: Changes<'_>| watched.picture(DEEP, &both(&common, more));
    let reference = of(&[("spp", "64"), ("accumulate", "8"), ("seed", "9")]);
    let eight = [("spp", "8"), ("tuples", "8")];
    let of = |more: Changes<'_>| correlation(&of(&both(&eight, more)), &reference, 160);
    let shared = of(&[]);
    for kind in [&[STOCHASTIC][..], &[STOCHASTIC, ("sample-tests", "layers")], &[RAY], &[("shading", "msaa")]] {
        let (own, shared_too) = (of(kind), of(&both(kind, &[SHARED])));
        println!("{kind:?}: {own}, shared {shared_too}, interleaved {shared}");
        assert!(
            own.abs() < 0.1 && shared > 0.7 && (shared_too / shared - 1.0).abs() < 0.1,
            "{kind:?}: {own}, {shared_too}, {shared}"
        );
    }
}

/// Sixteen sets of four samples have less than half of one set's error from many paths.
#[test]
fn more_of_a_pixel_s_own_samples_come_to_what_path_tracing_sees() {
    let watched = Watched::open("cornell");
    let lens = [("size", "48x36"), ("brdf", "lambert"), ("aperture", "0.15")];
    let traced = [("transport", "direct"), ("light-visibility", "off"), ("emissive", "off"), ("spp", "512")];
    let reference = watched.picture("path_traced", &both(&lens, &traced));
    let of = |sets| {
        rmse(&watched.picture(DEEP, &both(&lens, &[STOCHASTIC, ("spp", "4"), ("accumulate", sets)])), &reference)
    };
    let errors = ["1", "16"].map(of);
    println!("{errors:?}");
    assert!(errors[1] < 0.5 * errors[0], "{errors:?}");
}

/// What draws tuples cannot have other samples; what draws no polygons tests none.
#[test]
fn what_has_no_samples_of_a_pixel_s_own_says_so() {
    let watched = Watched::open("cornell");
    for (changes, why) in [
        (&[OWN, ("visibility", "repeat-frame")][..], "--pixel-samples own with --visibility repeat-frame"),
        (&[OWN, ("visibility", "replicate")], "--pixel-samples own with --visibility replicate"),
        (&[FULL, RAY], "--coverage-test full with --visibility ray"),
    ] {
        let error = watched.try_renderer(DEEP, &both(&[SIZE], changes), &[], Submits::One).err().unwrap();
        assert_eq!(error.exit_code(), 2, "{error}");
        assert!(error.to_string().contains(why), "{error}");
    }
}
