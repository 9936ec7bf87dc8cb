//! Its figures of pictures and frame times.

use crate::papers::figures;
use crate::papers::item::{Item, Published, Scale, Verdict};
use crate::papers::recipe::{Effort, Recipe, Source, Step};

const INFERRED: &str = "--technique inferred_lighting";

pub const FIGURE_1: Item = Item {
    name: "figure-1",
    title: "213 lights at 1280x720, multisampled",
    place: "page 1",
    published: &[
        Published {
            title: "device",
            unit: "ms",
            columns: &["frame"],
            rows: &[("GeForce 8800 GTX, 8 samples", &[43.5])],
            scale: Scale::ItsMachine,
        },
        Published {
            title: "way",
            unit: "times as fast",
            columns: &["over forward"],
            rows: &[],
            scale: Scale::ItsMachine,
        },
        Published {
            title: "against forward",
            unit: "error",
            columns: &["flip", "rmse"],
            rows: &[],
            scale: Scale::ItsMachine,
        },
    ],
    verdict: Verdict::ShapeOnly(
        "The time is of a GPU of 2006 and the scene a game's; ours is a yard with as many lights. Software drivers have 4 samples a pixel: \
         ours are 4 of the paper's 8.",
    ),
    recipe: Some(figure_1),
};

fn figure_1(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let (scene, size) = ("fence:lights=213", effort.size(1280, 720));
    for (step, technique) in [("inferred", "inferred_lighting"), ("forward", "forward")] {
        recipe.step(Step::render(step, "png", scene, &format!("--technique {technique} --msaa 4 {size}")));
        recipe.picture(step, format!("{step}.png"));
    }
    recipe.errors(2, "inferred_lighting", ["inferred.png", "forward.png"], &["flip", "rmse"]);
    let words = format!("--technique forward {size} --msaa 4 --sweep technique=forward,inferred_lighting");
    recipe.step(Step::bench("frame", "frame", scene, 7, &words));
    for technique in ["inferred_lighting", "forward"] {
        let row = || Source::row("frame", format!("technique={technique}"), figures::ms());
        recipe.cell(0, format!("this device, 4 samples, {technique}"), "frame", row());
    }
    let faster = Source::row("frame", "technique=inferred_lighting", figures::times_as_fast());
    recipe.cell(1, "inferred_lighting", "over forward", faster);
    recipe
}

pub const FIGURE_2: Item = Item {
    name: "figure-2",
    title: "The four buffers",
    place: "section 2",
    published: &[],
    verdict: Verdict::ShapeOnly("Pictures of the same buffers, of another scene."),
    recipe: Some(figure_2),
};

fn figure_2(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let stages = [
        ("normals", "geometry.normal"),
        ("DSF data: ids", "geometry.dsf.id"),
        ("DSF data: depths", "geometry.dsf.depth"),
        ("light", "light.l_buffer.irradiance"),
        ("highlights", "light.l_buffer.highlight"),
    ];
    let names = stages.map(|(_, stage)| stage).join(",");
    recipe.step(Step::render(
        "buffers",
        "png",
        "lamps",
        &format!("{INFERRED} {} --aov {names}", effort.size(1280, 720)),
    ));
    for (title, stage) in stages {
        recipe.picture(title, format!("buffers.{stage}.png"));
    }
    recipe.picture("the picture", "buffers.png");
    recipe
}

pub const FIGURE_4: Item = Item {
    name: "figure-4",
    title: "One texel of four that does not belong to the surface",
    place: "section 3",
    published: &[],
    verdict: Verdict::NotHere(
        "It is a drawing of the rule by which texels are rejected. A test has the same case, texel for texel; figure-3 shows what it does.",
    ),
    recipe: None,
};

pub const FIGURE_5: Item = Item {
    name: "figure-5",
    title: "Glass in the light buffer, and in the picture",
    place: "section 4",
    published: &[],
    verdict: Verdict::ShapeOnly("Pictures of the same buffers, of another scene."),
    recipe: Some(figure_5),
};

fn figure_5(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let words = format!("{INFERRED} {} --aov light.l_buffer.irradiance,geometry.dsf.id", effort.size(1280, 720));
    recipe.step(Step::render("stipple", "png", "fence", &words));
    recipe.picture("light buffer", "stipple.light.l_buffer.irradiance.png");
    recipe.picture("ids", "stipple.geometry.dsf.id.png");
    recipe.picture("the picture", "stipple.png");
    recipe
}

pub const FIGURE_6: Item = Item {
    name: "figure-6",
    title: "A shadow on layers of glass",
    place: "section 4",
    published: &[],
    verdict: Verdict::ShapeOnly(
        "The paper shows the blade of a helicopter over three layers of glass; ours is a rotor over panes.",
    ),
    recipe: Some(figure_6),
};

fn figure_6(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let words = format!("{INFERRED} {} --camera rotor --volumes scissor --shadow-volumes 122", effort.size(1280, 720));
    recipe.step(Step::render("shadow", "png", "fence", &words));
    recipe.picture("with a shadow volume", "shadow.png");
    recipe
}

pub const FIGURE_7: Item = Item {
    name: "figure-7",
    title: "287 lights and 287 objects",
    place: "section 6",
    published: &[
        Published {
            title: "device",
            unit: "ms",
            columns: &["frame"],
            rows: &[("PlayStation 3", &[5.03])],
            scale: Scale::ItsMachine,
        },
        Published {
            title: "way",
            unit: "times as fast",
            columns: &["over forward"],
            rows: &[],
            scale: Scale::ItsMachine,
        },
    ],
    verdict: Verdict::ShapeOnly("The time is of a console; the scene is ours, with as many lights and objects."),
    recipe: Some(figure_7),
};

fn figure_7(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let (scene, size) = ("lamps:objects=287,lights=287", effort.size(1280, 720));
    recipe.step(Step::render("picture", "png", scene, &format!("{INFERRED} {size}")));
    recipe.picture("inferred_lighting", "picture.png");
    let words = format!("{size} --sweep technique=forward,inferred_lighting,deferred");
    recipe.step(Step::bench("frame", "frame", scene, 7, &words));
    for technique in ["inferred_lighting", "forward", "deferred"] {
        let variant = format!("technique={technique}");
        recipe.cell(0, format!("this device, {technique}"), "frame", Source::row("frame", &variant, figures::ms()));
        recipe.cell(1, technique, "over forward", Source::row("frame", variant, figures::times_as_fast()));
    }
    recipe
}

const FORWARD: &str = "forward";

pub const FIGURE_8: Item = Item {
    name: "figure-8",
    title: "101 objects and 81 lights, and frames from no light to 512",
    place: "section 6",
    published: &[
        Published {
            title: "way",
            unit: "ms",
            columns: &["Xbox 360"],
            rows: &[(FORWARD, &[167.0]), ("inferred_lighting", &[29.4])],
            scale: Scale::PartsOfRow(FORWARD),
        },
        Published { title: "lights", unit: "ms", columns: &[], rows: &[], scale: Scale::ItsMachine },
        Published {
            title: "straight line",
            unit: "ms",
            columns: &["ms without lights", "ms a light"],
            rows: &[],
            scale: Scale::ItsMachine,
        },
        Published {
            title: "inferred lighting is the faster one",
            unit: "lights",
            columns: &["from"],
            rows: &[],
            scale: Scale::ItsMachine,
        },
    ],
    verdict: Verdict::ShapeOnly(
        "Times are of a console; the scene is ours, with as many lights and objects. The paper says that forward grows with objects times \
         lights and inferred lighting with their sum (section 6), and that it costs more where lights are few (7.1): the lines of ours say by \
         how much. Our forward has a list of lights for each object, which the paper's optimised one may have had too.",
    ),
    recipe: Some(figure_8),
};

const LIGHTS: [u32; 8] = [0, 16, 32, 64, 81, 128, 256, 512];

fn figure_8(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let size = effort.size(1280, 720);
    for brdf in ["lambert", "ggx"] {
        let step = |lights: u32| format!("{brdf}-{lights}");
        for lights in LIGHTS {
            let words = format!("--rig none --brdf {brdf} {size} --sweep technique=forward,inferred_lighting,deferred");
            recipe.step(Step::bench(step(lights), "frame", &format!("lamps:lights={lights}"), 7, &words));
            for technique in [FORWARD, "inferred_lighting", "deferred"] {
                let source = Source::row(step(lights), format!("technique={technique}"), figures::ms());
                recipe.cell(1, format!("{lights}"), format!("{technique}, {brdf}"), source);
            }
        }
        let all = |technique: &str| -> Vec<Source> {
            let source = |lights: u32| Source::row(step(lights), format!("technique={technique}"), figures::ms());
            LIGHTS.into_iter().map(source).collect()
        };
        for technique in [FORWARD, "inferred_lighting", "deferred"] {
            let row = format!("{technique}, {brdf}");
            recipe.cell(2, &row, "ms without lights", Source::combined(all(technique), |ms| line(ms)[0]));
            recipe.cell(2, &row, "ms a light", Source::combined(all(technique), |ms| line(ms)[1]));
        }
        let both = all("inferred_lighting").into_iter().chain(all(FORWARD));
        recipe.cell(3, brdf, "from", Source::combined(both, crossing));
    }
    for technique in [FORWARD, "inferred_lighting"] {
        let source = Source::row("ggx-81", format!("technique={technique}"), figures::ms());
        recipe.cell(0, technique, "Xbox 360", source);
    }
    recipe
}

/// Milliseconds without lights, and a light, of the line that lies nearest to times at `LIGHTS`.
fn line(ms: &[f64]) -> [f64; 2] {
    let count = LIGHTS.len() as f64;
    let x = LIGHTS.map(f64::from);
    let (mean_x, mean_y) = (x.iter().sum::<f64>() / count, ms.iter().sum::<f64>() / count);
    let over: f64 = x.iter().zip(ms).map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    let slope = over / x.iter().map(|x| (x - mean_x).powi(2)).sum::<f64>();
    [mean_y - slope * mean_x, slope]
}

/// The number of lights at which the lines of the first and of the second half meet.
fn crossing(ms: &[f64]) -> f64 {
    let (first, second) = ms.split_at(LIGHTS.len());
    let ([base, slope], [other_base, other_slope]) = (line(first), line(second));
    (base - other_base) / (other_slope - slope)
}

pub const FIGURE_10: Item = Item {
    name: "figure-10",
    title: "Chain-link lit as glass, and tested by alpha",
    place: "section 6",
    published: &[Published {
        title: "against forward with 64 samples",
        unit: "error",
        columns: &["flip", "rmse"],
        rows: &[],
        scale: Scale::ItsMachine,
    }],
    verdict: Verdict::ShapeOnly("The paper shows a picture without numbers; errors are ours."),
    recipe: Some(figure_10),
};

fn figure_10(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let common = format!("{} --camera fence", effort.size(1280, 720));
    recipe.step(Step::render("forward", "png", "fence", &format!("--technique forward --supersample 8 {common}")));
    recipe.picture("forward, 64 samples", "forward.png");
    for way in ["blend", "test"] {
        recipe.step(Step::render(way, "png", "fence", &format!("{INFERRED} {common} --msaa 4 --alpha {way}")));
        recipe.errors(0, &format!("--alpha {way}"), [&format!("{way}.png"), "forward.png"], &["flip", "rmse"]);
        recipe.picture(format!("--alpha {way}"), format!("{way}.png"));
    }
    recipe
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_meet_where_their_formulas_do() {
        let ms = |base: f64, slope: f64| LIGHTS.map(|lights| base + slope * f64::from(lights)).to_vec();
        let [base, slope] = line(&ms(3.0, 0.25));
        assert!((base - 3.0).abs() < 1e-9 && (slope - 0.25).abs() < 1e-9);
        // 10 + 0.1 n = 2 + 0.5 n at n = 20.
        assert!((crossing(&[ms(10.0, 0.1), ms(2.0, 0.5)].concat()) - 20.0).abs() < 1e-9);
    }
}
