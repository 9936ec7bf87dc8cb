//! How fast errors fall with the number of samples, by how these are spread.

use crate::bench::rates::{Rate, rates};
use crate::bench::sweep::axes;
use crate::papers::item::{Item, Published, Scale, Verdict};
use crate::papers::recipe::{Effort, Number, Recipe, Source, Step};

const SAMPLERS: [&str; 8] = ["relaxed", "sobol", "r2", "jittered", "random", "ign", "void-and-cluster", "blue-errors"];

/// Seeds that a mean is of.
const SEEDS: u32 = 3;

/// A bench of every sampler, by a number of samples.
struct BySamples {
    step: &'static str,
    key: &'static str,
    values: &'static [&'static str],
    seeds: u32,
}

impl BySamples {
    fn sweeps(&self) -> [String; 3] {
        let seeds: Vec<String> = (1..=self.seeds).map(|seed| seed.to_string()).collect();
        [
            format!("{}={}", self.key, self.values.join(",")),
            format!("sampler={}", SAMPLERS.join(",")),
            format!("seed={}", seeds.join(",")),
        ]
    }

    fn step(&self, scene: &str, words: &str) -> Step {
        let sweeps = self.sweeps().map(|sweep| format!("--sweep {sweep}")).join(" ");
        Step::bench(self.step, "frame", scene, 1, &format!("{words} {sweeps} --rate {}", self.key))
    }

    /// Something of a sampler's errors.
    fn source(&self, sampler: &'static str, read: impl Fn(&Rate) -> Option<f64> + 'static) -> Source {
        let (key, axes) = (self.key, axes(&self.sweeps()).expect("three keys with values"));
        Source::rows(self.step, "there are no errors of this sampler", move |rows| {
            let all = rates(key, &axes, rows.iter().copied());
            let own = all.iter().find(|rate| rate.of == format!("sampler={sampler}"))?;
            read(own).map(Number::exact)
        })
    }
}

/// The error of this index at a number of samples.
fn error(index: usize, value: f64) -> impl Fn(&Rate) -> Option<f64> {
    move |rate| rate.points.iter().find(|point| point.value == value).map(|point| point.errors[index])
}

pub const SAMPLERS_BY_EFFECT: Item = Item {
    name: "section-2.2-samplers",
    title: "Errors by the number of samples, for each way to spread them",
    place: "section 2.2",
    published: &[Published {
        title: "effect and sampler",
        unit: "error, and power of the number of samples that it falls by",
        columns: &["FLIP at 4", "FLIP at 16", "FLIP, exponent", "RMSE at 4", "RMSE at 16", "RMSE, exponent"],
        rows: &[],
        scale: Scale::ItsMachine,
    }],
    verdict: Verdict::ShapeOnly(
        "The paper takes samples of blue noise by relaxation and names no numbers: ours are against paths, means over three seeds, of its samples \
         and of seven other kinds.",
    ),
    recipe: Some(by_effect),
};

/// Effect, scene and settings.
const EFFECTS: [(&str, &str, &str); 5] = [
    ("aa", "fence:lights=4,seed=1", "--direct-shadow none"),
    ("motion", "chess:triangles=12000,seed=1", "--effect aa,motion --shutter 0,0.6 --direct-shadow ray"),
    ("defocus", "chess:triangles=12000,seed=1", "--effect aa,defocus --aperture 0.03 --direct-shadow ray"),
    ("soft-shadow", "chess:triangles=12000,seed=1", "--effect aa,soft-shadow --direct-shadow ray --light-radius 0.4"),
    ("volume", "specimen:seed=1", "--effect aa,volume --volume marschner-lobb --transfer heat --planes 24"),
];

fn by_effect(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    for (effect, scene, words) in EFFECTS {
        let bench = BySamples { step: effect, key: "samples", values: &["1", "4", "16"], seeds: effort.pick(SEEDS, 1) };
        let size =
            if effect == "volume" { effort.size(96, 96) } else { format!("{} --brdf lambert", effort.size(96, 54)) };
        let words = format!(
            "--technique interleaved_sampling --basis 2x2 {size} {words} --reference auto --reference-spp {}",
            effort.pick(1024, 64)
        );
        recipe.step(bench.step(scene, &words));
        for sampler in SAMPLERS {
            let row = format!("{effect}, {sampler}");
            for (name, index) in [("FLIP", 1), ("RMSE", 0)] {
                recipe.cell(0, &row, format!("{name} at 4"), bench.source(sampler, error(index, 4.0)));
                recipe.cell(0, &row, format!("{name} at 16"), bench.source(sampler, error(index, 16.0)));
                let exponent = bench.source(sampler, move |rate| rate.exponents[index]);
                recipe.cell(0, &row, format!("{name}, exponent"), exponent);
            }
        }
    }
    recipe
}

const fn flip(title: &'static str, columns: &'static [&'static str]) -> Published {
    Published { title, unit: "FLIP", columns, rows: &[], scale: Scale::ItsMachine }
}

pub const SAMPLERS_ELSEWHERE: Item = Item {
    name: "section-3.4-samplers",
    title: "The same ways to spread samples in the techniques of other papers",
    place: "section 3.4",
    published: &[
        flip("tuples of deep shading, of 16, 32 and 32", &["4", "8", "16"]),
        flip("iterations of soft shadows in tiles", &["1", "2", "4", "8"]),
        flip("iterations of ambient occlusion in tiles", &["1", "2", "4", "8"]),
    ],
    verdict: Verdict::ShapeOnly(
        "The paper says that its technique generalises, and names no numbers: ours are against paths, means over three seeds.",
    ),
    recipe: Some(elsewhere),
};

fn elsewhere(effort: Effort) -> Recipe {
    let mut recipe = Recipe::default();
    let spp = effort.pick(1024, 64);
    let square = effort.size(96, 96);
    // Soft shadows and ambient occlusion have no samples within pixels: what they are held against has none either.
    let middles =
        format!("--technique path_traced {square} --spp {spp} --pixel middle --brdf lambert --transport direct");
    for (step, words) in [
        ("soft-shadow-paths", "--emissive on --ambient-visibility off"),
        ("occlusion-paths", "--ambient 0.5 --direct-light off --ambient-visibility seen"),
    ] {
        recipe.step(Step::render(step, "exr", "cornell:seed=1", &format!("{middles} {words}")));
    }
    let tiles = format!("--technique adaptive_interleaved {square} --mode max");
    for (table, step, key, scene, words) in [
        (
            0,
            "tuples",
            "spp",
            "chess:triangles=12000,seed=1",
            format!(
                "--technique deep_shading {} --brdf lambert --direct-shadow none --aperture 0.3 --focus 8 --shutter 0,0.3 \
                 --reference auto --reference-spp {spp}",
                effort.size(96, 54)
            ),
        ),
        (
            1,
            "soft-shadow",
            "ss-max",
            "cornell:seed=1",
            format!("{tiles} --emissive on --components ss --reference @soft-shadow-paths.exr"),
        ),
        (
            2,
            "occlusion",
            "ao-max",
            "cornell:seed=1",
            format!("{tiles} --ambient 0.5 --components ao --reference @occlusion-paths.exr"),
        ),
    ] {
        let values = SAMPLERS_ELSEWHERE.published[table].columns;
        let bench = BySamples { step, key, values, seeds: effort.pick(SEEDS, 1) };
        recipe.step(bench.step(scene, &words));
        for sampler in SAMPLERS {
            for value in values {
                let number = value.parse().expect("a number of samples");
                recipe.cell(table, sampler, *value, bench.source(sampler, error(1, number)));
            }
        }
    }
    recipe
}
