//! Its figures of executions and of the algorithm.

use super::scenes::{UNLIT, blurred, frames, pictures};
use crate::papers::item::{ABSENT, Item, Published, Scale, Verdict};
use crate::papers::recipe::{Effort, Recipe, Source, Step};
use crate::scene::procedural::panel;

const EXECUTIONS: &str = "executions a pixel";
const LONGEST: &str = "longest list";

pub const FIGURE_1: Item = Item {
    name: "figure-1",
    title: "Executions a pixel from 4 sharp samples to 16 under a large blur",
    place: "section 1",
    published: &[
        Published {
            title: "samples a pixel, aperture",
            unit: "number",
            columns: &[EXECUTIONS, LONGEST],
            rows: &[],
            scale: Scale::ItsMachine,
        },
        Published {
            title: "from 4 sharp samples to 16 blurred",
            unit: "% more executions",
            columns: &["growth"],
            rows: &[("all", &[29.0])],
            scale: Scale::Itself,
        },
    ],
    verdict: Verdict::Comparable(
        "Executions do not depend on the machine. The scene is a round of ours with as many triangles, draws and lights, and the apertures \
         are ours: the paper says that blur is large, and not how large.",
    ),
    recipe: Some(figure_1),
};

fn figure_1(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    for (spp, aperture) in [(4, "0"), (4, "0.05"), (8, "0.1"), (8, "0.2"), (16, "0.4")] {
        let step = format!("{spp}-{aperture}");
        let words =
            format!("{} --spp {spp} --tuples {} --aperture {aperture} --aov count.lengths", frames(effort), 4 * spp);
        recipe.step(Step::render(&step, "png", "arena", &words));
        let row = format!("{spp}, {aperture} m");
        recipe.cell(0, &row, EXECUTIONS, Source::counter(&step, "shaded_per_pixel"));
        recipe.cell(0, &row, LONGEST, Source::counter(&step, "longest_list"));
        recipe.picture(&row, format!("{step}.png"));
        recipe.picture(format!("{row}: lengths of lists"), format!("{step}.count.lengths.png"));
    }
    let rates = ["16-0.4", "4-0"].map(|step| Source::counter(step, "shaded_per_pixel"));
    recipe.cell(1, "all", "growth", Source::combined(rates, |rates| 100.0 * (rates[0] / rates[1] - 1.0)));
    recipe
}

pub const FIGURE_2: Item = Item {
    name: "figure-2",
    title: "How far samples lie from their pixels in shading space",
    place: "section 3",
    published: &[],
    verdict: Verdict::ShapeOnly("A drawing of one triangle there; the same mapping of every sample as a picture here."),
    recipe: Some(figure_2),
};

/// A moment of the flight under a lens.
fn flight(effort: Effort, words: &str) -> String {
    format!("{} --camera flight --time 10 --shutter 0,0.0166667 --aperture 0.1 {words}", pictures(effort))
}

fn figure_2(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    recipe.step(Step::render("arena", "png", "arena", &flight(effort, "--aov visibility.spids.shifts")));
    recipe.picture("shifts into shading space", "arena.visibility.spids.shifts.png");
    recipe
}

pub const FIGURE_3: Item = Item {
    name: "figure-3",
    title: "The data of the algorithm",
    place: "section 3",
    published: &[],
    verdict: Verdict::ShapeOnly(
        "A drawing there; the same buffers as pictures here: lists' lengths (A), zmax (B) and addresses (C).",
    ),
    recipe: Some(figure_3),
};

fn figure_3(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let stages = [
        ("triangles that samples see", "visibility.spids"),
        ("(A) lengths of lists", "count.lengths"),
        ("(B) zmax", "lists.zmax"),
        ("(C) addresses", "lists.addresses"),
    ];
    let names = stages.map(|(_, stage)| stage).join(",");
    recipe.step(Step::render(
        "arena",
        "png",
        "arena",
        &flight(effort, &format!("--shade-by fragment --zmax on --aov {names}")),
    ));
    for (title, stage) in stages {
        recipe.picture(title, format!("arena.{stage}.png"));
    }
    recipe
}

pub const FIGURE_4: Item = Item {
    name: "figure-4",
    title: "Visibility by rays of the processor, with and without SPIDs, beside rasterisation",
    place: "section 4.2",
    published: &[Published {
        title: "chess in motion, 8 samples",
        unit: "number",
        columns: &[EXECUTIONS, "rmse", "hdr_flip"],
        rows: &[],
        scale: Scale::ItsMachine,
    }],
    verdict: Verdict::ShapeOnly("The paper shows a picture without numbers; errors of ours are against 1024 samples."),
    recipe: Some(figure_4),
};

/// 64 tuples that all pixels share, sixteen times: fewer draws than as many interleaved samples take.
pub fn reference(effort: Effort) -> String {
    format!("--spp 64 --tuples 64 --accumulate {} --instrument off", effort.pick(16, 2))
}

fn figure_4(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let common = format!("{} --shutter 0,0.04", frames(effort));
    recipe.step(Step::render("reference", "exr", "chess", &format!("{common} {}", reference(effort))));
    for (row, step, words) in [
        ("rays", "rays", "--visibility ray --tuples 32"),
        ("rays, without SPIDs", "rays-direct", "--visibility ray --lists direct --tuples 32"),
        ("rays, of samples that pixels share", "rays-shared", "--visibility ray --pixel-samples shared --tuples 8"),
        ("drawn", "drawn", "--tuples 8"),
    ] {
        let words = format!("{common} --spp 8 {words}");
        recipe.step(Step::render(step, "exr", "chess", &words));
        let picture = format!("{step}-picture");
        recipe.step(Step::render(&picture, "png", "chess", &words));
        recipe.errors(0, row, [&format!("{step}.exr"), "reference.exr"], &["rmse", "hdr_flip"]);
        recipe.cell(0, row, EXECUTIONS, Source::counter(step, "shaded_per_pixel"));
        recipe.picture(row, format!("{picture}.png"));
    }
    recipe
}

pub const FIGURE_5: Item = Item {
    name: "figure-5",
    title: "Executions a pixel of the test scenes",
    place: "section 6",
    published: &[Published {
        title: "scene",
        unit: "number",
        columns: &[EXECUTIONS],
        rows: &[("ARENA", &[1.54]), ("SPONZA", &[1.45]), ("POWER", &[1.31])],
        scale: Scale::Itself,
    }],
    verdict: Verdict::Comparable(
        "Executions do not depend on the machine. Scenes are ours with as many triangles, draws and lights; apertures and shutter are ours, \
         because the paper does not give them.",
    ),
    recipe: Some(figure_5),
};

fn figure_5(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    for (name, scene, blur) in blurred(effort) {
        recipe.step(Step::render(name, "png", scene, &format!("{} {blur} --aov count.lengths", pictures(effort))));
        recipe.cell(0, name, EXECUTIONS, Source::counter(name, "shaded_per_pixel"));
        recipe.cell(0, name, LONGEST, Source::counter(name, "longest_list"));
        recipe.picture(name, format!("{name}.png"));
        recipe.picture(format!("{name}: lengths of lists"), format!("{name}.count.lengths.png"));
    }
    recipe
}

/// Moments of the flight that are looked at; the paper has 3600.
const MOMENTS: u32 = 60;

pub const FIGURE_6: Item = Item {
    name: "figure-6",
    title: "Executions a pixel along a flight through the arena",
    place: "section 6.1",
    published: &[Published {
        title: "blur",
        unit: EXECUTIONS,
        columns: &["least", "mean", "greatest"],
        rows: &[("all three together", &[1.10, ABSENT, 1.58])],
        scale: Scale::Itself,
    }],
    verdict: Verdict::Comparable(
        "Executions do not depend on the machine. The flight is ours, and looked at in 60 moments of its minute; --frames 3600 \
         looks at as many as the paper.",
    ),
    recipe: Some(figure_6),
};

/// Blurs of figure 6.
const FLIGHTS: [(&str, &str, &str); 3] = [
    ("2d", "still", ""),
    ("3d", "motion", "--shutter 0,0.0166667"),
    ("5d", "motion and defocus", "--shutter 0,0.0166667 --aperture 0.1"),
];

/// Most moments of one step: what is lost where it is stopped.
const MOMENTS_OF_STEP: u32 = 60;

fn figure_6(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let moments = effort.frames.unwrap_or(effort.pick(MOMENTS, 6));
    let per_second = f64::from(moments) / 60.0;
    let firsts = || (0..moments).step_by(MOMENTS_OF_STEP as usize);
    for (step, _, words) in FLIGHTS {
        for first in firsts() {
            let last = (first + MOMENTS_OF_STEP).min(moments) - 1;
            let film = format!("--frames {first}..{last} --fps {per_second}");
            let words = format!("{} --camera flight {film} {words} {UNLIT}", pictures(effort));
            recipe.step(Step::render(format!("{step}-{first}"), "png", "arena", &words));
        }
    }
    let rows = FLIGHTS.map(|(step, title, _)| (title, vec![step]));
    for (row, steps) in rows.into_iter().chain([("all three together", FLIGHTS.map(|(step, _, _)| step).to_vec())]) {
        let rates = |of: fn(&[f64]) -> f64| -> Vec<Source> {
            let films = steps.iter().flat_map(|step| firsts().map(move |first| format!("{step}-{first}")));
            films.map(|film| Source::frames(film, "shaded_per_pixel", of)).collect()
        };
        recipe.cell(0, row, "least", Source::combined(rates(least), least));
        recipe.cell(0, row, "greatest", Source::combined(rates(greatest), greatest));
        // Films may differ in length.
        let sums_and_lengths = rates(|all| all.iter().sum()).into_iter().chain(rates(|all| all.len() as f64));
        recipe.cell(
            0,
            row,
            "mean",
            Source::combined(sums_and_lengths, |parts| {
                let (sums, lengths) = parts.split_at(parts.len() / 2);
                sums.iter().sum::<f64>() / lengths.iter().sum::<f64>()
            }),
        );
    }
    recipe
}

fn least(all: &[f64]) -> f64 {
    all.iter().copied().fold(f64::INFINITY, f64::min)
}

fn greatest(all: &[f64]) -> f64 {
    all.iter().copied().fold(0.0, f64::max)
}

pub const FIGURE_7: Item = Item {
    name: "figure-7",
    title: "Executions a pixel by tessellation and blur",
    place: "section 6.1",
    published: &[
        Published {
            title: "a flat panel, sides of its triangles and diameter of blur",
            unit: EXECUTIONS,
            columns: &["sharp"],
            rows: &[],
            scale: Scale::PartsOfColumn("sharp"),
        },
        Published {
            title: "a whole scene, its triangles and the aperture",
            unit: EXECUTIONS,
            columns: &["sharp"],
            rows: &[],
            scale: Scale::PartsOfColumn("sharp"),
        },
    ],
    verdict: Verdict::ShapeOnly(
        "The curves' values are not in the text, nor is the simple test case. What it says is their shape: relative executions fall with blur, and \
         more so with finer tessellation. In a whole scene blur shows what would be hidden, too, so that they may grow.",
    ),
    recipe: Some(figure_7),
};

fn figure_7(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let px_m = panel::picture_height_m() / effort.pick(720.0, 180.0);
    for side_px in [16, 8, 4, 2] {
        let scene = format!("panel:parts={:.0}", panel::SIDE_M / (px_m * f64::from(side_px)));
        for blur_px in [0, 4, 16, 64] {
            let blur_m = f64::from(blur_px) * px_m;
            // What a small picture does not hold would be lost.
            if blur_m > panel::most_blur_m() {
                continue;
            }
            let step = format!("panel-{side_px}-{blur_px}");
            // A panel twice as far as what is in focus is blurred as wide as the lens is.
            let lens = format!("--focus 1 --aperture {blur_m:.6}");
            let words = format!("{} {} {UNLIT}", pictures(effort), if blur_px == 0 { "" } else { &lens });
            recipe.step(Step::render(&step, "png", &scene, &words));
            let column = if blur_px == 0 { "sharp".to_owned() } else { format!("{blur_px} pixels") };
            recipe.cell(0, format!("{side_px} pixels"), column, Source::counter(&step, "shaded_per_pixel"));
        }
    }
    for triangles in [30_000, 111_000, 444_000, 1_776_000] {
        for (column, aperture) in [("sharp", "0"), ("0.1 m", "0.1"), ("0.3 m", "0.3"), ("1 m", "1")] {
            let step = format!("{triangles}-{aperture}");
            let words = format!("{} --aperture {aperture} {UNLIT}", pictures(effort));
            recipe.step(Step::render(&step, "png", &format!("power:triangles={triangles}"), &words));
            recipe.cell(1, triangles.to_string(), column, Source::counter(&step, "shaded_per_pixel"));
        }
    }
    recipe
}
