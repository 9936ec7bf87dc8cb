//! Pictures on a device that behaves as others may (tools/pretend): the same to the bit, or refused by name.

mod rounding;
mod samples;
mod shaders;

use crate::support::pretending::Layer;
use crate::support::program::Program;

/// A scene and settings; what each mode may change lies in some of them: `auto`, sharing of bytes, discards, lists, host-written buffers.
pub const COMMANDS: [&str; 15] = [
    "cornell --technique interleaved_deferred --size 97x53",
    "hall:triangles=8000 --technique interleaved_deferred --size 64x36 --split tile --fuse on",
    "cornell --technique interleaved_deferred --size 64x36 --split stencil",
    "cornell --technique interleaved_deferred --size 64x36 --split layered --filter gauss-fast",
    "fence --technique inferred_lighting --size 64x36 --msaa 4",
    "fence --technique inferred_lighting --size 64x36 --volumes both",
    "hall:triangles=8000 --technique deep_shading --size 64x36 --spp 4 --aperture 0.1",
    "cornell --technique deep_shading --size 33x17 --shading texture-space",
    "cornell --technique deep_shading --size 33x17 --shading indirect-gbuffer --shutter 0,0.1",
    "cornell --technique deferred --size 33x17",
    "hall:triangles=8000 --technique forward --size 64x36 --direct-shadow map",
    "lamps --technique deferred --size 64x36 --cull tiled",
    "fence --technique forward --size 64x36 --msaa 4 --sample-shading on",
    "cornell --technique path_traced --size 33x17 --spp 2",
    "cornell --technique path_traced --size 33x17 --spp 2 --medium 0.05,0.01,0.3 --punctual off",
];

/// Modes together, and whether a device may lack what a command needs and say so.
const MODES: [(&str, bool); 3] =
    [("poison,discard", false), ("discrete,gpu,poison,padding", false), ("least-limits", true)];

/// One test for all of them: what they are held against is rendered once.
#[test]
fn pictures_on_devices_that_are_not_there_are_the_same_or_refused_by_name() {
    let Some(layer) = Layer::built() else { return };
    let program = Program::new();
    let mut refused = 0;
    for command in COMMANDS {
        let words: Vec<&str> = command.split(' ').collect();
        let command = [&["render"], &words[..], &["-o", "a.exr", "--json", "--quiet"]].concat();
        let expected = program.run(&command).fine().json()["image"]["hash"].clone();
        for (modes, may_refuse) in MODES {
            // Bytes that several share have no guarded ones behind them.
            let alone: &[&str] = if modes.contains("padding") { &["--alias", "off"] } else { &[] };
            let ran = program.run_with(&[&command, alone].concat(), &layer.variables(modes));
            if may_refuse && ran.code != 0 {
                assert!(matches!(ran.code, 2 | 3), "{command:?} under {modes}: {} {}", ran.code, ran.err);
                let is_named = ["--", " needs ", "(max"].iter().any(|word| ran.err.contains(word));
                assert!(ran.err.starts_with("error: ") && is_named, "{command:?} under {modes}: {}", ran.err);
                refused += 1;
                continue;
            }
            let report = ran.fine().json();
            assert_eq!(report["image"]["hash"], expected, "{command:?} under {modes}");
            // Without the layer a test of what it does would pass.
            let is_gpu = report["device"]["name"] == "Pretended GPU";
            assert_eq!(is_gpu, modes.contains("gpu"), "{modes}: {}", report["device"]);
        }
    }
    assert!((1..COMMANDS.len()).contains(&refused), "{refused} refused");
}
