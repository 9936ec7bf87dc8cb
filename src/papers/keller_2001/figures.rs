//! Its figures of patterns, edges and motion.

use crate::bench::row::BenchRow;
use crate::papers::figures;
use crate::papers::item::{Item, Published, Scale, Verdict};
use crate::papers::recipe::{Effort, Recipe, Source, Step};

/// Seeds that a mean is of: one pattern of few samples says little.
const SEEDS: u32 = 64;

pub const FIGURE_1: Item = Item {
    name: "figure-1",
    title: "A pattern of one pixel and one of 2x2 pixels, and their spectra",
    place: "section 2",
    published: &[Published {
        title: "sampler",
        unit: "part of the pixel frequency's energy that comes out as moire",
        columns: &["1x1", "2x2", "1x1 in parts of 2x2"],
        rows: &[],
        scale: Scale::ItsMachine,
    }],
    verdict: Verdict::ShapeOnly(
        "The paper shows spectra without numbers and says that the potential for aliasing falls: ours are means over 64 patterns of the sort \
         that it has (relaxed) and of two others.",
    ),
    recipe: Some(figure_1),
};

fn figure_1(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let seeds = effort.pick(SEEDS, 4);
    for sampler in ["relaxed", "jittered", "random"] {
        let step = |basis: &str, seed: u32| format!("{sampler}-{basis}-{seed}");
        for basis in ["1x1", "2x2"] {
            for seed in 1..=seeds {
                let pattern = format!("basis:basis={basis},samples=4,sampler={sampler},seed={seed}");
                recipe.step(Step::pattern(step(basis, seed), &pattern));
            }
        }
        let energy = |basis: &'static str| {
            let of = move |seed| Source::document(step(basis, seed), "/pixel_frequency/across", 1.0);
            (1..=seeds).map(of).collect::<Vec<_>>()
        };
        for basis in ["1x1", "2x2"] {
            recipe.cell(0, sampler, basis, Source::combined(energy(basis), mean));
        }
        let both = energy("1x1").into_iter().chain(energy("2x2"));
        let ratio = Source::combined(both, |all| mean(&all[..all.len() / 2]) / mean(&all[all.len() / 2..]));
        recipe.cell(0, sampler, "1x1 in parts of 2x2", ratio);
    }
    for (title, basis) in [("(a) a pixel", "1x1"), ("(b) 2x2 pixels", "2x2")] {
        recipe.picture(format!("{title}: samples"), format!("relaxed-{basis}-1.png"));
        recipe.picture(format!("{title}: spectrum"), format!("relaxed-{basis}-1.spectrum.png"));
        let plate = format!("plate-{basis}");
        let words = format!("--technique interleaved_sampling --size 256x256 --basis {basis} --samples 4");
        recipe.step(Step::render(&plate, "png", "zone-plate", &words));
        recipe.picture(format!("{title}: a zone plate"), format!("{plate}.png"));
        let member = format!("member-{basis}");
        let stage = "material.color";
        let words =
            format!("--technique interleaved_sampling --size 128x128 --basis {basis} --samples 4 --aov {stage}");
        recipe.step(Step::render(&member, "png", "cornell", &words));
        recipe.picture(format!("{title}: a member"), format!("{member}.{stage}.png"));
    }
    recipe
}

pub fn mean(all: &[f64]) -> f64 {
    all.iter().sum::<f64>() / all.len() as f64
}

const ERRORS: Published = Published {
    title: "scene and pattern",
    unit: "error",
    columns: &["rmse", "hdr_flip"],
    rows: &[],
    scale: Scale::ItsMachine,
};

/// Pictures of both patterns, and errors against paths, beside a small picture in which no two pixels have the same samples.
fn against_paths(
    recipe: &mut Recipe,
    effort: Effort,
    name: &str,
    scene: &str,
    [size, small]: [[u32; 2]; 2],
    words: &str,
) {
    let common =
        |[width, height]: [u32; 2]| format!("--technique interleaved_sampling {} {words}", effort.size(width, height));
    for (title, basis) in [("the same samples in every pixel", "1x1"), ("interleaved, 2x2", "2x2")] {
        let picture = format!("{name}-{basis}");
        recipe.step(Step::render(&picture, "png", scene, &format!("{} --basis {basis} --exposure auto", common(size))));
        recipe.picture(format!("{name}, {title}"), format!("{picture}.png"));
    }
    let judged = format!("--reference auto --reference-spp {}", effort.pick(1024, 64));
    for (step, at, sampler, bases) in [
        (format!("{name}-errors"), size, "", ["1x1", "2x2", "4x4"]),
        (format!("{name}-small-errors"), small, "--sampler random", ["1x1", "2x2", "frame"]),
    ] {
        let words = format!("{} {sampler} {judged} --sweep basis={}", common(at), bases.join(","));
        recipe.step(Step::bench(&step, "frame", scene, 1, &words));
        for basis in bases {
            let row = match sampler {
                "" => format!("{name}, {basis}"),
                _ => format!("{name}, small, random samples, {basis}"),
            };
            let variant = || format!("basis={basis}");
            let rmse = |row: &BenchRow| Some(row.errors.as_ref()?.metrics.rmse);
            let flip = |row: &BenchRow| Some(row.errors.as_ref()?.metrics.hdr_flip);
            recipe.cell(0, &row, "rmse", Source::row(&step, variant(), figures::exact(rmse)));
            recipe.cell(0, &row, "hdr_flip", Source::row(&step, variant(), figures::exact(flip)));
        }
    }
}

pub const FIGURE_2: Item = Item {
    name: "figure-2",
    title: "Edges under 4 samples a pixel",
    place: "section 3.1",
    published: &[ERRORS],
    verdict: Verdict::ShapeOnly(
        "The paper shows two pictures without numbers and says that the interleaved one is more pleasing to see: errors of ours are against \
         paths, and hardly differ, because the same error lies elsewhere.",
    ),
    recipe: Some(figure_2),
};

fn figure_2(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let sizes = [[160, 90], [64, 36]];
    let edges = "--samples 4 --brdf lambert";
    against_paths(&mut recipe, effort, "fence", "fence", sizes, &format!("{edges} --direct-shadow none"));
    against_paths(
        &mut recipe,
        effort,
        "chess",
        "chess:triangles=12000",
        sizes,
        &format!("{edges} --direct-shadow ray"),
    );
    against_paths(&mut recipe, effort, "plate", "zone-plate", [[128, 128], [64, 64]], "--samples 4");
    recipe
}

pub const FIGURE_4: Item = Item {
    name: "figure-4",
    title: "What moves, under 16 samples a pixel",
    place: "section 3.2",
    published: &[ERRORS],
    verdict: Verdict::ShapeOnly("The paper shows three pictures without numbers; errors of ours are against paths."),
    recipe: Some(figure_4),
};

fn figure_4(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let words = "--samples 16 --effect aa,motion --shutter 0,0.6 --direct-shadow ray --brdf lambert";
    against_paths(&mut recipe, effort, "chess", "chess:triangles=12000", [[96, 54], [32, 18]], words);
    recipe
}
