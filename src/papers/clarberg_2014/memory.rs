//! What its buffers take, byte for byte.

use super::scenes::blurred;
use crate::papers::item::{Item, Published, Scale, Verdict};
use crate::papers::recipe::{Effort, Recipe, Source, Step};

/// "MB" in the paper: its numbers come out with these.
const MIB: f64 = 1.0 / 1_048_576.0;

pub const SECTION_6: Item = Item {
    name: "memory",
    title: "What the buffers take at 1280x720 and 8 samples a pixel",
    place: "section 6",
    published: &[
        Published {
            title: "buffers",
            unit: "MiB",
            columns: &["allocated"],
            rows: &[
                ("frame buffer", &[84.4]),
                ("deep shading buffer", &[117.1]),
                ("auxiliary buffers", &[133.7]),
                ("one of Andersson's textures", &[42.7]),
                ("eight of them", &[341.3]),
            ],
            scale: Scale::Itself,
        },
        Published {
            title: "of the deep shading buffer",
            unit: "MiB",
            columns: &["accessed"],
            rows: &[("1.5 executions a pixel", &[25.0])],
            scale: Scale::Itself,
        },
    ],
    verdict: Verdict::Comparable(
        "Bytes are planned by arithmetic, on any machine. The paper prints sums alone, in \"MB\" that are 2^20 bytes; how its fields \
         make them up is inferred, and comes out to its last digit. What is accessed is counted, of our arena, and goes with its own \
         executions a pixel.",
    ),
    recipe: Some(section_6),
};

fn section_6(_: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let plan = "--plan --technique deep_shading --size 1280x720 --spp 8";
    recipe.step(Step::memory("plan", "chess", &format!("{plan} --shade-by fragment --zmax on")));
    recipe.step(Step::memory("rivals", "chess", &format!("{plan} --shading indirect-gbuffer")));
    let group = |step: &str, name: &str| Source::document(step, format!("/techniques/0/memory/groups/{name}"), MIB);
    for (row, name) in [
        ("frame buffer", "frame_buffer"),
        ("deep shading buffer", "deep_shading_buffer"),
        ("auxiliary buffers", "auxiliary"),
    ] {
        recipe.cell(0, row, "allocated", group("plan", name));
    }
    for (row, rival) in [("one of Andersson's textures", 0), ("eight of them", 1)] {
        let source = Source::document("plan", format!("/techniques/0/rivals/{rival}/bytes"), MIB);
        recipe.cell(0, row, "allocated", source);
    }
    for name in ["indirect_frame_buffer", "shading_cache", "compact_geometry_buffer"] {
        let row = format!("Liktor's and Dachsbacher's {}", name.replace('_', " "));
        recipe.cell(0, row, "allocated", group("rivals", name));
    }
    // Bytes are told at the paper's size alone.
    let (_, scene, blur) = blurred(Effort::FULL)[0];
    let words = format!("--size 1280x720 --technique deep_shading --spp 8 --tuples 32 {blur}");
    recipe.step(Step::render("arena", "png", scene, &words));
    let accessed = || Source::document("arena", "/memory/touched_groups/deep_shading_buffer", MIB);
    recipe.cell(1, "arena, in motion and out of focus", "accessed", accessed());
    recipe.cell(
        1,
        "arena, in motion and out of focus",
        "executions a pixel",
        Source::counter("arena", "shaded_per_pixel"),
    );
    recipe.cell(1, "1.5 executions a pixel", "accessed", at_one_and_a_half(accessed()));
    recipe
}

/// What arena accesses, at the paper's executions a pixel: 16 bytes for each, beside the pointers that begin lists.
fn at_one_and_a_half(accessed: Source) -> Source {
    let rate = Source::counter("arena", "shaded_per_pixel");
    Source::combined([accessed, rate], |parts| parts[0] + (1.5 - parts[1]) * 1280.0 * 720.0 * 16.0 * MIB)
}
