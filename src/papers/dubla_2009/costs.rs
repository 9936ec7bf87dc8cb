//! What the steps of its algorithm take.

use super::tables::{LIT, size};
use crate::bench::stats::straight;
use crate::papers::item::{Item, Published, Scale, Verdict};
use crate::papers::recipe::{Effort, Number, Recipe, Source, Step};
use serde_json::Value;

/// Passes beside sampling, by how their names begin behind the technique's, and what the paper calls them.
const STEPS: [(&str, &[&str]); 4] = [
    ("guidance (step 2)", &["guide", "spread"]),
    ("lists of tiles (ours)", &["compact"]),
    ("discontinuities and filters (section 3)", &["discontinuity", "filter"]),
    ("upsampling (section 4.1)", &["upsample"]),
];

const ALL: &str = "all of them";
const MS: &str = "ms";
const PART: &str = "% of the frame";

pub const SECTION_3: Item = Item {
    name: "section-3",
    title: "What the steps beside sampling take, and time by the number of rays",
    place: "section 3",
    published: &[
        Published { title: "steps", unit: "number", columns: &[MS, PART], rows: &[], scale: Scale::ItsMachine },
        Published {
            title: "indirect light refined everywhere, 1 to 9 iterations",
            unit: "ms",
            columns: &["a ray a pixel", "without a ray"],
            rows: &[],
            scale: Scale::ItsMachine,
        },
    ],
    verdict: Verdict::ShapeOnly("The paper gives no times of its steps: ours say what is left for sampling."),
    recipe: Some(steps),
};

fn steps(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let common = format!("{LIT} {}", size(effort));
    recipe.step(Step::render("office", "png", "office", &format!("{common} --exposure auto --profile")));
    recipe.picture("office", "office.png");
    let every: &[&str] = &["guide", "spread", "compact", "discontinuity", "filter", "upsample"];
    for (row, passes) in STEPS.into_iter().chain([(ALL, every)]) {
        recipe.cell(0, row, MS, on_device(passes));
        let part = Source::combined([on_device(passes), on_device(&[""])], |ms| 100.0 * ms[0] / ms[1]);
        recipe.cell(0, row, PART, part);
    }
    let words = format!("{common} --mode max --components id --sweep id-max=1,2,3,5,7,9");
    recipe.step(Step::bench("line", "frame", "office", 5, &words));
    for (column, coefficient) in [("a ray a pixel", 1), ("without a ray", 0)] {
        let read = move |line: [f64; 2]| Number::exact(line[coefficient]);
        let source = Source::rows("line", "it takes two rows with rays and times", move |rows| {
            let points = rows.iter().filter_map(|row| {
                let rays = row.counters.as_ref()?.get("rays").copied()?;
                Some([rays, row.times_ms()?.median])
            });
            straight(&points.collect::<Vec<_>>()).map(read)
        });
        recipe.cell(1, "office", column, source);
    }
    recipe
}

/// Milliseconds of the device's passes whose names, behind the technique's, begin with one of these.
fn on_device(starts: &'static [&'static str]) -> Source {
    let read = |document: &Value| {
        let all = document.get("passes")?.as_array()?;
        let ms = |pass: &Value| {
            let own = pass.get("name")?.as_str()?.strip_prefix("adaptive_interleaved.")?;
            let is_host = pass.get("where").and_then(Value::as_str) == Some("host");
            let is_asked = !is_host && starts.iter().any(|start| own.starts_with(start));
            is_asked.then(|| pass.pointer("/ms/median")?.as_f64())?
        };
        all.iter().filter_map(ms).reduce(|sum, ms| sum + ms)
    };
    Source::Document { step: "office".to_owned(), read: Box::new(read) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn steps_are_the_devices_passes_of_their_names() {
        let pass = |name: &str, ms: f64, at: &str| json!({ "name": name, "ms": { "median": ms }, "where": at });
        let report = json!({ "passes": [
            pass("adaptive_interleaved.guide.id", 1.0, "device"),
            pass("adaptive_interleaved.guide.ss", 2.0, "device"),
            pass("adaptive_interleaved.sample.id", 40.0, "device"),
            pass("adaptive_interleaved.vpls", 7.0, "host"),
            pass("scene.guide", 9.0, "device"),
        ] });
        let of = |starts| {
            let Source::Document { read, .. } = on_device(starts) else { panic!("a document") };
            read(&report)
        };
        assert_eq!(of(&["guide", "spread"]), Some(3.0));
        assert_eq!(of(&[""]), Some(43.0));
        assert_eq!(of(&["filter"]), None);
    }
}
