//! Its volumes.

use crate::bench::row::BenchRow;
use crate::papers::figures;
use crate::papers::item::{Item, Published, Scale, Verdict};
use crate::papers::recipe::{Effort, Recipe, Source, Step};

pub const FIGURE_3: Item = Item {
    name: "figure-3",
    title: "Small pictures of slices made one large one",
    place: "section 3.3",
    published: &[],
    verdict: Verdict::NotHere("It is a drawing, without numbers; figure-5 has its pictures."),
    recipe: None,
};

const SLICED: &str = "--technique interleaved_sampling --effect volume --samples 1";

/// Name, and what fills the frame.
const VOLUMES: [(&str, &str); 4] = [
    ("head-tissue", "--volume head --transfer tissue"),
    ("head-ramp", "--volume head --transfer ramp"),
    ("marschner-lobb-shells", "--volume marschner-lobb --transfer shells"),
    ("marschner-lobb-heat", "--volume marschner-lobb --transfer heat"),
];

const PLANES: [&str; 3] = ["20", "60", "120"];

pub const FIGURE_5: Item = Item {
    name: "figure-5",
    title: "20, 60 and 120 planes, without and with interleaving",
    place: "section 3.3",
    published: &[Published {
        title: "volume, depth, pattern and planes",
        unit: "error against a march",
        columns: &["flip", "rmse"],
        rows: &[],
        scale: Scale::ItsMachine,
    }],
    verdict: Verdict::ShapeOnly(
        "The paper shows pictures and says that 60 interleaved planes look better than 120 without: errors of ours are with 8 bits a channel and with \
         floats. --volume takes a scan.",
    ),
    recipe: Some(figure_5),
};

fn figure_5(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let size = effort.size(256, 256);
    for (name, words) in VOLUMES {
        for (title, basis) in [("", "1x1"), (", interleaved", "2x2")] {
            for planes in PLANES {
                let step = format!("{name}-{planes}-{basis}");
                let words = format!("{SLICED} {size} {words} --basis {basis} --planes {planes} --depth 8");
                recipe.step(Step::render(&step, "png", "specimen", &words));
                recipe.picture(format!("{name}, {planes} planes{title}"), format!("{step}.png"));
            }
        }
        let step = format!("{name}-errors");
        let sweeps = "--sweep depth=8,float --sweep basis=1x1,2x2 --sweep planes=20,60,120";
        let words = format!("{SLICED} {size} {words} --reference auto --reference-spp 1 {sweeps}");
        recipe.step(Step::bench(&step, "frame", "specimen", 1, &words));
        for depth in ["8", "float"] {
            for basis in ["1x1", "2x2"] {
                for planes in PLANES {
                    let row = format!("{name}, {depth}, {basis}, {planes}");
                    let variant = || format!("depth={depth} basis={basis} planes={planes}");
                    let flip = |row: &BenchRow| Some(row.errors.as_ref()?.metrics.flip);
                    let rmse = |row: &BenchRow| Some(row.errors.as_ref()?.metrics.rmse);
                    recipe.cell(0, &row, "flip", Source::row(&step, variant(), figures::exact(flip)));
                    recipe.cell(0, &row, "rmse", Source::row(&step, variant(), figures::exact(rmse)));
                }
            }
        }
    }
    recipe
}

pub const FIGURE_6: Item = Item {
    name: "figure-6",
    title: "A scan by magnetic resonance",
    place: "section 3.3",
    published: &[],
    verdict: Verdict::NotHere(
        "The scan was given to the authors and is not public. `reproduce keller-2001/figure-5 --volume FILE` has the figure's pictures of another.",
    ),
    recipe: None,
};

const OF_PLAIN: &str = "not interleaved";

pub const SECTION_3_3: Item = Item {
    name: "section-3.3",
    title: "What combining costs",
    place: "section 3.3",
    published: &[
        Published {
            title: "planes",
            unit: "frames/s",
            columns: &[OF_PLAIN, "interleaved"],
            rows: &[("120", &[20.0, 18.0])],
            scale: Scale::PartsOfColumn(OF_PLAIN),
        },
        Published {
            title: "cost of combining, whatever the number of planes is",
            unit: "planes",
            columns: &["layers", "stipple"],
            rows: &[("Octane VPro", &[8.0, 8.0])],
            scale: Scale::ItsMachine,
        },
    ],
    verdict: Verdict::ShapeOnly(
        "Frames a second are of an SGI Octane; of 20 planes the paper says more than 30 for both. A plane's time here is the growth of a pass of slices \
         from 20 planes to 120.",
    ),
    recipe: Some(section_3_3),
};

fn section_3_3(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let words = format!("{SLICED} {} --volume head:size=64 --transfer ramp", effort.size(512, 512));
    let frames = format!("{words} --sweep planes=20,60,120 --sweep basis=1x1,2x2 --baseline basis=1x1");
    recipe.step(Step::bench("frames", "frame", "specimen", 5, &frames));
    for planes in PLANES {
        for (column, basis) in [(OF_PLAIN, "1x1"), ("interleaved", "2x2")] {
            let source = Source::row("frames", format!("planes={planes} basis={basis}"), figures::per_second());
            recipe.cell(0, planes, column, source);
        }
    }
    for (stage, sweeps) in [
        ("slices", "--basis 1x1 --sweep planes=20,120"),
        ("combine", "--basis 2x2 --sweep planes=20,60,120 --sweep members=layers,stipple"),
    ] {
        recipe.step(Step::bench(stage, stage, "specimen", 5, &format!("{words} {sweeps}")));
    }
    for members in ["layers", "stipple"] {
        for planes in PLANES {
            let slices = |planes: u32| Source::row("slices", format!("planes={planes}"), figures::ms());
            let combine = Source::row("combine", format!("planes={planes} members={members}"), figures::ms());
            let cost = Source::combined([combine, slices(120), slices(20)], |ms| ms[0] / ((ms[1] - ms[2]) / 100.0));
            recipe.cell(1, format!("this device, {planes} planes"), members, cost);
        }
    }
    recipe
}
