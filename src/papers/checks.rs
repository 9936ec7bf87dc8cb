//! Mistakes that data can have, looked for in all of it.

use super::item::{Item, Paper, Scale, Verdict};
use super::recipe::{Differing, Effort, Recipe, Source, Step, Verb};
use super::{all, find};
use crate::bench::sweep::{axes, grid, label};
use std::collections::HashSet;

/// Every item with its recipe of each effort.
fn recipes() -> impl Iterator<Item = (String, &'static Item, Recipe)> {
    let efforts = [Effort::FULL, Effort::QUICK];
    let of = move |(paper, item): (&'static Paper, &'static Item)| {
        let recipe = item.recipe;
        efforts.into_iter().filter_map(move |effort| {
            Some((format!("{}/{} ({})", paper.name, item.name, effort.name()), item, recipe?(effort)))
        })
    };
    all().into_iter().flat_map(of)
}

#[test]
fn every_item_has_a_name_of_its_own_and_a_reason() {
    let mut names = HashSet::new();
    for (paper, item) in all() {
        let name = format!("{}/{}", paper.name, item.name);
        assert!(names.insert(name.clone()), "{name} is there twice");
        assert_eq!(find(&name).unwrap().len(), 1);
        assert!(item.verdict.reason().ends_with('.') && !item.title.is_empty() && !item.place.is_empty(), "{name}");
        assert_eq!(matches!(item.verdict, Verdict::NotHere(_)), item.recipe.is_none(), "{name}");
    }
    assert_eq!(find("segovia-2006").unwrap().len(), 18);
    for (name, why) in [("nobody-1999/table-1", "no paper"), ("segovia-2006/table-9", "no item table-9")] {
        let error = find(name).err().unwrap();
        assert!(error.exit_code() == 2 && error.message().contains(why), "{error}");
    }
}

#[test]
fn every_row_has_a_number_for_each_column() {
    for (paper, item) in all() {
        for table in item.published {
            for (row, numbers) in table.rows {
                assert_eq!(numbers.len(), table.columns.len(), "{}/{}: {row}", paper.name, item.name);
            }
            let has = |row: &str| table.rows.iter().any(|(name, _)| *name == row);
            match table.scale {
                Scale::PartsOfRow(whole) => assert!(table.rows.is_empty() || has(whole), "{whole}"),
                Scale::PartsOfColumn(whole) => assert!(table.columns.contains(&whole), "{whole}"),
                Scale::Itself | Scale::ItsMachine => {}
            }
        }
    }
}

/// What a step's rows are called.
fn variants(step: &Step) -> Vec<String> {
    let sweeps: Vec<String> =
        step.words.windows(2).filter(|pair| pair[0] == "--sweep").map(|pair| pair[1].clone()).collect();
    grid(&axes(&sweeps).unwrap()).iter().map(label).collect()
}

fn check_source(name: &str, source: &Source, steps: &[Step]) {
    let step = |wanted: &str| {
        steps.iter().find(|step| step.name == wanted).unwrap_or_else(|| panic!("{name}: there is no step {wanted}"))
    };
    match source {
        Source::Row { step: wanted, variant, .. } => {
            let step = step(wanted);
            assert!(matches!(step.verb, Verb::Bench { .. }), "{name}: {wanted} has no rows");
            assert!(variants(step).contains(variant), "{name}: {wanted} has no row {variant}");
        }
        Source::Rows { step: wanted, .. } => {
            assert!(matches!(step(wanted).verb, Verb::Bench { .. }), "{name}: {wanted} has no rows");
        }
        Source::Document { step: wanted, .. } => {
            assert!(!matches!(step(wanted).verb, Verb::Bench { .. }), "{name}: {wanted} has no document");
        }
        Source::Combined { parts, .. } => parts.iter().for_each(|part| check_source(name, part, steps)),
        Source::Computed(value) => assert!(value.is_finite(), "{name}"),
    }
}

#[test]
fn every_number_and_picture_of_a_recipe_is_left_by_one_of_its_steps() {
    for (name, item, recipe) in recipes() {
        let names: HashSet<&str> = recipe.steps.iter().map(|step| step.name.as_str()).collect();
        assert_eq!(names.len(), recipe.steps.len(), "{name}: two steps of one name");
        let mut places = HashSet::new();
        for cell in &recipe.cells {
            assert!(cell.table < item.published.len(), "{name}: it has no table {}", cell.table);
            assert!(places.insert((cell.table, &cell.row, &cell.column)), "{name}: {} {} twice", cell.row, cell.column);
            check_source(&name, &cell.source, &recipe.steps);
        }
        for picture in &recipe.pictures {
            // A close-up is left by what leaves the picture that it is of.
            let of = recipe.close_ups.iter().find(|close_up| close_up.file() == picture.file);
            let file = of.map_or(&picture.file, |close_up| &close_up.of);
            let is_left = |step: &Step| match step.verb {
                Verb::Render { extension } => {
                    let rest = file.strip_prefix(&format!("{}.", step.name));
                    let stage = rest.and_then(|rest| rest.strip_suffix(".png"));
                    let named = |stage: &str| step.words.iter().any(|word| word.split(',').any(|one| one == stage));
                    extension == "png" && (rest == Some("png") || stage.is_some_and(named))
                }
                Verb::Compare { picture: Differing::Map, .. } => *file == format!("{}.png", step.name),
                Verb::Pattern { .. } => {
                    [format!("{}.png", step.name), format!("{}.spectrum.png", step.name)].contains(file)
                }
                _ => false,
            };
            assert!(recipe.steps.iter().any(is_left), "{name}: no step leaves {}", picture.file);
        }
        for step in &recipe.steps {
            for file in step.earlier_files() {
                let stem = file.rsplit_once('.').unwrap();
                let is_of =
                    |step: &Step| step.verb == Verb::Render { extension: if stem.1 == "exr" { "exr" } else { "png" } };
                let mut before = recipe.steps.iter().take_while(|other| other.name != step.name);
                assert!(before.any(|step| step.name == stem.0 && is_of(step)), "{name}: {file}");
            }
        }
    }
}
