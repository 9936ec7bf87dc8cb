//! What its section 2.2 says of aliasing between pixels, in scenes.

use super::figures::mean;
use crate::papers::item::{Item, Published, Scale, Verdict};
use crate::papers::recipe::{Effort, Recipe, Source, Step};

/// Seeds that a mean is of.
const SEEDS: u32 = 8;

struct Seen {
    row: &'static str,
    /// Begins the names of its steps.
    name: &'static str,
    scene: &'static str,
    /// Pixels.
    size: [u32; 2],
    /// Its lights cast them.
    has_shadows: bool,
    /// Settings of both renderers.
    words: &'static str,
}

const SCENES: [Seen; 4] = [
    Seen {
        row: "zone plate",
        name: "plate",
        scene: "zone-plate:frequency=128,growth=64",
        size: [128, 128],
        has_shadows: false,
        words: "",
    },
    Seen {
        row: "fence without shadows",
        name: "fence",
        scene: "fence:seed=1",
        size: [160, 90],
        has_shadows: false,
        words: "--brdf lambert",
    },
    Seen {
        row: "lamps",
        name: "lamps",
        scene: "lamps:seed=1",
        size: [160, 90],
        has_shadows: true,
        words: "--brdf lambert",
    },
    Seen {
        row: "chess",
        name: "chess",
        scene: "chess:triangles=12000,seed=1",
        size: [160, 90],
        has_shadows: true,
        words: "--brdf lambert",
    },
];

pub const SECTION_2_2: Item = Item {
    name: "section-2.2",
    title: "What a basis of several pixels takes of the slow part of errors",
    place: "section 2.2",
    published: &[Published {
        title: "scene and sampler",
        unit: "energy of the error below an eighth of a cycle a pixel",
        columns: &["1x1", "2x2", "1x1 in parts of 2x2"],
        rows: &[],
        scale: Scale::ItsMachine,
    }],
    verdict: Verdict::ShapeOnly(
        "The paper says without numbers that the potential for aliasing between pixels is attenuated: ours are of 4 samples a pixel against paths, \
         means over eight seeds.",
    ),
    recipe: Some(moire),
};

fn moire(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let seeds = effort.pick(SEEDS, 2);
    for Seen { row, name, scene, size: [width, height], has_shadows, words } in SCENES {
        let common = format!("{} {words}", effort.size(width, height));
        let seen = if has_shadows { ("on", "ray") } else { ("off", "none") };
        let paths = format!(
            "--technique path_traced --spp {} --texture-level cone --transport direct --emissive off --ambient-visibility off \
             --light-visibility {} {common}",
            effort.pick(1024, 64),
            seen.0
        );
        recipe.step(Step::render(format!("{name}-paths"), "exr", scene, &paths));
        for sampler in ["random", "jittered", "relaxed"] {
            let step = |basis: &str, seed: u32| format!("{name}-{sampler}-{basis}-{seed}");
            for basis in ["1x1", "2x2"] {
                for seed in 1..=seeds {
                    let picture = step(basis, seed);
                    let words = format!(
                        "--technique interleaved_sampling --basis {basis} --samples 4 --sampler {sampler} --seed {seed} \
                         --direct-shadow {} {common}",
                        seen.1
                    );
                    recipe.step(Step::render(&picture, "exr", scene, &words));
                    let files = [format!("{picture}.exr"), format!("{name}-paths.exr")];
                    recipe.step(Step::spectrum(format!("{picture}-error"), [&files[0], &files[1]]));
                }
            }
            let energy = |basis: &'static str| {
                let of =
                    move |seed| Source::document(format!("{}-error", step(basis, seed)), "/spectrum/low_energy", 1.0);
                (1..=seeds).map(of).collect::<Vec<_>>()
            };
            let row = format!("{row}, {sampler}");
            for basis in ["1x1", "2x2"] {
                recipe.cell(0, &row, basis, Source::combined(energy(basis), mean));
            }
            let both = energy("1x1").into_iter().chain(energy("2x2"));
            let ratio = Source::combined(both, |all| mean(&all[..all.len() / 2]) / mean(&all[all.len() / 2..]));
            recipe.cell(0, row, "1x1 in parts of 2x2", ratio);
        }
    }
    recipe
}
