//! Pictures of shaders that another compiler has rounded otherwise (tools/pretend, contract and last-bit): the same to
//! the eye.

use crate::pretend;
use crate::support::pretending::Layer;
use crate::support::program::Program;
use quincunx::metrics;
use quincunx::picture::{Picture, image_file};

/// Methods that make one picture by different shaders, and others that have shaders of their own.
const METHODS: [&str; 19] = [
    "cornell --technique interleaved_deferred --size 64x36 --split tile --cull tiled",
    "cornell --technique interleaved_deferred --size 64x36 --split branch",
    "cornell --technique interleaved_deferred --size 48x27 --vpls 64 --split depth",
    "cornell --technique interleaved_deferred --size 64x36 --split none",
    "cornell --technique deep_shading --size 48x32 --spp 4 --aperture 0.05",
    "cornell --technique deep_shading --size 48x32 --spp 4 --aperture 0.05 --compaction off",
    "cornell --technique deep_shading --size 48x32 --spp 4 --aperture 0.05 --lists none",
    "cornell --technique deep_shading --size 48x32 --spp 4 --aperture 0.05 --shading indirect-gbuffer",
    "cornell --technique deep_shading --size 48x32 --spp 4 --shade-by fragment --conservative vertex",
    "cornell --technique deep_shading --size 48x32 --spp 4 --visibility stochastic --shutter 0,0.1",
    "cornell --technique deep_shading --size 48x32 --spp 4 --visibility ray --lists direct",
    "fence:lights=6 --technique deep_shading --size 96x54 --spp 2 --camera rotor --shutter 0,0.1 --shading msaa --pass-samples 1",
    "lamps:objects=20,lights=8 --technique deferred --size 64x36 --cull none",
    "cornell --technique deferred --size 48x32 --direct-shadow ray",
    "cornell --technique path_traced --size 32x24 --spp 2 --node-width 2",
    "fence --technique inferred_lighting --size 64x36 --volumes tiled",
    "cornell --technique forward --size 64x36 --depth-prepass on",
    "cornell --technique forward --size 64x36 --depth-prepass off",
    "lamps --technique inferred_lighting --size 64x36",
];

/// How far a picture is from the one of shaders as they are written.
struct Figures {
    flip: f64,
    rmse: f64,
    /// Percent of the pixels with another 8-bit code.
    other_percent: f64,
    /// Difference of the means, as a part of the greater one.
    mean_part: f64,
}

impl Figures {
    fn of(picture: &Picture, plain: &Picture) -> Self {
        let compared = metrics::compare(picture, plain, metrics::DEFAULT_THRESHOLD).unwrap().metrics;
        let code = |pixel: &[f32; 3]| pixel.map(|channel| (255.0 * channel.clamp(0.0, 1.0)).round() as u8);
        let other_count = picture.pixels.iter().zip(&plain.pixels).filter(|(a, b)| code(a) != code(b)).count();
        let sum = |picture: &Picture| picture.mean().into_iter().sum::<f64>();
        let (mean, expected) = (sum(picture), sum(plain));
        Self {
            flip: compared.flip,
            rmse: compared.rmse,
            other_percent: 100.0 * other_count as f64 / plain.pixels.len() as f64,
            mean_part: (mean - expected).abs() / mean.max(expected).max(f64::MIN_POSITIVE),
        }
    }
}

/// Renders `command` under each of `modes` and holds its pictures to the bounds. Returns how many have other bits than
/// the plain one.
fn hold(program: &Program, layer: &Layer, command: &str, modes: &[&str]) -> usize {
    let words: Vec<&str> = command.split(' ').collect();
    let render = |variables: &[(&str, &str)]| {
        let arguments = [&["render"], &words[..], &["-o", "a.exr", "--json", "--quiet"]].concat();
        let report = program.run_with(&arguments, variables).fine().json();
        let picture = image_file::read(program.path("a.exr").as_ref()).unwrap();
        (picture, report)
    };
    let (plain, _) = render(&[]);
    let differs = |modes: &&&str| {
        let (picture, report) = render(&layer.variables(modes));
        let without_colour = &report["counters"]["samples_without_colour"];
        assert!(without_colour.is_null() || without_colour == 0.0, "{command:?} under {modes}: {without_colour}");
        let Figures { flip, rmse, other_percent, mean_part } = Figures::of(&picture, &plain);
        let mean_percent = 100.0 * mean_part;
        let figures = format!(
            "{command:?} under {modes}: FLIP {flip:.6}, RMSE {rmse:.7}, {other_percent:.2} % of the pixels, \
             means {mean_percent:.4} % apart"
        );
        println!("{figures}");
        // One path that takes another turn is one of few in its pixel: noise, which leaves the mean of all where it is.
        let holds = if command.contains("path_traced") { mean_part < 0.02 } else { flip < 0.001 };
        assert!(holds, "{figures}");
        picture.pixels != plain.pixels
    };
    modes.iter().filter(differs).count()
}

/// A sample of the next test's: a technique each, both modes at once.
#[test]
fn pictures_of_shaders_that_round_otherwise_are_the_same_to_the_eye() {
    let Some(layer) = Layer::built() else { return };
    let program = Program::new();
    let commands = [
        pretend::COMMANDS[0],
        pretend::COMMANDS[5],
        pretend::COMMANDS[9],
        pretend::COMMANDS[14],
        METHODS[2],
        METHODS[6],
        METHODS[11],
    ];
    let changed: usize =
        commands.iter().map(|command| hold(&program, &layer, command, &["contract=1,last-bit=1"])).sum();
    assert!(changed > 0, "no bit of any picture has changed: nothing was pretended");
}

/// `tools/test --run-ignored only pretend::rounding --no-capture` prints the figures.
#[test]
#[ignore = "238 renders, some ten minutes"]
fn pictures_of_all_methods_are_the_same_to_the_eye_by_each_seed() {
    let Some(layer) = Layer::built() else { return };
    let program = Program::new();
    let modes = ["contract=1", "contract=2", "contract=3", "last-bit=1", "last-bit=2", "last-bit=3"];
    for command in METHODS.iter().chain(&pretend::COMMANDS) {
        hold(&program, &layer, command, &modes);
    }
}
