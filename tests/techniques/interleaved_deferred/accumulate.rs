//! Progressive rendering (`--accumulate`, `--until-error`; Segovia 2006, section 6.3).

use super::vpl_maps::screened;
use super::{NAME, require_same_in_every_split};
use crate::support::difference::require_same;
use crate::support::program::Program;
use crate::support::watched::{Changes, Watched, both};
use quincunx::gpu::commands::Submits;
use quincunx::metrics::compare;
use quincunx::picture::Picture;

/// Light of virtual lights alone.
const COMMON: [(&str, &str); 4] = [("size", "64x36"), ("direct", "none"), ("position", "float"), ("texels", "1")];

/// The root of the mean square of relative errors, as `metrics::relmse` has it.
fn error(picture: &Picture, reference: &Picture) -> f64 {
    compare(picture, reference, 0.1).unwrap().metrics.relmse.sqrt()
}

/// Lights of many runs are those of one frame with all of them: but for what halves round and how runs divide.
#[test]
fn runs_are_the_lights_of_one_frame() {
    let watched = screened();
    for shadow in ["none", "ray", "map"] {
        let way = both(&COMMON, &[("split", "none"), ("vpl-shadow", shadow)]);
        let of = |changes: Changes<'_>| watched.picture(NAME, &both(&way, changes));
        let whole = of(&[("vpls", "512")]);
        let [one, many] = ["1", "16"].map(|runs| error(&of(&[("vpls", "32"), ("accumulate", runs)]), &whole));
        println!("{shadow}: a run is {one:.4} off, sixteen {many:.5}");
        assert!(many < 0.01 && one > 5.0 * many, "{shadow}: {one}, {many}");
    }
}

/// What blends meets the lights of all runs too, wherever depth is kept and whatever reads it between.
#[test]
fn blended_surfaces_have_the_lights_of_all_runs() {
    let watched = Watched::open("fence");
    let common = both(&COMMON, &[("blend-lights", "all"), ("vpls", "512"), ("split", "none"), ("direct", "full")]);
    let whole = watched.render(NAME, &common);
    assert!(whole.counters["blended_draws"] > 0.0);
    let whole = whole.picture().unwrap();
    let [few, many] = ["1", "16"]
        .map(|runs| error(&watched.picture(NAME, &both(&common, &[("accumulate", runs), ("vpls", "32")])), &whole));
    println!("a run is {few:.4} off, sixteen {many:.5}");
    assert!(many < 0.01 && few > 5.0 * many, "{few}, {many}");
    let way = both(&COMMON, &[("vpls", "48"), ("accumulate", "3"), ("vpl-shadow", "map"), ("storage", "image")]);
    for position in ["unorm16", "float", "depth"] {
        let of = |split, cull| {
            watched.picture(
                NAME,
                &both(&way, &[("position", position), ("split", split), ("direct", "full"), ("cull", cull)]),
            )
        };
        let [copied, drawn] = [of("one-pass", "none"), of("fragment", "tiled")];
        require_same(&watched.session.gpu, &copied, &drawn, &position);
    }
}

/// The G-buffer and its sub-buffers stay as they are from run to run, in every split, storage and form of copy.
#[test]
fn every_split_sums_the_same_runs_up() {
    let watched = screened();
    let way = both(&COMMON, &[("vpls", "48"), ("accumulate", "3"), ("vpl-shadow", "map"), ("vpl-shadow-maps", "20")]);
    let branch = require_same_in_every_split(&watched, &way);
    // There is something to tell apart.
    let one = watched.picture(NAME, &both(&way, &[("split", "branch"), ("accumulate", "1")]));
    assert!(error(&one, &branch) > 0.01);
}

/// What is not interleaved, and what is shaded at one pixel of each pattern.
#[test]
fn every_position_and_filter_tends_to_the_same() {
    let watched = screened();
    let way = both(&COMMON, &[("vpls", "64"), ("vpl-shadow", "ray")]);
    let exact = watched.picture(NAME, &both(&way, &[("split", "none"), ("vpls", "4096")]));
    for (changes, most) in [
        (&[("position", "depth")][..], 0.06),
        (&[("position", "unorm16")], 0.06),
        (&[("split", "subsample")], 0.15),
        (&[("split", "stencil")], 0.06),
        (&[("filter", "none")], 0.15),
        (&[("filter", "gauss-fast")], 0.06),
        (&[("pattern", "2x2")], 0.06),
    ] {
        let off = |runs| error(&watched.picture(NAME, &both(&both(&way, &[("accumulate", runs)]), changes)), &exact);
        let [few, many] = ["2", "64"].map(off);
        println!("{changes:?}: {few:.4} off after 2 runs, {many:.4} after 64");
        assert!(many < most && many < few, "{changes:?}: {few}, {many}");
    }
}

/// Halves of the runs say how far their mean is off: not much less than it is, and not many times as much.
#[test]
fn the_estimated_error_is_the_error() {
    let watched = screened();
    for split in ["none", "one-pass"] {
        let way = both(&COMMON, &[("vpl-shadow", "ray"), ("split", split), ("vpls", "16")]);
        let exact = watched.picture(NAME, &both(&way, &[("accumulate", "1024"), ("seed", "7")]));
        for runs in ["4", "16", "33"] {
            let renderer = watched.render(NAME, &both(&way, &[("accumulate", runs)]));
            let estimated = renderer.estimated_error().unwrap().unwrap();
            let actual = error(&renderer.picture().unwrap(), &exact);
            println!("{split}, {runs} runs: {estimated:.4} estimated, {actual:.4} off");
            assert!((0.8..4.0).contains(&(estimated / actual)), "{split}, {runs} runs: {estimated}, {actual}");
        }
    }
}

/// Runs end as soon as their picture is good enough, or when there are no more.
#[test]
fn runs_end_where_the_error_is_small_enough() {
    let watched = screened();
    let way = both(&COMMON, &[("vpls", "32"), ("vpl-shadow", "ray")]);
    let mut before = 1;
    for most in ["0.1", "0.03", "0.015"] {
        let renderer = watched.render(NAME, &both(&way, &[("until-error", most)]));
        let (runs, all) = renderer.runs();
        let estimated = renderer.estimated_error().unwrap().unwrap();
        println!("{most}: {runs} runs, {estimated:.4}");
        assert!(estimated <= most.parse().unwrap() && runs > before && all == 1 << 16, "{most}: {runs}, {estimated}");
        assert_eq!(f64::from(runs), renderer.measured_counters().unwrap()["runs"]);
        before = runs;
        // The same runs without being asked how good they are.
        let plain = watched.picture(NAME, &both(&way, &[("accumulate", &runs.to_string())]));
        require_same(&watched.session.gpu, &renderer.picture().unwrap(), &plain, &most);
    }
    // The last run comes after the last look at the error.
    let [asked, plain] = [&[("until-error", "0.0001")][..], &[]].map(|changes| {
        let renderer = watched.render(NAME, &both(&both(&way, &[("accumulate", "5")]), changes));
        assert_eq!(renderer.runs(), (5, 5));
        renderer.estimated_error().unwrap()
    });
    assert_eq!(asked, plain);
}

/// What a picture of many runs has no use for, and what has no runs, is refused.
#[test]
fn what_nothing_reads_is_refused() {
    let program = Program::new();
    let render =
        |more: &[&'static str]| [&["render", "cornell", "--technique", NAME, "--size", "16x16"], more].concat();
    for (arguments, words) in [
        (render(&["--accumulate", "2", "--fuse", "on"]), &["--fuse on with --accumulate 2", "--accumulate 1"][..]),
        (render(&["--until-error", "0.1", "--fuse", "on"]), &["--fuse on with --until-error 0.1", "--until-error 0"]),
        (render(&["--accumulate", "1", "--until-error", "0.1"]), &["--until-error 0.1 with --accumulate 1"]),
        (render(&["--accumulate", "0"]), &["--accumulate 0", "1 to 65536"]),
    ] {
        program.fails(&arguments, 2, words);
    }
    let stage = ["bench", "shade", "cornell", "--technique", NAME, "--size", "16x16", "--accumulate", "2"];
    program.fails(&stage, 2, &["a stage is timed in a frame of one run", "bench frame"]);
}

/// A frame begins anew: with its first run's lights, and with sums of nothing. Asking how good it is leaves it as it is.
#[test]
fn a_frame_again_is_the_same_frame() {
    let watched = screened();
    let way = both(&COMMON, &[("vpls", "32"), ("accumulate", "3"), ("vpl-shadow", "map")]);
    for submits in [Submits::One, Submits::PerPass] {
        let renderer = watched.render_as(NAME, &way, &["filter.irradiance", "shade.irradiance"], submits);
        let first = renderer.picture().unwrap();
        renderer.estimated_error().unwrap().unwrap();
        require_same(&watched.session.gpu, &first, &renderer.picture().unwrap(), &"after its error");
        let filtered = watched.rgb(&renderer, "filter.irradiance");
        renderer.frame().unwrap();
        require_same(&watched.session.gpu, &first, &renderer.picture().unwrap(), &"again");
        assert_eq!(filtered, watched.rgb(&renderer, "filter.irradiance"));
    }
}

/// Each run's walks, records and passes count, and what all runs share counts once.
#[test]
fn times_are_of_all_runs() {
    let watched = screened();
    let way = both(&COMMON, &[("vpls", "32"), ("accumulate", "4"), ("vpl-shadow", "map")]);
    let renderer = watched.render_as(NAME, &way, &[], Submits::PerPass);
    let time = renderer.frame().unwrap();
    let host: Vec<&str> = time.host.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(host, ["vpls", "vpls.upload", "record"].map(|pass| format!("{NAME}.{pass}")));
    assert!(renderer.host_passes.iter().all(|(name, _)| !name.contains("vpls")));
    assert_eq!(time.passes.len(), renderer.passes().len());
    assert!(time.passes.iter().all(|pass| pass.wall_ns.is_some_and(|ns| ns > 0)), "every pass has run");
    let looked = watched.render_as(NAME, &both(&way, &[("until-error", "0.0001")]), &[], Submits::PerPass);
    let looked = looked.frame().unwrap();
    assert!(looked.host.iter().any(|(name, ns)| name.ends_with(".compare") && *ns > 0));
    let walls: u64 = time.passes.iter().filter_map(|pass| pass.wall_ns).sum();
    assert!(walls <= time.wall_ns, "{walls} of {}", time.wall_ns);
}
