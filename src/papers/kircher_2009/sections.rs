//! What follows from its text: bytes, light lost in half floats, and how lights are drawn.

use crate::papers::figures;
use crate::papers::item::{Item, Published, Scale, Verdict};
use crate::papers::recipe::{Effort, Recipe, Source, Step};

const MIB: f64 = 1.0 / 1_048_576.0;

/// Normals (2 x 16 bits), DSF data (2 x 16), light (4 x 16) and depth (24 and 8) of section 2, a texel.
const BYTES_A_TEXEL: f64 = 4.0 + 4.0 + 8.0 + 4.0;

pub const BYTES: Item = Item {
    name: "bytes",
    title: "What the buffers take at the light buffer's size and at the picture's",
    place: "sections 2.1, 2.2 and 3",
    published: &[Published {
        title: "size",
        unit: "MiB",
        columns: &["by the formats of the text (computed)", "planned"],
        rows: &[],
        scale: Scale::ItsMachine,
    }],
    verdict: Verdict::Comparable(
        "The paper gives formats and no bytes: what is computed from them is beside what is planned here. Depth and stencil take 5 bytes on lavapipe, not 4.",
    ),
    recipe: Some(bytes),
};

fn bytes(_: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    for (size, texels) in [("800x450", 800.0 * 450.0), ("1280x720", 1280.0 * 720.0)] {
        let computed = Source::Computed(texels * BYTES_A_TEXEL * MIB);
        recipe.cell(0, size, "by the formats of the text (computed)", computed);
        let words = format!(
            "--plan --technique inferred_lighting --size 1280x720 --light-size {size} --extras off --volumes both"
        );
        recipe.step(Step::memory(size, "lamps", &words));
        let buffers = &["geometry.normal", "geometry.dsf", "light.l_buffer", "geometry.depth"];
        recipe.cell(0, size, "planned", Source::planned(size, buffers, MIB));
    }
    recipe
}

pub const SECTION_2_2: Item = Item {
    name: "section-2.2",
    title: "Light lost by adding lights up in half floats",
    place: "section 2.2",
    published: &[Published {
        title: "lights",
        unit: "part of the light that is left",
        columns: &["half floats"],
        rows: &[],
        scale: Scale::ItsMachine,
    }],
    verdict: Verdict::ShapeOnly(
        "The paper names 16 bits a channel and no loss; ours is against sums of 32 bits, by the means of the pictures.",
    ),
    recipe: Some(section_2_2),
};

fn section_2_2(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    for lights in [1, 81, 287] {
        let step = |kind: &str| format!("{lights}-{kind}");
        for kind in ["float", "half"] {
            let words = format!(
                "--technique inferred_lighting {} --brdf lambert --volumes scissor --l-buffer {kind}",
                effort.size(1280, 720)
            );
            recipe.step(Step::render(step(kind), "exr", &format!("lamps:lights={lights}"), &words));
        }
        let channel = |kind: &str, index: u32| Source::document(step(kind), format!("/image/mean/{index}"), 1.0);
        let all = ["half", "float"].into_iter().flat_map(|kind| (0..3).map(move |index| (kind, index)));
        let parts: Vec<Source> = all.map(|(kind, index)| channel(kind, index)).collect();
        let left = Source::combined(parts, |parts| parts[..3].iter().sum::<f64>() / parts[3..].iter().sum::<f64>());
        recipe.cell(0, lights.to_string(), "half floats", left);
    }
    recipe
}

pub const VOLUMES: Item = Item {
    name: "volumes",
    title: "Ways to find the texels of a light, and from which size on the stencil pays",
    place: "section 2.2",
    published: &[Published {
        title: "way",
        unit: "ms",
        columns: &["frame"],
        rows: &[],
        scale: Scale::PartsOfRow("--volumes quad"),
    }],
    verdict: Verdict::ShapeOnly(
        "The paper says that rectangles and stencil should be used together, and the stencil not for small lights, without numbers.",
    ),
    recipe: Some(volumes),
};

fn volumes(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let (scene, size) = ("lamps:objects=287,lights=287", effort.size(1280, 720));
    let inferred = format!("--technique inferred_lighting {size}");
    for (step, key, values, more) in [
        ("methods", "volumes", &["quad", "scissor", "stencil", "both", "auto", "tiled"][..], ""),
        (
            "least",
            "stencil-least",
            &["0", "64", "256", "1024", "4096", "16384", "65536", "268435456"],
            "--volumes auto",
        ),
    ] {
        let words = format!("{inferred} {more} --sweep {key}={}", values.join(","));
        recipe.step(Step::bench(step, "frame", scene, 7, &words));
        for value in values {
            let source = Source::row(step, format!("{key}={value}"), figures::ms());
            recipe.cell(0, format!("--{key} {value}"), "frame", source);
        }
    }
    recipe
}
