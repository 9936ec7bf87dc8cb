//! Numbers that stand in its text alone.

use super::figures::{NO_BLOCKS, SUB_BUFFERS, best, split_by_block};
use super::tables::pass_ms;
use crate::bench::row::BenchRow;
use crate::papers::figures;
use crate::papers::item::{ABSENT, Item, Published, Scale, Verdict};
use crate::papers::recipe::{Effort, Number, Recipe, Source, Step};

pub const SECTION_5_1: Item = Item {
    name: "section-5.1",
    title: "Two passes with a tuned block beside one, large pictures and patterns",
    place: "section 5.1",
    published: &[Published {
        title: "pattern",
        unit: "times as fast",
        columns: &["two passes with the best block, over one (the paper: more than)"],
        rows: &[("8x8", &[3.0])],
        scale: Scale::Itself,
    }],
    verdict: Verdict::ShapeOnly(
        "The gain comes from the texture cache of a GeForce 6800 GT. The paper says which resolution, and of the patterns only \
         that they are large.",
    ),
    recipe: Some(section_5_1),
};

fn section_5_1(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let column = SECTION_5_1.published[0].columns[0];
    for pattern in ["8x8", "16x16"] {
        recipe.step(split_by_block(pattern, pattern, &effort.size(1280, 1024)));
        recipe.cell(0, pattern, column, Source::rows(pattern, NO_BLOCKS, |rows| Some(as_times(best(rows)?.1))));
    }
    recipe
}

fn as_times(percent: Number) -> Number {
    let times = |percent: f64| 1.0 + percent / 100.0;
    Number { value: times(percent.value), bounds: percent.bounds.map(|ends| ends.map(times)) }
}

pub const SECTION_5_3: Item = Item {
    name: "section-5.3",
    title: "The gather beside the split",
    place: "section 5.3",
    published: &[Published {
        title: "by",
        unit: "% faster",
        columns: &["gather"],
        rows: &[("the text", &[40.0])],
        scale: Scale::ItsMachine,
    }],
    verdict: Verdict::ShapeOnly(
        "The text says 40 %; the times of table 3 give more, which is computed from them here. The gather moves one buffer of half \
         floats in place of the G-buffer.",
    ),
    recipe: Some(section_5_3),
};

fn section_5_3(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    recipe.cell(0, "table 3, 6800 GT (computed)", "gather", Source::Computed(faster("6800 GT")));
    recipe.cell(0, "table 3, 7800 GT (computed)", "gather", Source::Computed(faster("7800 GT")));
    let words = format!("{} --vpls 64 --pattern 4x4 --split two-pass {SUB_BUFFERS}", effort.size(1024, 1024));
    recipe.step(Step::bench("frame", "frame", "hall:triangles=8000", 7, &words));
    recipe.cell(
        0,
        "this device",
        "gather",
        Source::rows("frame", "the row has no times of passes", |rows| gather_of(rows.last()?)),
    );
    recipe
}

/// By how many per cent the gather takes less than the split.
fn faster(gpu: &str) -> f64 {
    100.0 * (1.0 - pass_ms(gpu, "BG") / pass_ms(gpu, "BS"))
}

fn gather_of(row: &BenchRow) -> Option<Number> {
    let ms = |passes| (figures::passes_ms_per_megapixel(passes).read)(row);
    Some(Number::exact(100.0 * (1.0 - ms(&["gather"])?.value / ms(&["split"])?.value)))
}

pub const SECTION_5_4: Item = Item {
    name: "section-5.4",
    title: "A walk of the blur that branches, beside one with a flag",
    place: "section 5.4",
    published: &[Published {
        title: "taps",
        unit: "ms",
        columns: &["flag", "branch"],
        rows: &[],
        scale: Scale::PartsOfColumn("flag"),
    }],
    verdict: Verdict::ShapeOnly(
        "The paper has no times: it found no significant gain, because most walks go the whole kernel.",
    ),
    recipe: Some(section_5_4),
};

fn section_5_4(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    for taps in [5, 17] {
        let step = taps.to_string();
        let words =
            format!("{} --vpls 64 --direct none --kernel {taps} --sweep walk-end=flag,branch", effort.size(1280, 1024));
        recipe.step(Step::bench(&step, "filter", "hall:triangles=8000", 7, &words));
        for way in ["flag", "branch"] {
            let source = Source::row(&step, format!("walk-end={way}"), figures::ms());
            recipe.cell(0, format!("{taps}x{taps}"), way, source);
        }
    }
    recipe
}

pub const SECTION_6_2: Item = Item {
    name: "section-6.2",
    title: "What interleaving adds to a frame, and the number of lights from which on it pays",
    place: "section 6.2",
    published: &[
        Published {
            title: "what interleaving adds",
            unit: "ms a million pixels",
            columns: &["text", "table 3 (computed)"],
            rows: &[("6800 GT", &[22.5, ABSENT])],
            scale: Scale::ItsMachine,
        },
        Published {
            title: "the same",
            unit: "passes of one light",
            columns: &["overhead"],
            rows: &[("6800 GT", &[4.5])],
            scale: Scale::ItsMachine,
        },
        Published {
            title: "pattern",
            unit: "lights",
            columns: &["lights from which on interleaving pays"],
            rows: &[("4x4", &[16.0])],
            scale: Scale::Itself,
        },
        Published {
            title: "interleaved, one texel a thread",
            unit: "times as fast",
            columns: &[],
            rows: &[],
            scale: Scale::ItsMachine,
        },
    ],
    verdict: Verdict::ShapeOnly(
        "The sum of table 3 is arithmetic and agrees; the rest is of a GeForce 6800 GT. The paper counts as paying what saves more \
         passes of one light than interleaving adds, and rounds up to its pattern's 16; ours are measured, at each number.",
    ),
    recipe: Some(section_6_2),
};

/// Patterns, and numbers of lights at which the crossover is looked for: a subset needs one light.
const LIGHTS: [(&str, [u32; 4]); 2] = [("2x2", [4, 8, 16, 32]), ("4x4", [16, 32, 64, 128])];

fn section_6_2(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    recipe.cell(0, "6800 GT", "table 3 (computed)", Source::Computed(overhead_ms("6800 GT")));
    recipe.cell(0, "7800 GT", "table 3 (computed)", Source::Computed(overhead_ms("7800 GT")));
    for gpu in ["6800 GT", "7800 GT"] {
        recipe.cell(1, format!("{gpu}, table 3 (computed)"), "overhead", Source::Computed(overhead_passes(gpu)));
    }
    let words = format!(
        "{} --pattern 4x4 --kernel 5 --direct none {SUB_BUFFERS} --fair --vpls 256 --sweep split=none,two-pass,one-pass",
        effort.size(1024, 1024)
    );
    recipe.step(Step::bench("overhead", "frame", "hall:triangles=8000", 7, &words));
    for split in ["two-pass", "one-pass"] {
        let source = Source::row("overhead", format!("split={split}"), figures::overhead_light_passes());
        recipe.cell(1, format!("this device, {split}"), "overhead", source);
    }
    for (pattern, lights) in LIGHTS {
        for (width, height) in [(320, 240), (640, 480), (1024, 1024), (1920, 1080)] {
            let step = format!("{pattern}-{width}x{height}");
            let counts = lights.map(|count| count.to_string()).join(",");
            let words = format!(
                "{} --pattern {pattern} --kernel 5 --direct none {SUB_BUFFERS} --fair --sweep vpls={counts} \
                 --sweep split=none,one-pass \
                 --baseline split=none",
                effort.size(width, height)
            );
            recipe.step(Step::bench(&step, "frame", "hall:triangles=8000", 5, &words));
            for count in lights {
                let variant = format!("vpls={count} split=one-pass");
                let source = Source::row(&step, variant, figures::times_as_fast());
                recipe.cell(3, format!("{pattern}, {count} lights"), format!("{width}x{height}"), source);
            }
            let row = if (pattern, width) == ("4x4", 1024) {
                pattern.to_owned()
            } else {
                format!("{pattern} at {width}x{height}")
            };
            recipe.cell(
                2,
                row,
                SECTION_6_2.published[2].columns[0],
                Source::rows(
                    &step,
                    "at none of these numbers of lights interleaving is proven to be faster",
                    least_that_pays,
                ),
            );
        }
    }
    recipe
}

/// The fewest lights with which interleaving is proven to be faster.
fn least_that_pays(rows: &[&BenchRow]) -> Option<Number> {
    let pays = |row: &&&BenchRow| {
        row.variant.ends_with("split=one-pass") && row.interval().is_some_and(|[_, high]| high < 1.0)
    };
    let lights = |row: &&BenchRow| row.asked_text("vpls").parse::<f64>().ok();
    rows.iter().filter(pays).filter_map(lights).min_by(f64::total_cmp).map(Number::exact)
}

/// What the three passes take that interleaving adds.
fn overhead_ms(gpu: &str) -> f64 {
    ["BS", "BG", "B,"].into_iter().map(|pass| pass_ms(gpu, pass)).sum()
}

fn overhead_passes(gpu: &str) -> f64 {
    overhead_ms(gpu) / pass_ms(gpu, "SSM")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The text's 22.5 ms and 4.5 passes of one light are what table 3 has, and its 40 % are not.
    #[test]
    fn the_text_agrees_with_table_3_but_for_the_gather() {
        assert!((overhead_ms("6800 GT") - 22.5).abs() < 1e-9);
        assert!((overhead_passes("6800 GT") - 4.5).abs() < 0.1);
        assert!(faster("6800 GT") > 55.0 && faster("7800 GT") > 55.0);
    }
}
