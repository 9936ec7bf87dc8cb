//! Its figures and sections that say how good pictures are.

use crate::papers::figures;
use crate::papers::item::{Item, Published, Scale, Verdict};
use crate::papers::recipe::{Effort, Recipe, Source, Step};

const ERRORS: Published = Published {
    title: "against forward with 64 samples",
    unit: "error",
    columns: &["flip", "rmse"],
    rows: &[],
    scale: Scale::ItsMachine,
};

/// What a reference is made by.
const SUPERSAMPLED: &str = "--technique forward --supersample 8";

/// A picture of `words`, and its errors as cells of a row.
fn judge(recipe: &mut Recipe, table: usize, row: &str, step: &str, scene: &str, words: &str, reference: &str) {
    recipe.step(Step::render(step, "exr", scene, words));
    recipe.errors(table, row, [&format!("{step}.exr"), &format!("{reference}.exr")], &["flip", "rmse"]);
}

/// A light buffer of the paper's 800x450 for 1280x720.
fn light_size(effort: Effort) -> String {
    let [width, height] = effort.pick([800, 450], [200, 113]);
    format!("{width}x{height}")
}

fn full_size(effort: Effort) -> String {
    effort.size(1280, 720).replace("--size ", "")
}

pub const FIGURE_3: Item = Item {
    name: "figure-3",
    title: "A small light buffer without the discontinuity sensitive filter, and with it",
    place: "section 3",
    published: &[ERRORS],
    verdict: Verdict::ShapeOnly(
        "The paper shows crops and gives no numbers. Errors are ours, of all filters here on one light buffer, Lambert, 4 samples a pixel of \
         the paper's 8; full is a light buffer of the picture's size.",
    ),
    recipe: Some(figure_3),
};

fn figure_3(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let size = effort.size(1280, 720);
    for (name, scene) in [("lamps", "lamps"), ("fence", "fence"), ("hall", "hall")] {
        let common = format!("{size} --brdf lambert");
        let reference = format!("{name}-forward");
        recipe.step(Step::render(&reference, "exr", scene, &format!("{SUPERSAMPLED} {common}")));
        let inferred = format!("--technique inferred_lighting {common} --msaa 4");
        for filter in ["dsf", "bilinear", "nearest", "bilateral", "discontinuity"] {
            let words = format!("{inferred} --light-filter {filter}");
            judge(&mut recipe, 0, &format!("{name}, {filter}"), &format!("{name}-{filter}"), scene, &words, &reference);
        }
        let words = format!("{inferred} --light-size {}", full_size(effort));
        judge(&mut recipe, 0, &format!("{name}, full"), &format!("{name}-full"), scene, &words, &reference);
    }
    for (title, filter) in [("(top) bilinear", "bilinear"), ("(bottom) discontinuity sensitive", "dsf")] {
        let words = format!("--technique inferred_lighting {size} --light-filter {filter}");
        recipe.step(Step::render(filter, "png", "lamps", &words));
        recipe.picture(title, format!("{filter}.png"));
    }
    recipe
}

const SMALL: &str = "800x450, with the filter";
const LARGE: &str = "1280x720, without";

pub const FIGURE_9: Item = Item {
    name: "figure-9",
    title: "122 lights: a small light buffer with the filter, and a full one without",
    place: "section 6",
    published: &[
        Published {
            title: "light buffer",
            unit: "ms",
            columns: &["GeForce 8800 GTX"],
            rows: &[(LARGE, &[32.0]), (SMALL, &[25.0])],
            scale: Scale::PartsOfRow(LARGE),
        },
        ERRORS,
    ],
    verdict: Verdict::ShapeOnly(
        "Times are of a GPU of 2006, with 8 samples a pixel; ours are with 4 of another scene with as many lights. The full buffer's picture has its \
         glass tested by alpha, as there, in its last row.",
    ),
    recipe: Some(figure_9),
};

fn figure_9(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let (size, small, full) = (effort.size(1280, 720), light_size(effort), full_size(effort));
    for (suffix, volumes) in [("", "both"), (", lists of lights for tiles", "tiled")] {
        let step = format!("sizes-{volumes}");
        let words = format!(
            "--technique inferred_lighting {size} --msaa 4 --volumes {volumes} --sweep light-size={full},{small} \
             --sweep light-filter=bilinear,dsf"
        );
        recipe.step(Step::bench(&step, "frame", "fence", 7, &words));
        for (row, at, filter) in [
            (LARGE, &full, "bilinear"),
            (SMALL, &small, "dsf"),
            ("800x450, without", &small, "bilinear"),
            ("1280x720, with the filter", &full, "dsf"),
        ] {
            let variant = format!("light-size={at} light-filter={filter}");
            let source = Source::row(&step, variant, figures::ms());
            recipe.cell(0, format!("{row}{suffix}"), "GeForce 8800 GTX", source);
        }
    }
    for brdf in ["lambert", "ggx"] {
        let common = format!("{size} --brdf {brdf}");
        let reference = format!("{brdf}-forward");
        recipe.step(Step::render(&reference, "exr", "fence", &format!("{SUPERSAMPLED} {common}")));
        for (name, row, words) in [
            ("small", "800x450, with the filter", format!("--light-size {small}")),
            ("small-bilinear", "800x450, without", format!("--light-size {small} --light-filter bilinear")),
            ("full", "1280x720, with the filter", format!("--light-size {full}")),
            ("full-bilinear", "1280x720, without", format!("--light-size {full} --light-filter bilinear")),
            (
                "full-tested",
                "1280x720, without, glass tested by alpha",
                format!("--light-size {full} --light-filter bilinear --alpha test"),
            ),
        ] {
            let words = format!("--technique inferred_lighting {common} --msaa 4 {words}");
            judge(&mut recipe, 1, &format!("{brdf}, {row}"), &format!("{brdf}-{name}"), "fence", &words, &reference);
        }
    }
    for (title, step, words) in [
        ("(top) 800x450 with the filter", "top", format!("--light-size {small}")),
        ("(bottom) 1280x720 without", "bottom", format!("--light-size {full} --light-filter bilinear --alpha test")),
    ] {
        recipe.step(Step::render(
            step,
            "png",
            "fence",
            &format!("--technique inferred_lighting {size} --msaa 4 {words}"),
        ));
        recipe.picture(title, format!("{step}.png"));
    }
    recipe
}

pub const SECTION_3: Item = Item {
    name: "section-3",
    title: "What shading once a pixel costs in the picture, and each sample in time",
    place: "section 3",
    published: &[
        ERRORS,
        Published {
            title: "scene and way",
            unit: "ms",
            columns: &["once a pixel"],
            rows: &[],
            scale: Scale::PartsOfColumn("once a pixel"),
        },
    ],
    verdict: Verdict::ShapeOnly(
        "The paper says that artefacts below a pixel typically are not noticeable, without numbers; ours are of 4 samples.",
    ),
    recipe: Some(section_3),
};

fn section_3(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let size = effort.size(1280, 720);
    for scene in ["lamps", "hall", "fence"] {
        let reference = format!("{scene}-places");
        recipe.step(Step::render(&reference, "exr", scene, &format!("{SUPERSAMPLED} {size}")));
        for technique in ["forward", "inferred_lighting"] {
            for (row, shaded) in [("once a pixel", "off"), ("each sample", "on")] {
                let words = format!("--technique {technique} --msaa 4 --sample-shading {shaded} {size}");
                let step = format!("{scene}-{technique}-{shaded}");
                judge(&mut recipe, 0, &format!("{scene}, {technique}, {row}"), &step, scene, &words, &reference);
            }
            let step = format!("{scene}-{technique}-frames");
            let words = format!("{size} --msaa 4 --technique {technique} --sweep sample-shading=off,on");
            recipe.step(Step::bench(&step, "frame", scene, 7, &words));
            for (column, shaded) in [("once a pixel", "off"), ("each sample", "on")] {
                let source = Source::row(&step, format!("sample-shading={shaded}"), figures::ms());
                recipe.cell(1, format!("{scene}, {technique}"), column, source);
            }
        }
    }
    recipe
}
