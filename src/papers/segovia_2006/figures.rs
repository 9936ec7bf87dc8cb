//! Its nine figures.

use crate::bench::row::BenchRow;
use crate::papers::figures;
use crate::papers::item::{ABSENT, Item, Published, Scale, Verdict};
use crate::papers::recipe::{Effort, Number, Recipe, Source, Step};

pub const FIGURE_1: Item = Item {
    name: "figure-1",
    title: "Direct light, and 512 virtual lights beside it",
    place: "section 1",
    published: &[Published {
        title: "device",
        unit: "frames/s",
        columns: &["512 virtual lights"],
        rows: &[("GeForce 6800 GT", &[17.0]), ("GeForce 7800 GT", &[33.0])],
        scale: Scale::ItsMachine,
    }],
    verdict: Verdict::ShapeOnly("Frames a second are of two GPUs and of a level of Quake 3 that is not ours to ship."),
    recipe: Some(figure_1),
};

fn figure_1(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let size = effort.size(1024, 768);
    recipe.step(Step::render("direct", "png", "hall", &format!("--technique deferred {size}")));
    recipe.step(Step::render("indirect", "png", "hall", &format!("{size} --vpls 512 --pattern 4x4")));
    recipe.step(Step::bench("frame", "frame", "hall", 5, &format!("{size} --vpls 512 --pattern 4x4")));
    recipe.cell(0, "this device", "512 virtual lights", Source::row("frame", "defaults", figures::per_second()));
    recipe.picture("(a) direct light", "direct.png");
    recipe.picture("(b) with 512 virtual lights", "indirect.png");
    recipe
}

pub const FIGURE_2: Item = Item {
    name: "figure-2",
    title: "A split with a pattern of 3x2",
    place: "section 3.3",
    published: &[],
    verdict: Verdict::ShapeOnly(
        "A drawing there, and pictures of the buffers here. Where each texel goes is asserted by tests, for every method.",
    ),
    recipe: Some(figure_2),
};

fn figure_2(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let words =
        format!("{} --vpls 48 --pattern 3x2 --split two-pass --aov gbuffer.normal,split.normal", effort.size(768, 512));
    recipe.step(Step::render("split", "png", "hall", &words));
    recipe.picture("(a) the G-buffer's normals", "split.gbuffer.normal.png");
    recipe.picture("(d) six sub-buffers", "split.split.normal.png");
    recipe
}

pub const FIGURE_3: Item = Item {
    name: "figure-3",
    title: "The pipeline, buffer by buffer",
    place: "section 4",
    published: &[],
    verdict: Verdict::ShapeOnly("Pictures of the same buffers, of another scene."),
    recipe: Some(figure_3),
};

fn figure_3(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let stages = [
        ("(a) G-buffer: normals", "gbuffer.normal"),
        ("(b) split", "split.normal"),
        ("(c) shaded, each sub-buffer with its own lights", "shade.irradiance"),
        ("(d) gathered: the pattern shows", "gather.irradiance"),
        ("(e) discontinuities", "discontinuity.flags"),
        ("(f) blurred", "filter.irradiance"),
    ];
    let names: Vec<&str> = stages.iter().map(|(_, stage)| *stage).collect();
    let words = format!("{} --vpls 512 --pattern 4x4 --aov {}", effort.size(1024, 768), names.join(","));
    recipe.step(Step::render("stages", "png", "hall", &words));
    for (title, stage) in stages {
        recipe.picture(title, format!("stages.{stage}.png"));
    }
    recipe.picture("(g) with the surfaces' colours", "stages.png");
    recipe
}

pub const FIGURE_4: Item = Item {
    name: "figure-4",
    title: "Where the two blurs read",
    place: "section 4.5",
    published: &[],
    verdict: Verdict::NotHere(
        "It is a drawing of texels, without numbers. Both blurs run (--filter gauss, gauss-fast) and are held against a plain \
         loop by tests; table-2 has their times.",
    ),
    recipe: None,
};

/// Sides of blocks that figure 5 goes over here; the paper does not say over which it goes.
const BLOCKS: [u32; 6] = [4, 8, 16, 32, 64, 128];

pub const FIGURE_5: Item = Item {
    name: "figure-5",
    title: "Time of the split by block and pattern",
    place: "section 5.1",
    published: &[
        Published {
            title: "pattern",
            unit: "ms",
            columns: &["one pass"],
            rows: &[("2x2", &[ABSENT]), ("4x4", &[ABSENT]), ("8x8", &[ABSENT])],
            scale: Scale::PartsOfColumn("one pass"),
        },
        Published {
            title: "pattern",
            unit: "px, or %",
            columns: &["best block, px", "faster than one pass, %"],
            rows: &[("2x2", &[32.0, 5.0]), ("4x4", &[16.0, 70.0])],
            scale: Scale::ItsMachine,
        },
    ],
    verdict: Verdict::ShapeOnly(
        "The curves' values are not in the text, but their least ones are, for a GeForce 6800 GT. The gain of two passes comes \
         from that GPU's texture cache and its textures' blocks of memory.",
    ),
    recipe: Some(figure_5),
};

fn figure_5(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    for pattern in ["2x2", "4x4", "8x8"] {
        recipe.step(split_by_block(pattern, pattern, &effort.size(1024, 1024)));
        let one_pass = format!("split=one-pass block={}", BLOCKS[0]);
        recipe.cell(0, pattern, "one pass", Source::row(pattern, one_pass, figures::ms()));
        for block in BLOCKS {
            let variant = format!("split=two-pass block={block}");
            recipe.cell(0, pattern, format!("two passes, block {block}"), Source::row(pattern, variant, figures::ms()));
        }
        recipe.cell(1, pattern, "best block, px", Source::rows(pattern, NO_BLOCKS, |rows| Some(best(rows)?.0)));
        recipe.cell(
            1,
            pattern,
            "faster than one pass, %",
            Source::rows(pattern, NO_BLOCKS, |rows| Some(best(rows)?.1)),
        );
    }
    recipe
}

/// The paper's sub-buffers have the colour too (sections 4.1, 4.2), 24 bytes a pixel.
pub const SUB_BUFFERS: &str = "--sub-buffer-color on";

/// One pass beside two, over the blocks.
pub fn split_by_block(step: &str, pattern: &str, size: &str) -> Step {
    let blocks = BLOCKS.map(|block| block.to_string()).join(",");
    // The baseline is one pass, which reads no block and is measured once.
    let words = format!(
        "{size} --vpls 256 --pattern {pattern} {SUB_BUFFERS} --sweep split=one-pass,two-pass --sweep block={blocks}"
    );
    Step::bench(step, "split", "hall:triangles=8000", 7, &words)
}

/// Why there may be no best block.
pub const NO_BLOCKS: &str = "no row of two passes was measured";

/// The block with which two passes take least, and by how many per cent one pass takes longer, with the 95 % interval.
pub fn best(rows: &[&BenchRow]) -> Option<(Number, Number)> {
    let two = rows.iter().filter(|row| row.variant.starts_with("split=two-pass"));
    let least = two.min_by(|a, b| median(a).total_cmp(&median(b)))?;
    let block: f64 = least.variant.rsplit_once('=')?.1.parse().ok()?;
    let gain = least.speed_up.as_ref()?.ratio;
    let percent = |times: f64| 100.0 * (times - 1.0);
    Some((
        Number::exact(block),
        Number { value: percent(gain.mean), bounds: gain.interval.map(|ends| ends.map(percent)) },
    ))
}

fn median(row: &BenchRow) -> f64 {
    row.times_ms().map_or(f64::INFINITY, |times| times.median)
}

/// Errors against the picture without interleaving, as rows of our own.
const ERRORS: Published =
    Published { title: "way", unit: "error", columns: &["flip", "rmse", "psnr"], rows: &[], scale: Scale::Itself };

/// Pictures of each way to meet the lights, with close-ups around `middle`, and their errors against all lights on every pixel.
fn qualities(scene: &str, common: &str, middle: [f32; 2], ways: &[(&str, &str, &str)]) -> Recipe {
    let mut recipe = Recipe::default();
    recipe.step(Step::render("reference", "exr", scene, &format!("{common} --split none")));
    recipe.step(Step::render("all", "png", scene, &format!("{common} --split none")));
    recipe.picture("all lights on every pixel", "all.png");
    for (name, title, words) in ways {
        let picture = format!("{name}-picture");
        recipe.step(Step::render(*name, "exr", scene, &format!("{common} {words}")));
        recipe.step(Step::render(&picture, "png", scene, &format!("{common} {words}")));
        recipe.errors(0, title, [&format!("{name}.exr"), "reference.exr"], ERRORS.columns);
        recipe.picture(*title, format!("{picture}.png"));
    }
    let whole: Vec<(String, String)> =
        recipe.pictures.iter().map(|picture| (picture.title.clone(), picture.file.clone())).collect();
    for (title, file) in whole {
        recipe.close_up(format!("{title}, close-up"), file, middle, CLOSE_UP);
    }
    recipe
}

/// Sides of a close-up, in parts of the picture's.
const CLOSE_UP: f32 = 0.15;
/// The middle of the lamp that hangs nearest in the hall's first camera, and of a piece on the chessboard.
const LAMP: [f32; 2] = [0.618, 0.13];
const PIECE: [f32; 2] = [0.557, 0.67];

pub const FIGURE_6: Item = Item {
    name: "figure-6",
    title: "Sub-sampling, interleaving, interleaving with the filter",
    place: "section 5.4",
    published: &[ERRORS],
    verdict: Verdict::ShapeOnly(
        "The paper shows close-ups of a lamp and gives no errors; ours are against the same lights on every pixel.",
    ),
    recipe: Some(figure_6),
};

fn figure_6(effort: Effort) -> Recipe {
    let common = format!("{} --vpls 512 --pattern 4x4", effort.size(1024, 1024));
    qualities(
        "hall",
        &common,
        LAMP,
        &[
            ("subsampled", "(b) sub-sampling", "--split subsample"),
            ("unfiltered", "(c) 4x4 interleaving without a filter", "--filter none --blend-lights all"),
            ("filtered", "(d) 4x4 interleaving with the filter", "--blend-lights all"),
        ],
    )
}

pub const FIGURE_7: Item = Item {
    name: "figure-7",
    title: "Details of surfaces under the filter and under sub-sampling",
    place: "section 5.4",
    published: &[ERRORS],
    verdict: Verdict::ShapeOnly(
        "The paper shows a normal map and gives no errors; ours is a finely tessellated scene, which the paper names beside it. \
         --scene takes one with normal maps.",
    ),
    recipe: Some(figure_7),
};

fn figure_7(effort: Effort) -> Recipe {
    let common = format!("{} --vpls 512 --pattern 4x4", effort.size(1024, 768));
    qualities(
        "chess",
        &common,
        PIECE,
        &[
            ("filtered", "(a) interleaving with the fast blur", "--filter gauss-fast"),
            ("subsampled", "(b) sub-sampling", "--split subsample"),
        ],
    )
}

pub const FIGURE_8: Item = Item {
    name: "figure-8",
    title: "Pictures of many lights with a shadow map each",
    place: "section 6.3",
    published: &[Published {
        title: "scene",
        unit: "s to 1 % RMS",
        columns: &["interleaved", "no interleaving"],
        rows: &[("(a) conference room", &[2.2, 3.8]), ("(b) cruiser", &[4.0, 5.9])],
        scale: Scale::ItsMachine,
    }],
    verdict: Verdict::ShapeOnly(
        "Seconds are of a GeForce 6800 GT; table-5 has the speed-ups. The caption names four pictures and the text has times of two, \
         under letters that the caption gives to other scenes; table 5 says whose they are.",
    ),
    recipe: Some(figure_8),
};

fn figure_8(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let words = format!("{} --vpls {} --pattern 2x2 --vpl-shadow map", effort.size(1280, 1024), effort.pick(1024, 64));
    for (step, scene) in [("office", "office"), ("hall", "hall:triangles=100000")] {
        recipe.step(Step::render(step, "png", scene, &words));
        recipe.picture(scene, format!("{step}.png"));
    }
    recipe
}

const DIRECT: &str = "direct only";
const BOTH: &str = "direct and indirect";

pub const FIGURE_9: Item = Item {
    name: "figure-9",
    title: "Frames with direct light, and with 480 virtual lights beside it",
    place: "section 6.2",
    published: &[Published {
        title: "scene and device",
        unit: "frames/s",
        columns: &[DIRECT, BOTH],
        rows: &[
            ("(a) Q3dm11, 80,000 triangles, 6800 GT", &[35.0, 19.0]),
            ("(a) Q3dm11, 80,000 triangles, 7800 GT", &[69.0, 36.0]),
            ("(b) Buddha in Q3dm12, 200,000 triangles, 6800 GT", &[32.0, 15.0]),
            ("(b) Buddha in Q3dm12, 200,000 triangles, 7800 GT", &[64.0, 29.0]),
            ("(c) dragon in Q3t1, 150,000 triangles, 6800 GT", &[31.0, 15.0]),
            ("(c) dragon in Q3t1, 150,000 triangles, 7800 GT", &[58.0, 29.0]),
        ],
        scale: Scale::PartsOfColumn(DIRECT),
    }],
    verdict: Verdict::ShapeOnly(
        "Frames a second are of two GPUs and of levels of Quake 3; ours are of halls with as many triangles. What carries over is \
         the part of the frame rate that is left with indirect light. Table 4 gives 36 frames/s to Buddha in Q3dm12, not 29.",
    ),
    recipe: Some(figure_9),
};

fn figure_9(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let size = effort.size(1024, 768);
    for (name, step, triangles) in [
        ("(a) Q3dm11, 80,000 triangles", "a", 80_000),
        ("(b) Buddha in Q3dm12, 200,000 triangles", "b", 200_000),
        ("(c) dragon in Q3t1, 150,000 triangles", "c", 150_000),
    ] {
        let scene = format!("hall:triangles={triangles}");
        let interleaved = "--vpls 480 --pattern 8x6 --kernel 5";
        let words = format!(
            "{size} {interleaved} {SUB_BUFFERS} --direct-shadow none --sweep technique=deferred,interleaved_deferred"
        );
        recipe.step(Step::bench(step, "frame", &scene, 5, &words));
        for device in ["6800 GT", "7800 GT"] {
            for (column, technique) in [(DIRECT, "deferred"), (BOTH, "interleaved_deferred")] {
                let source = Source::row(step, format!("technique={technique}"), figures::per_second());
                recipe.cell(0, format!("{name}, {device}"), column, source);
            }
        }
        for (picture, words) in [("direct", "--technique deferred"), ("both", interleaved)] {
            let file = format!("{step}-{picture}");
            recipe.step(Step::render(&file, "png", &scene, &format!("{words} {size} --direct-shadow none")));
            recipe.picture(format!("{name}, {picture}"), format!("{file}.png"));
        }
    }
    recipe
}
