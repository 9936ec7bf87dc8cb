//! Its table of every operation's time, and what the table itself says of its sums.

use super::scenes::{UNLIT, blurred, pictures};
use crate::papers::item::{Item, Published, Scale, Verdict};
use crate::papers::recipe::{Effort, Recipe, Source, Step};

const TOTAL: &str = "total, conservative rasterisation in software";
const HARDWARE: &str = "total, in hardware (estimated)";
const CONSERVATIVE: &str = "conservative rasterisation";

const OPERATIONS: Published = Published {
    title: "operation",
    unit: "ms",
    columns: &[
        "A, POWER",
        "A, SPONZA",
        "A, ARENA",
        "B, POWER",
        "B, SPONZA",
        "B, ARENA",
        "C, POWER",
        "C, SPONZA",
        "C, ARENA",
    ],
    rows: &[
        ("shadow maps", &[1.2, 6.4, 29.3, 0.1, 3.4, 26.6, 0.8, 20.1, 110.5]),
        ("interleaved rasterisation", &[5.6, 6.1, 18.9, 7.6, 7.7, 24.5, 28.5, 53.5, 98.7]),
        ("motion vectors", &[2.7, 4.3, 4.4, 0.4, 4.5, 0.7, 4.1, 8.2, 4.8]),
        ("setup of the buffer", &[5.5, 6.2, 5.8, 5.9, 6.5, 6.2, 36.5, 40.3, 37.9]),
        ("shading of the buffer", &[3.0, 10.8, 93.7, 3.4, 10.0, 45.7, 8.4, 100.4, 254.9]),
        (CONSERVATIVE, &[8.3, 23.8, 609.3, 12.4, 21.7, 80.9, 11.1, 52.4, 465.7]),
        ("reconstruction", &[14.1, 15.5, 14.3, 15.8, 16.8, 15.6, 71.8, 77.8, 73.6]),
        (TOTAL, &[40.5, 73.1, 775.6, 45.5, 70.6, 200.2, 161.2, 352.7, 1046.1]),
        (HARDWARE, &[32.2, 49.3, 166.3, 33.1, 48.9, 119.3, 150.1, 300.3, 580.4]),
    ],
    scale: Scale::PartsOfRow(TOTAL),
};

const SUMS: Published = Published {
    title: "total of table 2",
    unit: "ms",
    columns: OPERATIONS.columns,
    rows: &[(TOTAL, OPERATIONS.rows[7].1), (HARDWARE, OPERATIONS.rows[8].1)],
    scale: Scale::Itself,
};

const SHARES: Published = Published {
    title: "setup and shading, in % of the total",
    unit: "%",
    columns: &["least", "greatest"],
    rows: &[("all devices and scenes", &[12.8, 39.9])],
    scale: Scale::Itself,
};

const GROWTH: Published = Published {
    title: "pixels that conservative rasterisation adds",
    unit: "times the pixels of the standard one",
    columns: &["least", "greatest"],
    rows: &[("the paper's scenes", &[1.17, 1.37])],
    scale: Scale::ItsMachine,
};

pub const TABLE_2: Item = Item {
    name: "table-2",
    title: "Time of each operation",
    place: "section 6.2",
    published: &[OPERATIONS, SUMS, SHARES, GROWTH],
    verdict: Verdict::ShapeOnly(
        "Milliseconds are of a GTX 780 (A), an R9 290 (B) and an Iris Pro 5200 (C); ours are beside each of them. All triangles are drawn \
         over shading space, as in the paper. The reconstruction is a filter of ours: the paper's is not in its text. That its columns \
         add up, and the shares that its text quotes, are computed from its own numbers.",
    ),
    recipe: Some(table_2),
};

/// Names of a column's passes in the table's order, and what makes them up here.
const PASSES: [(&str, &[&str]); 4] = [
    ("shadow maps", &["shadow_maps"]),
    ("interleaved rasterisation", &["visibility"]),
    ("motion vectors", &["reconstruct.samples"]),
    ("setup of the buffer", &["lists", "lists.compact", "lists.address"]),
];

const RECONSTRUCTION: &[&str] = &["reconstruct.bins", "reconstruct.layers", "reconstruct.means", "reconstruct.filter"];
const ALL: &[&str] = &[
    "shadow_maps",
    "visibility",
    "reconstruct.samples",
    "lists",
    "lists.compact",
    "lists.address",
    "entries",
    "shade",
    "strays",
    "resolve",
    "reconstruct.bins",
    "reconstruct.layers",
    "reconstruct.means",
    "reconstruct.filter",
];

/// Names of the steps of one scene.
struct Steps {
    standard: String,
    conservative: String,
    standard_pixels: String,
    conservative_pixels: String,
}

impl Steps {
    fn of(scene: &str) -> Self {
        Self {
            standard: format!("{scene}-standard"),
            conservative: format!("{scene}-conservative"),
            standard_pixels: format!("{scene}-standard-pixels"),
            conservative_pixels: format!("{scene}-conservative-pixels"),
        }
    }

    /// Times the pixels of standard rasterisation.
    fn growth(&self) -> Source {
        let drawn = |step: &String| Source::counter(step, "shading_pixels_drawn");
        Source::combined([drawn(&self.conservative_pixels), drawn(&self.standard_pixels)], |parts| parts[0] / parts[1])
    }

    /// Shading by standard rasterisation, scaled by the growth, as the paper estimates it.
    fn shading(&self) -> Source {
        let shade = Source::profiled(&self.standard, &["shade"]);
        Source::combined([shade, self.growth()], |parts| parts[0] * parts[1])
    }

    /// What conservative rasterisation takes beyond.
    fn overhead(&self) -> Source {
        let shade = Source::profiled(&self.conservative, &["shade"]);
        Source::combined([shade, self.shading()], |parts| parts[0] - parts[1])
    }

    fn total(&self) -> Source {
        Source::profiled(&self.conservative, ALL)
    }

    fn total_in_hardware(&self) -> Source {
        Source::combined([self.total(), self.overhead()], |parts| parts[0] - parts[1])
    }
}

fn table_2(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    for (name, scene, blur) in blurred(effort) {
        let steps = Steps::of(name);
        let way = "--shade-by fragment --shaded-triangles all";
        let timed = format!("--instrument off --profile --direct-shadow map --reconstruct on {way}");
        for (step, words) in [
            (&steps.standard, format!("{timed} --conservative none")),
            (&steps.conservative, timed.clone()),
            (&steps.standard_pixels, format!("{UNLIT} {way} --conservative none")),
            (&steps.conservative_pixels, format!("{UNLIT} {way}")),
        ] {
            recipe.step(Step::render(step, "png", scene, &format!("{} {blur} {words}", pictures(effort))));
        }
        for gpu in ["A", "B", "C"] {
            let column = format!("{gpu}, {name}");
            for (row, passes) in PASSES {
                recipe.cell(0, row, &column, Source::profiled(&steps.conservative, passes));
            }
            recipe.cell(0, "shading of the buffer", &column, steps.shading());
            recipe.cell(0, CONSERVATIVE, &column, steps.overhead());
            recipe.cell(0, "reconstruction", &column, Source::profiled(&steps.conservative, RECONSTRUCTION));
            recipe.cell(0, TOTAL, &column, steps.total());
            recipe.cell(0, HARDWARE, &column, steps.total_in_hardware());
        }
        recipe.cell(3, name, "growth", steps.growth());
    }
    for (index, column) in OPERATIONS.columns.iter().enumerate() {
        recipe.cell(1, TOTAL, *column, Source::Computed(total(index)));
        recipe.cell(1, HARDWARE, *column, Source::Computed(in_hardware(index)));
    }
    let (least, greatest) = (shares().fold(f64::INFINITY, f64::min), shares().fold(0.0, f64::max));
    recipe.cell(2, "all devices and scenes", "least", Source::Computed(least));
    recipe.cell(2, "all devices and scenes", "greatest", Source::Computed(greatest));
    recipe
}

fn ms(row: &str, column: usize) -> f64 {
    OPERATIONS.number(row, OPERATIONS.columns[column]).expect("table 2 is full")
}

/// The operations of a column, added up.
fn total(column: usize) -> f64 {
    let operations = OPERATIONS.rows.iter().filter(|(name, _)| ![TOTAL, HARDWARE].contains(name));
    operations.map(|(_, numbers)| numbers[column]).sum()
}

/// The printed total without what conservative rasterisation takes in software.
fn in_hardware(column: usize) -> f64 {
    ms(TOTAL, column) - ms(CONSERVATIVE, column)
}

/// Setup and shading of each column, in per cent of its total.
fn shares() -> impl Iterator<Item = f64> {
    let share =
        |column| 100.0 * (ms("setup of the buffer", column) + ms("shading of the buffer", column)) / ms(TOTAL, column);
    (0..OPERATIONS.columns.len()).map(share)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The paper prints a digit behind the point: sums of eight such numbers may be off by less than half of one.
    #[test]
    fn the_columns_of_table_2_add_up_as_printed() {
        for (column, name) in OPERATIONS.columns.iter().enumerate() {
            assert!((total(column) - ms(TOTAL, column)).abs() < 0.11, "{name}");
            assert!((in_hardware(column) - ms(HARDWARE, column)).abs() < 0.11, "{name}");
        }
        let (least, greatest) = (shares().fold(f64::INFINITY, f64::min), shares().fold(0.0, f64::max));
        assert!((least - 12.8).abs() < 0.06 && (greatest - 39.9).abs() < 0.06, "{least} {greatest}");
    }
}
