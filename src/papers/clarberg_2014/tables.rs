//! Its tables of scenes and of visibility.

use super::scenes::{SPONZA, frames};
use crate::papers::figures;
use crate::papers::item::{Item, Published, Scale, Verdict};
use crate::papers::recipe::{Effort, Recipe, Source, Step};

pub const TABLE_1: Item = Item {
    name: "table-1",
    title: "The test scenes",
    place: "section 6",
    published: &[Published {
        title: "scene",
        unit: "number",
        columns: &["triangles", "draws", "lights"],
        rows: &[
            ("ARENA", &[528_000.0, 855.0, 64.0]),
            ("SPONZA", &[256_000.0, 392.0, 16.0]),
            ("POWER", &[111_000.0, 286.0, 1.0]),
            ("CHESS", &[46_000.0, 19.0, 16.0]),
        ],
        scale: Scale::Itself,
    }],
    verdict: Verdict::Comparable(
        "The paper's scenes are not public; built-in ones are made with as many triangles, draws and lights, which are counted here \
         as they are drawn.",
    ),
    recipe: Some(table_1),
};

fn table_1(_: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    for (row, step, scene) in [
        ("ARENA", "arena", "arena"),
        ("SPONZA", "hall", SPONZA),
        ("POWER", "power", "power"),
        ("CHESS", "chess", "chess"),
    ] {
        recipe.step(Step::render(step, "png", scene, "--size 16x9 --technique deep_shading --spp 1"));
        for column in ["triangles", "draws", "lights"] {
            recipe.cell(0, row, column, Source::document(step, format!("/scene/{column}"), 1.0));
        }
    }
    recipe
}

const WHOLE: &str = "interleaved, frame by frame, aperture 1";

pub const TABLE_3: Item = Item {
    name: "table-3",
    title: "Time of visibility by the order of drawing and the aperture, 8 samples a pixel of 32 tuples",
    place: "section 6.3",
    published: &[Published {
        title: "order and aperture (1 to 4: none to the largest)",
        unit: "ms",
        columns: &["SPONZA, GPU A", "ARENA, GPU A", "SPONZA, GPU B", "ARENA, GPU B"],
        rows: &[
            ("stochastic, aperture 1", &[14.2, 14.3, 9.1, 11.0]),
            ("stochastic, aperture 2", &[41.2, 60.9, 24.0, 38.5]),
            ("stochastic, aperture 3", &[83.4, 139.4, 47.0, 80.0]),
            ("stochastic, aperture 4", &[136.3, 240.3, 77.8, 134.4]),
            (WHOLE, &[6.1, 19.1, 7.7, 25.1]),
            ("interleaved, frame by frame, aperture 2", &[6.1, 19.0, 7.7, 25.1]),
            ("interleaved, frame by frame, aperture 3", &[6.1, 19.0, 7.7, 25.1]),
            ("interleaved, frame by frame, aperture 4", &[6.1, 18.9, 7.7, 25.2]),
            ("interleaved, draw by draw, aperture 1", &[17.5, 27.2, 21.0, 45.7]),
            ("interleaved, draw by draw, aperture 2", &[17.6, 27.4, 21.0, 45.6]),
            ("interleaved, draw by draw, aperture 3", &[17.5, 27.3, 20.9, 45.2]),
            ("interleaved, draw by draw, aperture 4", &[17.4, 27.3, 21.0, 45.4]),
            ("interleaved, instances, aperture 1", &[12.5, 34.5, 18.8, 39.4]),
            ("interleaved, instances, aperture 2", &[12.5, 34.5, 18.7, 39.3]),
            ("interleaved, instances, aperture 3", &[12.5, 34.5, 18.6, 39.3]),
            ("interleaved, instances, aperture 4", &[12.5, 34.5, 18.6, 39.2]),
            ("interleaved, geometry shader, aperture 1", &[39.9, 76.7, 188.1, 560.7]),
            ("interleaved, geometry shader, aperture 2", &[39.9, 76.7, 174.4, 530.3]),
            ("interleaved, geometry shader, aperture 3", &[39.9, 76.7, 154.3, 480.3]),
            ("interleaved, geometry shader, aperture 4", &[39.8, 76.7, 133.6, 430.7]),
        ],
        scale: Scale::PartsOfRow(WHOLE),
    }],
    verdict: Verdict::ShapeOnly(
        "Milliseconds are of a GTX 780 (A) and an R9 290 (B), apertures in units of scenes that are not public (10 to 30 and 300 to 900); \
         ours are 0, 0.1, 0.2 and 0.4 m.",
    ),
    recipe: Some(table_3),
};

/// How the paper's orders are called here.
const ORDERS: [(&str, &str); 5] = [
    ("stochastic", "stochastic"),
    ("interleaved, frame by frame", "repeat-frame"),
    ("interleaved, draw by draw", "repeat-draw"),
    ("interleaved, instances", "instancing"),
    ("interleaved, geometry shader", "replicate"),
];

fn table_3(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let orders = "repeat-frame,repeat-draw,instancing,replicate,stochastic";
    for (name, scene, more, apertures) in [
        ("SPONZA", SPONZA, "", ["0", "0.1", "0.2", "0.4"]),
        ("ARENA", "arena", "--camera flight --time 10", ["0", "0.1", "0.2", "0.4"]),
    ] {
        let words = format!(
            "{} --spp 8 --tuples 32 --instrument off {more} {} --sweep visibility={orders} --sweep aperture={}",
            frames(effort),
            super::scenes::UNLIT,
            apertures.join(",")
        );
        recipe.step(Step::bench(name, "visibility", scene, 5, &words));
        for gpu in ["GPU A", "GPU B"] {
            for (row, visibility) in ORDERS {
                for (index, aperture) in apertures.iter().enumerate() {
                    let variant = format!("visibility={visibility} aperture={aperture}");
                    let source = Source::row(name, variant, figures::ms());
                    recipe.cell(0, format!("{row}, aperture {}", index + 1), format!("{name}, {gpu}"), source);
                }
            }
        }
    }
    recipe
}
