//! Its figures against other ways to shade, its filter, and two eyes.

use super::figures::reference;
use super::scenes::{SPONZA, UNLIT, blurred, frames, judged, pictures};
use crate::bench::row::BenchRow;
use crate::papers::figures;
use crate::papers::item::{ABSENT, Item, Published, Scale, Verdict};
use crate::papers::recipe::{Effort, Number, Recipe, Source, Step};

const EXECUTIONS: &str = "executions a pixel";

pub const FIGURE_8: Item = Item {
    name: "figure-8",
    title: "Lists beside multisampling and beside every sample",
    place: "section 6.2",
    published: &[
        Published {
            title: "ARENA, multisampling over lists",
            unit: "times the time",
            columns: &["GPU B"],
            rows: &[("lists of stochastic samples", &[2.20]), ("lists of interleaved samples", &[3.18])],
            scale: Scale::Itself,
        },
        Published {
            title: "scene and way",
            unit: EXECUTIONS,
            columns: &[EXECUTIONS],
            rows: &[],
            scale: Scale::ItsMachine,
        },
        Published { title: "scene and way", unit: "ms", columns: &["frame"], rows: &[], scale: Scale::ItsMachine },
    ],
    verdict: Verdict::ShapeOnly(
        "Times are of an R9 290. The bars' values are not in the text; for every sample it says close to 3 seconds a frame of ARENA. Frames \
         here have shadow maps that are drawn once, and no reconstruction, as there. Lists are shaded by fragments, as there; by \
         compute, which is the default here, they are measured beside it.",
    ),
    recipe: Some(figure_8),
};

/// Row, visibility, what is shaded, and by what. Multisampling of frames drawn tuple by tuple is refused: the sweep leaves it out, and
/// so it does fragments where there are no lists.
const WAYS_TO_SHADE: [(&str, &str, &str, &str); 7] = [
    ("lists, stochastic", "stochastic", "deep", "fragment"),
    ("lists shaded by compute, stochastic", "stochastic", "deep", "compute"),
    ("multisampling, stochastic", "stochastic", "msaa", "compute"),
    ("every sample, stochastic", "stochastic", "ssaa", "compute"),
    ("lists, interleaved", "repeat-frame", "deep", "fragment"),
    ("lists shaded by compute, interleaved", "repeat-frame", "deep", "compute"),
    ("every sample, interleaved", "repeat-frame", "ssaa", "compute"),
];

fn variant(visibility: &str, shading: &str, shade_by: &str) -> String {
    format!("visibility={visibility} shading={shading} shade-by={shade_by}")
}

fn figure_8(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    for (name, scene, blur) in blurred(effort) {
        let step = format!("{name}-frames");
        let words = format!(
            "{} {blur} --instrument off --direct-shadow map --shadow-maps once \
             --sweep visibility=stochastic,repeat-frame --sweep shading=deep,msaa,ssaa --sweep shade-by=fragment,compute",
            pictures(effort)
        );
        recipe.step(Step::bench(&step, "frame", scene, 5, &words));
        for (way, visibility, shading, shade_by) in WAYS_TO_SHADE {
            let row = format!("{name}, {way}");
            let source = Source::row(&step, variant(visibility, shading, shade_by), figures::ms());
            recipe.cell(2, &row, "frame", source);
            // Whatever shades them, executions are the same.
            if (shading, shade_by) == ("deep", "compute") {
                continue;
            }
            let count = format!("{name}-{visibility}-{shading}");
            let words = format!("{} {blur} {UNLIT} --visibility {visibility} --shading {shading}", pictures(effort));
            recipe.step(Step::render(&count, "png", scene, &words));
            recipe.cell(1, &row, EXECUTIONS, Source::counter(&count, "shaded_per_pixel"));
        }
        let first = |text: &str| if name == "ARENA" { text.to_owned() } else { format!("{name}, {text}") };
        for (kind, visibility) in [("stochastic", "stochastic"), ("interleaved", "repeat-frame")] {
            for (suffix, shade_by) in [("", "fragment"), (", shaded by compute", "compute")] {
                let source = Source::rows(&step, "one of both was not measured", move |rows| {
                    multisampling_over(rows, visibility, shade_by)
                });
                recipe.cell(0, first(&format!("lists of {kind} samples{suffix}")), "GPU B", source);
            }
        }
    }
    recipe
}

/// Time of multisampling in parts of that of lists.
fn multisampling_over(rows: &[&BenchRow], visibility: &str, shade_by: &str) -> Option<Number> {
    let median = |variant: String| Some(rows.iter().rev().find(|row| row.variant == variant)?.times_ms()?.median);
    let deep = median(variant(visibility, "deep", shade_by))?;
    Some(Number::exact(median(variant("stochastic", "msaa", "compute"))? / deep))
}

pub const FIGURE_9: Item = Item {
    name: "figure-9",
    title: "Lists beside a texture of each draw",
    place: "section 6.2",
    published: &[
        Published {
            title: "CHESS, textures over lists",
            unit: "times the time",
            columns: &["least of three GPUs", "GPU B", "greatest of three GPUs"],
            rows: &[("stochastic", &[0.93, 1.65, 2.45])],
            scale: Scale::Itself,
        },
        Published {
            title: "way",
            unit: "number",
            columns: &[EXECUTIONS, "rmse", "hdr_flip"],
            rows: &[],
            scale: Scale::ItsMachine,
        },
    ],
    verdict: Verdict::ShapeOnly(
        "Times are of three GPUs, and of the authors' own game of chess; ours has as many triangles, draws and lights. Errors are ours, \
         against 1024 samples.",
    ),
    recipe: Some(figure_9),
};

fn figure_9(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let blur = "--shutter 0,0.04 --aperture 0.01";
    let common = format!("{} {blur}", frames(effort));
    let words = format!(
        "{common} --spp 8 --tuples 32 --instrument off --visibility stochastic --sweep shading=deep,texture-space,ssaa"
    );
    recipe.step(Step::bench("frames", "frame", "chess", 5, &words));
    for column in FIGURE_9.published[0].columns {
        let source = Source::row("frames", "shading=texture-space", figures::times_the_baseline());
        recipe.cell(0, "stochastic", *column, source);
    }
    recipe.step(Step::render("reference", "exr", "chess", &format!("{common} {}", reference(effort))));
    for (row, step, words) in [
        ("lists", "lists", ""),
        ("textures, a texel a pixel", "textures", "--shading texture-space"),
        ("textures, four texels a pixel", "textures-fine", "--shading texture-space --shading-scale 2"),
        ("every sample", "ssaa", "--shading ssaa"),
    ] {
        judge(&mut recipe, 1, row, step, "chess", &format!("{common} --spp 8 {words}"), "reference");
        recipe.cell(1, row, EXECUTIONS, Source::counter(step, "shaded_per_pixel"));
    }
    recipe
}

/// A picture, and its errors as cells of a row.
fn judge(recipe: &mut Recipe, table: usize, row: &str, step: &str, scene: &str, words: &str, reference: &str) {
    recipe.step(Step::render(step, "exr", scene, words));
    recipe.errors(table, row, [&format!("{step}.exr"), &format!("{reference}.exr")], &["rmse", "hdr_flip"]);
}

const ERRORS: Published = Published {
    title: "scene and samples",
    unit: "error",
    columns: &["rmse", "hdr_flip"],
    rows: &[],
    scale: Scale::ItsMachine,
};

pub const FIGURE_10: Item = Item {
    name: "figure-10",
    title: "Stochastic and interleaved samples, and what the filter makes of them",
    place: "section 6.3",
    published: &[ERRORS],
    verdict: Verdict::ShapeOnly(
        "The paper shows pictures and says that 16 tuples leave artefacts, that 32 are good and that extremes take 64. The filter is ours: the \
         paper's is not in its text. Errors are against 1024 samples.",
    ),
    recipe: Some(figure_10),
};

fn figure_10(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let common = format!("{} --aperture 0.6 --focus 5", frames(effort));
    recipe.step(Step::render("reference", "exr", SPONZA, &format!("{common} {}", reference(effort))));
    for (row, step, words) in [
        ("stochastic", "stochastic", "--visibility stochastic"),
        ("16 tuples", "16", "--tuples 16"),
        ("32 tuples", "32", "--tuples 32"),
        ("64 tuples", "64", "--tuples 64"),
        ("128 tuples", "128", "--tuples 128"),
    ] {
        for (suffix, more) in [("", "--reconstruct off"), ("-reconstructed", "--reconstruct on")] {
            let row = format!("{row}{}", if suffix.is_empty() { "" } else { ", reconstructed" });
            let words = format!("{common} --spp 8 {words} {more}");
            judge(&mut recipe, 0, &row, &format!("{step}{suffix}"), SPONZA, &words, "reference");
        }
    }
    for (title, step, words) in [
        ("stochastic", "picture-stochastic", "--visibility stochastic --reconstruct off"),
        ("interleaved, 32 tuples", "picture-interleaved", "--tuples 32 --reconstruct off"),
        ("interleaved and reconstructed", "picture-reconstructed", "--tuples 32 --reconstruct on"),
    ] {
        recipe.step(Step::render(step, "png", SPONZA, &format!("{common} --spp 8 {words}")));
        recipe.picture(title, format!("{step}.png"));
    }
    recipe
}

const APERTURES: [&str; 6] = ["0", "0.02", "0.05", "0.1", "0.2", "0.4"];

pub const FIGURE_11: Item = Item {
    name: "figure-11",
    title: "Time of visibility by the aperture, and where stochastic rasterisation comes to take longer",
    place: "section 6.3",
    published: &[
        Published {
            title: "aperture, m",
            unit: "ms",
            columns: &["interleaved", "stochastic, full test", "stochastic, reduced test"],
            rows: &[],
            scale: Scale::PartsOfColumn("interleaved"),
        },
        Published {
            title: "stochastic takes longer from",
            unit: "aperture (the paper: units of its scene; ours: m)",
            columns: &["ARENA"],
            rows: &[
                ("full test", &[ABSENT]),
                ("reduced test", &[ABSENT]),
                ("the paper, of apertures up to 900", &[150.0]),
            ],
            scale: Scale::ItsMachine,
        },
    ],
    verdict: Verdict::ShapeOnly(
        "The graph is not in the paper's text, which says that the times cross at about 150 units of ARENA. On a software driver the stochastic \
         test may take longer from the first aperture on.",
    ),
    recipe: Some(figure_11),
};

fn figure_11(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let words = format!(
        "{} --spp 8 --tuples 32 --instrument off --camera flight --time 10 {UNLIT} --sweep visibility=repeat-frame,stochastic \
         --sweep coverage-test=reduced,full --sweep aperture={}",
        frames(effort),
        APERTURES.join(",")
    );
    recipe.step(Step::bench("visibility", "visibility", "arena", 5, &words));
    for aperture in APERTURES {
        for (column, way) in [
            ("interleaved", "visibility=repeat-frame coverage-test=reduced"),
            ("stochastic, full test", "visibility=stochastic coverage-test=full"),
            ("stochastic, reduced test", "visibility=stochastic coverage-test=reduced"),
        ] {
            let source = Source::row("visibility", format!("{way} aperture={aperture}"), figures::ms());
            recipe.cell(0, aperture, column, source);
        }
    }
    for (row, test) in [("full test", "full"), ("reduced test", "reduced")] {
        recipe.cell(
            1,
            row,
            "ARENA",
            Source::rows(
                "visibility",
                "up to the greatest aperture stochastic rasterisation takes less",
                move |rows| crossing(rows, test),
            ),
        );
    }
    recipe
}

/// The aperture at which straight lines between the measured ones meet; 0 where the first is slower already, None where none is.
fn crossing(rows: &[&BenchRow], test: &str) -> Option<Number> {
    let median = |variant: String| Some(rows.iter().rev().find(|row| row.variant == variant)?.times_ms()?.median);
    let mut before: Option<(f64, f64)> = None;
    for text in APERTURES {
        let interleaved = median(format!("visibility=repeat-frame coverage-test=reduced aperture={text}"))?;
        let over = median(format!("visibility=stochastic coverage-test={test} aperture={text}"))? - interleaved;
        let aperture: f64 = text.parse().ok()?;
        if over > 0.0 {
            let meets = |(at, under): (f64, f64)| at + (aperture - at) * -under / (over - under);
            return Some(Number::exact(before.map_or(0.0, meets)));
        }
        before = Some((aperture, over));
    }
    None
}

pub const SECTION_4_5: Item = Item {
    name: "section-4.5",
    title: "Errors of 8 samples with the reconstruction, and of more without it",
    place: "section 4.5",
    published: &[ERRORS],
    verdict: Verdict::ShapeOnly(
        "The paper gives no errors and not its filter: both are ours. Its text says that 64 to 256 samples are noise-free without it.",
    ),
    recipe: Some(section_4_5),
};

fn section_4_5(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    for (name, scene, blur) in judged() {
        let common = format!("{} {blur}", frames(effort));
        let whole = format!("{name}-reference");
        recipe.step(Step::render(&whole, "exr", scene, &format!("{common} {}", reference(effort))));
        for (row, step, words) in [
            ("8 samples, reconstructed", "8-reconstructed", "--reconstruct on"),
            ("8 samples", "8", "--reconstruct off"),
            ("8 samples, stochastic, reconstructed", "8-stochastic", "--visibility stochastic --reconstruct on"),
            ("64 samples", "64", "--reconstruct off --accumulate 8"),
            ("256 samples", "256", "--reconstruct off --accumulate 32"),
        ] {
            // The most by far.
            if effort.is_quick && step == "256" {
                continue;
            }
            let words = format!("{common} --spp 8 --instrument off {words}");
            judge(&mut recipe, 0, &format!("{name}, {row}"), &format!("{name}-{step}"), scene, &words, &whole);
        }
    }
    recipe
}

pub const SECTION_7: Item = Item {
    name: "section-7",
    title: "Two eyes that share one buffer",
    place: "section 7",
    published: &[Published {
        title: "scene, eyes 65 mm apart",
        unit: "executions a pixel of one eye",
        columns: &["both at once", "left alone", "right alone", "both at once, in parts of each alone"],
        rows: &[],
        scale: Scale::ItsMachine,
    }],
    verdict: Verdict::ShapeOnly("The paper names it as future work, without numbers."),
    recipe: Some(section_7),
};

fn section_7(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    for (name, scene, blur) in
        [("chess", "chess", ""), ("hall", SPONZA, ""), ("hall, blurred", SPONZA, "--aperture 0.1")]
    {
        let stem = name.replace(", ", "-");
        let step = |eyes: &str| format!("{stem}-{eyes}");
        for (column, eyes) in [("both at once", "both"), ("left alone", "left"), ("right alone", "right")] {
            let words = format!("{} --stereo 0.065 --stereo-eyes {eyes} {blur}", pictures(effort));
            recipe.step(Step::render(step(eyes), "png", scene, &words));
            recipe.cell(0, name, column, Source::counter(step(eyes), "shaded_per_pixel"));
        }
        let rates = ["both", "left", "right"].map(|eyes| Source::counter(step(eyes), "shaded_per_pixel"));
        let part = Source::combined(rates, |rates| rates[0] / (rates[1] + rates[2]));
        recipe.cell(0, name, "both at once, in parts of each alone", part);
    }
    recipe
}
