//! Its figures, and what its text says without numbers.

use super::tables::{LIT, size};
use crate::papers::figures;
use crate::papers::item::{Item, Published, Scale, Verdict};
use crate::papers::recipe::{Effort, Recipe, Source, Step};

pub const FIGURE_1: Item = Item {
    name: "figure-1",
    title: "An office by adaptive interleaved sampling",
    place: "page 2117",
    published: &[],
    verdict: Verdict::NotHere("It is one of the pictures of figure 6, which are made by figure-6."),
    recipe: None,
};

pub const FIGURE_2: Item = Item {
    name: "figure-2",
    title: "The steps of the algorithm",
    place: "section 3",
    published: &[],
    verdict: Verdict::NotHere(
        "It is a drawing of steps, without numbers; `render --profile --technique adaptive_interleaved` lists the passes in its order.",
    ),
    recipe: None,
};

pub const FIGURES_3_TO_5: Item = Item {
    name: "figures-3-to-5",
    title: "Which tiles each component refines",
    place: "section 3",
    published: &[],
    verdict: Verdict::ShapeOnly("Pictures of the same guidance, of other scenes: blue is not refined, red the most."),
    recipe: Some(guidance),
};

fn guidance(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    for (step, scene, stages) in [
        ("office", "office", &["guidance.id", "guidance.ss"][..]),
        ("desk", "desk", &["guidance.id", "guidance.ss"]),
        ("smoke", "office:smoke=on", &["guidance.pm"]),
    ] {
        let words = format!("{LIT} {} --exposure auto --aov {}", size(effort), stages.join(","));
        recipe.step(Step::render(step, "png", scene, &words));
        recipe.picture(step, format!("{step}.png"));
        for stage in stages {
            recipe.picture(format!("{step}, {stage}"), format!("{step}.{stage}.png"));
        }
    }
    recipe
}

/// Pictures of scenes.
fn pictures(effort: Effort, scenes: &[(&str, &str, &str)]) -> Recipe {
    let mut recipe = Recipe::default();
    for (step, scene, words) in scenes {
        recipe.step(Step::render(*step, "png", scene, &format!("{LIT} {} {words} --exposure auto", size(effort))));
        recipe.picture(*step, format!("{step}.png"));
    }
    recipe
}

pub const FIGURE_6: Item = Item {
    name: "figure-6",
    title: "The test scenes",
    place: "section 4.2",
    published: &[],
    verdict: Verdict::ShapeOnly(
        "The paper's scenes are of others; these are built in, under its names where they stand for them.",
    ),
    recipe: Some(figure_6),
};

fn figure_6(effort: Effort) -> Recipe {
    let scenes = [
        ("cornell", "cornell", ""),
        ("office", "office", ""),
        ("desk", "desk", ""),
        ("shirley", "shirley", ""),
        ("hall", "hall:triangles=8000", ""),
    ];
    pictures(effort, &scenes)
}

pub const FIGURE_7: Item = Item {
    name: "figure-7",
    title: "The test scenes with participating media",
    place: "section 4.2",
    published: &[],
    verdict: Verdict::ShapeOnly("The paper's scenes are of others; these are built in."),
    recipe: Some(figure_7),
};

fn figure_7(effort: Effort) -> Recipe {
    let scenes = [
        ("office", "office:smoke=on", ""),
        ("shirley", "shirley", "--medium 0.1,0.02,0.3"),
        ("cornell", "cornell", "--medium 0.1,0.02,0.3"),
    ];
    pictures(effort, &scenes)
}

pub const FIGURE_8: Item = Item {
    name: "figure-8",
    title: "An office by every renderer, beside paths",
    place: "section 4.2.1, page 2128",
    published: &[Published {
        title: "against paths",
        unit: "error",
        columns: &["hdr_flip", "rmse", "over_threshold"],
        rows: &[],
        scale: Scale::ItsMachine,
    }],
    verdict: Verdict::ShapeOnly(
        "The paper shows maps of differences by HDR-VDP; errors of ours are by HDR-FLIP and RMSE.",
    ),
    recipe: Some(figure_8),
};

fn figure_8(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let paths = format!(
        "--technique path_traced --transport one-bounce --brdf lambert --ambient-visibility off {} --spp {}",
        size(effort),
        effort.pick(2500, 64)
    );
    recipe.step(Step::render("paths", "exr", "office", &paths));
    recipe.step(Step::render("paths-picture", "png", "office", &format!("{paths} --exposure auto")));
    recipe.picture("paths", "paths-picture.png");
    for mode in ["adaptive", "max", "igi"] {
        let picture = format!("{mode}-picture");
        let words = format!("{LIT} {} --mode {mode}", size(effort));
        recipe.step(Step::render(mode, "exr", "office", &words));
        recipe.step(Step::render(&picture, "png", "office", &format!("{words} --exposure auto")));
        recipe.errors(0, mode, [&format!("{mode}.exr"), "paths.exr"], &["hdr_flip", "rmse", "over_threshold"]);
        recipe.picture(mode, format!("{picture}.png"));
        recipe.picture(format!("{mode}, its difference from paths"), format!("{mode}-errors.png"));
    }
    recipe
}

pub const FAILURES: Item = Item {
    name: "sections-3.2-to-3.4",
    title: "Where guidance fails, beside places where it holds",
    place: "sections 3.2 to 3.4",
    published: &[Published {
        title: "place",
        unit: "number",
        columns: &["rays a pixel", "part of the tiles that are refined"],
        rows: &[],
        scale: Scale::ItsMachine,
    }],
    verdict: Verdict::ShapeOnly(
        "The paper names the cases without numbers: virtual lights at one end of a concave place, large penumbrae, shadows in smoke that overlap.",
    ),
    recipe: Some(failures),
};

fn failures(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    for (row, step, scene, component, words) in [
        ("3.2, a long nave with pillars", "concave", "hall:triangles=8000", "id", ""),
        ("3.2, a plain room", "plain-id", "cornell", "id", ""),
        ("3.3, a penumbra that is most of the picture", "penumbra", "cornell", "ss", "--light-radius 0.5"),
        ("3.3, a small light", "plain-ss", "cornell", "ss", "--light-radius 0.02"),
        ("3.4, shadows in smoke that overlap", "volumes", "office:smoke=on", "pm", ""),
        ("3.4, smoke in an empty part of a room", "plain-pm", "cornell", "pm", "--medium 0.1,0.02,0.3"),
    ] {
        let words = format!(
            "{LIT} {} --components {component} {words} --exposure auto --aov guidance.{component}",
            size(effort)
        );
        recipe.step(Step::render(step, "png", scene, &words));
        recipe.cell(0, row, "rays a pixel", Source::counter(step, "rays"));
        let refined = Source::counter(step, &format!("tiles_refined_{component}"));
        recipe.cell(0, row, "part of the tiles that are refined", refined);
        recipe.picture(row, format!("{step}.guidance.{component}.png"));
    }
    recipe
}

pub const FLICKER: Item = Item {
    name: "section-4.1",
    title: "How much a still picture of a moving light jumps",
    place: "section 4.1, page 2125",
    published: &[Published {
        title: "scale of indirect light and mode",
        unit: "part of the mean luminance",
        columns: &["flicker"],
        rows: &[],
        scale: Scale::ItsMachine,
    }],
    verdict: Verdict::ShapeOnly(
        "The paper says that adaptive sampling takes care of flicker that a small subset of lights leads to, without numbers.",
    ),
    recipe: Some(flicker),
};

fn flicker(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let words = format!(
        "--technique adaptive_interleaved --animation lamp --components id {} --frames 0..{} --sweep mode=adaptive,igi \
         --sweep id-scale=1,2",
        effort.size(160, 120),
        effort.pick(23, 5)
    );
    recipe.step(Step::bench("flicker", "frame", "cornell:motion=on", 1, &words));
    for (scale, mode) in [(1, "adaptive"), (1, "igi"), (2, "adaptive"), (2, "igi")] {
        let variant = format!("mode={mode} id-scale={scale}");
        recipe.cell(0, format!("{scale}, {mode}"), "flicker", Source::row("flicker", variant, figures::flicker()));
    }
    recipe
}
