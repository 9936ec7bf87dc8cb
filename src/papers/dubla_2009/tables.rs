//! Its three tables.

use crate::papers::figures;
use crate::papers::item::{ABSENT, Item, Published, Scale, Verdict};
use crate::papers::recipe::{Effort, Recipe, Source, Step};

const AVERAGE: &str = "average, as printed";

/// Frames a second. Indirect light (ID), soft shadows (SS), participating media (PM) and all of it (FULL), adaptive (A) and
/// refined everywhere (A-MAX); IGI is Wald's interactive global illumination.
#[expect(clippy::approx_constant, reason = "a measured number, and no part of a circle")]
const RATES: Published = Published {
    title: "scene",
    unit: "frames/s",
    columns: &["ID A", "ID A-MAX", "SS A", "SS A-MAX", "PM A", "PM A-MAX", "FULL A", "FULL A-MAX", "FULL IGI"],
    rows: &[
        ("Cornell", &[10.17, 3.57, 9.56, 5.24, ABSENT, ABSENT, 6.25, 2.35, 1.75]),
        ("Deskar", &[5.29, 1.78, 5.12, 3.46, ABSENT, ABSENT, 3.21, 1.27, 0.95]),
        ("Subdivided", &[15.19, 5.05, 17.74, 8.16, ABSENT, ABSENT, 11.03, 3.55, 2.89]),
        ("Desk", &[9.99, 3.11, 12.02, 4.92, ABSENT, ABSENT, 6.94, 2.15, 1.71]),
        ("Sibenik", &[3.14, 1.45, 5.03, 1.20, ABSENT, ABSENT, 2.45, 1.01, 0.66]),
        ("Office", &[6.95, 3.08, 8.11, 4.10, ABSENT, ABSENT, 5.06, 2.03, 1.70]),
        ("Conference", &[4.04, 1.74, 8.41, 4.12, ABSENT, ABSENT, 3.20, 1.35, 0.92]),
        ("Shirley6", &[14.61, 5.11, 16.77, 7.00, ABSENT, ABSENT, 9.40, 3.38, 2.85]),
        ("SubdividedPM", &[15.19, 5.05, 17.74, 8.16, 3.98, 1.43, 3.12, 1.05, ABSENT]),
        ("OfficePM", &[6.95, 3.08, 8.11, 4.10, 6.97, 2.40, 3.37, 1.13, ABSENT]),
        ("Shirley6PM", &[14.61, 5.11, 16.77, 7.00, 5.52, 1.76, 4.04, 1.15, ABSENT]),
        (AVERAGE, &[9.65, 3.46, 11.40, 5.22, 5.49, 1.86, 5.28, 1.86, 1.68]),
    ],
    scale: Scale::ItsMachine,
};

const AVERAGES_OF_RATES: Published = Published {
    title: "average of table 1",
    unit: "frames/s",
    columns: RATES.columns,
    rows: &[(AVERAGE, RATES.rows[11].1)],
    scale: Scale::Itself,
};

#[expect(clippy::approx_constant, reason = "a measured number, and no part of a circle")]
const SPEED_UPS: Published = Published {
    title: "scene",
    unit: "times as fast",
    columns: &["ID", "SS", "PM", "FULL", "FULL over IGI"],
    rows: &[
        ("Cornell", &[2.85, 1.82, ABSENT, 2.66, 3.57]),
        ("Deskar", &[2.98, 1.48, ABSENT, 2.53, 3.39]),
        ("Subdivided", &[3.01, 2.17, ABSENT, 3.11, 3.81]),
        ("Desk", &[3.21, 2.44, ABSENT, 3.23, 4.07]),
        ("Sibenik", &[2.17, 4.19, ABSENT, 2.42, 3.68]),
        ("Office", &[2.26, 1.98, ABSENT, 2.49, 2.98]),
        ("Conference", &[2.32, 2.04, ABSENT, 2.38, 3.47]),
        ("Shirley6", &[2.86, 2.40, ABSENT, 2.78, 3.29]),
        ("SubdividedPM", &[3.01, 2.17, 2.78, 2.97, ABSENT]),
        ("OfficePM", &[2.26, 1.98, 2.90, 2.98, ABSENT]),
        ("Shirley6PM", &[2.86, 2.40, 3.14, 3.53, ABSENT]),
        (AVERAGE, &[2.71, 2.28, 2.94, 2.82, 3.53]),
    ],
    scale: Scale::Itself,
};

const FROM_RATES: Published = Published {
    title: "from table 1",
    unit: "times as fast",
    columns: SPEED_UPS.columns,
    rows: SPEED_UPS.rows,
    scale: Scale::Itself,
};

const DIFFERENCES: Published = Published {
    title: "scene",
    unit: "% of the pixels",
    columns: &["A, 75 %", "A, 95 %", "A-MAX, 75 %", "A-MAX, 95 %", "IGI, 75 %", "IGI, 95 %"],
    rows: &[
        ("Cornell", &[0.86, 0.41, 0.55, 0.25, 0.80, 0.36]),
        ("Deskar", &[1.09, 0.57, 0.80, 0.42, 1.26, 0.59]),
        ("Subdivided", &[1.15, 0.62, 0.83, 0.36, 0.81, 0.56]),
        ("Desk", &[1.86, 0.97, 1.21, 0.74, 2.14, 1.01]),
        ("Sibenik", &[3.52, 1.68, 2.91, 1.38, 2.54, 1.25]),
        ("Office", &[0.41, 0.17, 0.12, 0.03, 0.41, 0.14]),
        ("Conference", &[1.48, 0.97, 1.46, 1.02, 1.66, 1.11]),
        ("Shirley6", &[0.08, 0.03, 0.02, 0.00, 0.18, 0.06]),
        ("SubdividedPM", &[1.90, 1.07, 1.12, 0.69, ABSENT, ABSENT]),
        ("OfficePM", &[0.26, 0.11, 0.25, 0.09, ABSENT, ABSENT]),
        ("Shirley6PM", &[2.10, 0.96, 1.35, 0.57, ABSENT, ABSENT]),
        (AVERAGE, &[1.29, 0.71, 0.95, 0.54, 1.17, 0.67]),
    ],
    scale: Scale::ItsMachine,
};

/// Row, folder, scene and its settings; and whether a medium fills it. What the paper's scenes are not ours to ship is left out.
const SCENES: [(&str, &str, &str, &str, bool); 8] = [
    ("Cornell", "cornell", "cornell", "", false),
    ("Desk", "desk", "desk", "", false),
    ("Office", "office", "office", "", false),
    ("Shirley6", "shirley", "shirley", "", false),
    ("hall (ours)", "hall", "hall:triangles=8000", "", false),
    ("OfficePM", "office-medium", "office:smoke=on", "", true),
    ("Shirley6PM", "shirley-medium", "shirley", "--medium 0.1,0.02,0.3", true),
    ("cornell with a medium (ours)", "cornell-medium", "cornell", "--medium 0.1,0.02,0.3", true),
];

/// Surfaces that shine are lights in all of them, where there are punctual lights too.
pub const LIT: &str = "--technique adaptive_interleaved --emissive on";

/// The paper does not say how large its pictures are.
pub fn size(effort: Effort) -> String {
    effort.size(480, 270)
}

/// A bench of each component of each scene in the three modes; `more` for whole pictures.
fn measured(recipe: &mut Recipe, effort: Effort, more: &str) {
    for (_, folder, scene, words, has_medium) in SCENES {
        let all: &[(&str, &str)] = if has_medium {
            &[("PM", "--components pm"), ("FULL", "")]
        } else {
            &[("ID", "--components id"), ("SS", "--components ss"), ("FULL", "")]
        };
        for (component, which) in all {
            let more = if which.is_empty() { more } else { "" };
            let words = format!("{LIT} {} {words} {which} {more} --sweep mode=max,adaptive,igi", size(effort));
            recipe.step(Step::bench(format!("{folder}-{component}"), "frame", scene, 5, &words));
        }
    }
}

fn components(has_medium: bool) -> &'static [&'static str] {
    if has_medium { &["PM", "FULL"] } else { &["ID", "SS", "FULL"] }
}

pub const TABLE_1: Item = Item {
    name: "table-1",
    title: "Frames a second, component by component",
    place: "section 4.2, page 2126",
    published: &[RATES, AVERAGES_OF_RATES],
    verdict: Verdict::ShapeOnly(
        "Frames a second are of eight cores of 3.2 GHz and of pictures whose size the paper does not give. The ratios, which carry over, are \
         table-2. The averages are computed from the rows.",
    ),
    recipe: Some(table_1),
};

fn table_1(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    measured(&mut recipe, effort, "");
    for (row, folder, _, _, has_medium) in SCENES {
        for component in components(has_medium) {
            for (name, mode) in [("A", "adaptive"), ("A-MAX", "max"), ("IGI", "igi")] {
                let column = format!("{component} {name}");
                if RATES.columns.contains(&column.as_str()) {
                    let step = format!("{folder}-{component}");
                    let source = Source::row(step, format!("mode={mode}"), figures::per_second());
                    recipe.cell(0, row, column, source);
                }
            }
        }
    }
    averages(&mut recipe, 1, &RATES);
    recipe
}

/// Mean of a column's scenes. Scenes with a medium repeat the numbers of those without (ID and SS), and count again, as printed.
fn average(table: &Published, column: usize) -> f64 {
    let rows: Vec<f64> =
        table.column(table.columns[column]).filter(|(name, _)| *name != AVERAGE).map(|(_, number)| number).collect();
    rows.iter().sum::<f64>() / rows.len() as f64
}

/// What a table's rows come to, beside what it prints.
fn averages(recipe: &mut Recipe, index: usize, table: &Published) {
    for (column, name) in table.columns.iter().enumerate() {
        recipe.cell(index, AVERAGE, *name, Source::Computed(average(table, column)));
    }
}

pub const TABLE_2: Item = Item {
    name: "table-2",
    title: "Times as fast as refinement everywhere, and as interactive global illumination",
    place: "section 4.2, page 2127",
    published: &[
        SPEED_UPS,
        FROM_RATES,
        Published { title: "average of table 2", rows: &[(AVERAGE, SPEED_UPS.rows[11].1)], ..SPEED_UPS },
        Published {
            title: "scene",
            unit: "times fewer shadow rays",
            columns: SPEED_UPS.columns,
            rows: &[],
            scale: Scale::ItsMachine,
        },
    ],
    verdict: Verdict::ShapeOnly(
        "Ratios of times of two machines may be laid side by side; the scenes are others, built in here under the paper's names. Every scene's ratio \
         follows from table 1 within its rounding, and so do the averages, which is computed.",
    ),
    recipe: Some(table_2),
};

fn table_2(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    measured(&mut recipe, effort, "");
    for (row, folder, _, _, has_medium) in SCENES {
        for component in components(has_medium) {
            let step = format!("{folder}-{component}");
            recipe.cell(0, row, *component, Source::row(&step, "mode=adaptive", figures::times_as_fast()));
            recipe.cell(3, row, *component, fewer_rays(&step, "max"));
        }
        if !has_medium {
            let step = format!("{folder}-FULL");
            let ms = |mode: &str| Source::row(&step, format!("mode={mode}"), figures::ms());
            recipe.cell(0, row, "FULL over IGI", Source::combined([ms("igi"), ms("adaptive")], |ms| ms[0] / ms[1]));
            recipe.cell(3, row, "FULL over IGI", fewer_rays(&step, "igi"));
        }
    }
    for (row, column, computed) in computed_speed_ups() {
        recipe.cell(1, row, column, computed);
    }
    averages(&mut recipe, 2, &SPEED_UPS);
    recipe
}

/// Rays of a mode in parts of those of adaptive refinement, which no machine has a part in.
fn fewer_rays(step: &str, mode: &str) -> Source {
    let rays = |mode: &str| Source::row(step, format!("mode={mode}"), figures::counter("rays"));
    Source::combined([rays(mode), rays("adaptive")], |rays| rays[0] / rays[1])
}

/// Columns of table 1 whose ratio a column of table 2 is.
const RATIOS: [(&str, &str, &str); 5] = [
    ("ID", "ID A", "ID A-MAX"),
    ("SS", "SS A", "SS A-MAX"),
    ("PM", "PM A", "PM A-MAX"),
    ("FULL", "FULL A", "FULL A-MAX"),
    ("FULL over IGI", "FULL A", "FULL IGI"),
];

/// What table 1 says of each place of table 2.
fn computed_speed_ups() -> Vec<(&'static str, &'static str, Source)> {
    let scenes = RATES.rows.iter().map(|(name, _)| *name).filter(|name| *name != AVERAGE);
    let places = scenes.flat_map(|row| RATIOS.into_iter().map(move |ratio| (row, ratio)));
    let known = places.filter_map(|(row, (column, fast, slow))| {
        Some((row, column, RATES.number(row, fast)? / RATES.number(row, slow)?))
    });
    known.map(|(row, column, ratio)| (row, column, Source::Computed(ratio))).collect()
}

pub const TABLE_3: Item = Item {
    name: "table-3",
    title: "Pixels that differ visibly from a path-traced picture",
    place: "section 4.2.1, page 2127",
    published: &[
        DIFFERENCES,
        Published {
            title: "average of table 3",
            rows: &[(AVERAGE, DIFFERENCES.rows[11].1)],
            scale: Scale::Itself,
            ..DIFFERENCES
        },
        Published {
            title: "scene",
            unit: "% of the pixels over 0.1 HDR-FLIP",
            columns: &["A", "A-MAX", "IGI"],
            rows: &[],
            scale: Scale::ItsMachine,
        },
    ],
    verdict: Verdict::ShapeOnly(
        "The paper counts by HDR-VDP, which is in another paper; ours are pixels over 0.1 HDR-FLIP, and stand apart. The averages that table 3 \
         prints do not follow from its rows: what follows is computed.",
    ),
    recipe: Some(table_3),
};

fn table_3(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let judged = format!("--reference auto --reference-spp {}", effort.pick(2500, 64));
    for (_, folder, scene, words, _) in SCENES {
        let words = format!("{LIT} {} {words} {judged} --sweep mode=max,adaptive,igi", size(effort));
        recipe.step(Step::bench(folder, "frame", scene, 1, &words));
    }
    for (row, folder, _, _, _) in SCENES {
        for (column, mode) in [("A", "adaptive"), ("A-MAX", "max"), ("IGI", "igi")] {
            let source = Source::row(folder, format!("mode={mode}"), figures::over_threshold_percent());
            recipe.cell(2, row, column, source);
        }
    }
    averages(&mut recipe, 1, &DIFFERENCES);
    recipe
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of two digits behind the point are rounded by 0.005: that is what their ratios may be off by.
    #[test]
    fn table_2_follows_from_table_1() {
        let mut count = 0;
        for (row, _) in RATES.rows.iter().filter(|(name, _)| *name != AVERAGE) {
            for (column, fast, slow) in RATIOS {
                let (Some(fast), Some(slow)) = (RATES.number(row, fast), RATES.number(row, slow)) else { continue };
                let printed = SPEED_UPS.number(row, column).unwrap();
                let [low, high] = [(fast - 0.005) / (slow + 0.005), (fast + 0.005) / (slow - 0.005)];
                assert!(low - 0.0051 <= printed && printed <= high + 0.0051, "{row} {column}: {low} {printed} {high}");
                count += 1;
            }
        }
        assert_eq!(count, 11 * 3 + 3 + 8);
    }

    #[test]
    fn averages_follow_from_rows_except_in_table_3() {
        for table in [&RATES, &SPEED_UPS] {
            for (column, name) in table.columns.iter().enumerate() {
                let printed = table.number(AVERAGE, name).unwrap();
                assert!(
                    (average(table, column) - printed).abs() < 0.011,
                    "{name}: {} {printed}",
                    average(table, column)
                );
            }
        }
        let off = |column: usize| {
            average(&DIFFERENCES, column) - DIFFERENCES.number(AVERAGE, DIFFERENCES.columns[column]).unwrap()
        };
        assert!((0..6).all(|column| off(column).abs() > 0.011 && off(column).abs() < 0.07));
    }
}
