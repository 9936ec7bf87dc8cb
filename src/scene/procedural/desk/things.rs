//! What is on the desk: what has its place, and small things that lie between.

use glam::{DAffine3, DMat3, DVec2, DVec3, dvec2, dvec3};

use crate::sampling::pcg::Pcg32;
use crate::scene::procedural::assembly::Assembly;
use crate::scene::procedural::desk::materials::{DESK_M, Materials};
use crate::scene::procedural::patch::{Patch, around_y, bent, moved, placed};
use crate::scene::procedural::room::{SUNK_M, standing, stood};
use crate::scene::procedural::shapes::{Curve, cuboid_of, sphere, tube, turned};
use crate::scene::procedural::solids::{chamfered, pierced};
use crate::scene::procedural::wares::{
    apple, between, book, bowl, clip, leaves, lying_book, mug, pencil, pot, sheet, turning,
};

/// Middles and radii of what has its place: small things lie elsewhere.
const TAKEN: [([f64; 2], f64); 10] = [
    ([-0.44, -0.20], 0.12),
    ([-0.03, 0.11], 0.20),
    ([0.33, 0.13], 0.14),
    ([0.21, -0.12], 0.09),
    ([-0.20, -0.25], 0.06),
    ([0.03, -0.25], 0.13),
    ([0.48, -0.20], 0.21),
    ([-0.42, 0.14], 0.19),
    ([0.58, 0.13], 0.12),
    ([-0.62, -0.1], 0.1),
];

/// Patches by colour.
type Colored = [Vec<Patch>; 6];

fn on_desk(x: f64, z: f64) -> DVec3 {
    dvec3(x, DESK_M.y, z)
}

/// Turns what stands into what lies along +x.
fn laid() -> DAffine3 {
    DAffine3::from_mat3(DMat3::from_cols(DVec3::NEG_Y, DVec3::X, DVec3::Z))
}

/// All of it, `count` small things among it.
pub fn add(assembly: &mut Assembly, materials: &Materials, count: u32, random: &mut Pcg32) {
    let mut colored = Colored::default();
    let mut paper = Vec::new();
    let mut wood = Vec::new();
    let mut lead = Vec::new();
    books(&mut colored, &mut paper, random);
    papers(assembly, materials, &mut colored, &mut paper);
    let mut loose = |colored: &mut Colored, place: DAffine3, random: &mut Pcg32| {
        let [body, tip, point] = pencil(between(random, 0.11, 0.165));
        colored[random.below(6) as usize].extend(placed(body, place));
        wood.extend(placed(tip, place));
        lead.extend(placed(point, place));
    };
    // In the pot, and two on the notebook.
    let stand = on_desk(-0.20, -0.25);
    for index in 0..8_u32 {
        let (sine, cosine) = (between(random, 0.1, 0.2), 1.0);
        let lean =
            DMat3::from_cols(dvec3(cosine, -sine, 0.0).normalize(), dvec3(sine, cosine, 0.0).normalize(), DVec3::Z);
        let foot = DAffine3::from_translation(dvec3(0.008, 0.0, 0.0)) * DAffine3::from_mat3(lean);
        let way = around_y(0.125 * f64::from(index) + between(random, -0.03, 0.03));
        loose(&mut colored, DAffine3::from_translation(stand + DVec3::Y * 0.005) * way * foot, random);
    }
    for [x, z, turns] in [[0.07, 0.17, 0.19], [-0.17, 0.26, 0.04]] {
        let height = if x > 0.0 { 0.0175 } else { 0.003 };
        let at = DAffine3::from_translation(on_desk(x, z) + DVec3::Y * height);
        loose(&mut colored, at * around_y(turns) * laid(), random);
    }
    vessels(assembly, materials, random);
    let clip = assembly.mesh("clip", materials.steel, &clip(5, 40));
    let coin = Curve::lines(&[[0.0, 0.0], [0.0115, 0.0], [0.0115, 0.002], [0.0, 0.002]]);
    let coin = assembly.mesh("coin", materials.clay, &turned(&coin, turning(20, 1.0)));
    for (index, at) in free_places(count, random).into_iter().enumerate() {
        let at = on_desk(at.x, at.y);
        let turns = f64::from(random.unit());
        let color = random.below(6) as usize;
        match [0, 1, 0, 2, 3, 0, 4, 1, 5][index % 9] {
            0 => assembly.draw(clip, standing(turns, at + DVec3::Y * SUNK_M)),
            1 => assembly.draw(coin, standing(turns, at)),
            2 => {
                let half = dvec3(0.012, 0.0, 0.022);
                colored[4].extend(stood(chamfered(-half, half.with_y(0.012), 0.0015, 0.1), turns, at));
            }
            3 => {
                let half = dvec3(0.008, 0.0, 0.008);
                colored[color].extend(stood(chamfered(-half, half.with_y(0.016), 0.0015, 0.1), turns, at));
            }
            4 => colored[color].extend(moved(sphere(0.009, 14), at + DVec3::Y * 0.0088)),
            _ => {
                let place = DAffine3::from_translation(at + DVec3::Y * 0.003) * around_y(turns);
                let mid = DAffine3::from_translation(dvec3(-0.03, 0.0, 0.0)) * laid();
                let [body, tip, point] = pencil(0.05);
                colored[color].extend(placed(body, place * mid));
                paper.extend(placed(tip, place * mid));
                paper.extend(placed(point, place * mid));
            }
        }
    }
    let names = ["red", "navy", "green", "yellow", "cream", "teal"].map(|color| format!("{color}_things"));
    let all = names.into_iter().zip(colored).zip(materials.colors);
    let rest = [
        (("paper_things".to_owned(), paper), materials.paper),
        (("pencil_tips".to_owned(), wood), materials.wood),
        (("pencil_leads".to_owned(), lead), materials.charcoal),
    ];
    for ((name, patches), material) in all.chain(rest) {
        if !patches.is_empty() {
            assembly.fixed(&name, material, &patches);
        }
    }
}

/// `count` places on the part of the desk that is seen, apart from each other and from what has its place; fewer
/// where no more are found.
fn free_places(count: u32, random: &mut Pcg32) -> Vec<DVec2> {
    const APART_M: f64 = 0.045;
    let mut places: Vec<DVec2> = Vec::new();
    for _ in 0..200 * count {
        if places.len() == count as usize {
            break;
        }
        let at = dvec2(between(random, -0.6, 0.66), between(random, -0.3, 0.36));
        let is_free = TAKEN.iter().all(|([x, z], radius)| at.distance(dvec2(*x, *z)) > radius + 0.015)
            && places.iter().all(|place| at.distance(*place) > APART_M);
        if is_free {
            places.push(at);
        }
    }
    places
}

/// A heap of books that lie, and a row of books that stand.
fn books(colored: &mut Colored, paper: &mut Vec<Patch>, random: &mut Pcg32) {
    let mut put = |[cover, pages]: [Vec<Patch>; 2], color: usize, place: DAffine3| {
        colored[color].extend(placed(cover, place));
        paper.extend(placed(pages, place));
    };
    let mut top = on_desk(0.48, -0.20);
    for (color, size, turns) in [
        (1, dvec3(0.25, 0.038, 0.18), 0.02),
        (0, dvec3(0.23, 0.026, 0.165), -0.035),
        (3, dvec3(0.20, 0.034, 0.14), 0.06),
        (5, dvec3(0.175, 0.018, 0.12), -0.02),
    ] {
        let place = DAffine3::from_translation(top - DVec3::Y * SUNK_M) * around_y(turns);
        put(lying_book(size), color, place);
        top.y += size.y - SUNK_M;
    }
    let mut x = -0.085;
    for color in [2, 4, 0, 1, 5] {
        let size = dvec3(between(random, 0.02, 0.038), between(random, 0.17, 0.225), between(random, 0.13, 0.155));
        let z = -0.185 - size.z - between(random, 0.0, 0.01);
        put(book(size), color, DAffine3::from_translation(on_desk(x, z) - DVec3::Y * SUNK_M));
        x += size.x + 0.001;
    }
}

/// An open notebook, loose sheets, a block of notes, a picture in a frame.
fn papers(assembly: &mut Assembly, materials: &Materials, colored: &mut Colored, paper: &mut Vec<Patch>) {
    let notebook = DAffine3::from_translation(on_desk(-0.03, 0.11) - DVec3::Y * SUNK_M) * around_y(0.035);
    let cover = cuboid_of(dvec3(-0.155, 0.0, -0.11), dvec3(0.155, 0.004, 0.11), 0.1, [1; 3]);
    colored[1].extend(placed(cover, notebook));
    for side in [0.0, 0.5] {
        let half = cuboid_of(dvec3(0.001, 0.003, -0.105), dvec3(0.149, 0.015, 0.105), 0.1, [10, 1, 1]);
        // Highest near the fold, into which the leaves dive.
        let leaves = bent(half, |at| {
            let x = at.x / 0.149;
            let rise = (1.0 - (1.0 - (7.0 * x).min(1.0)) * (1.0 - (7.0 * x).min(1.0))) * (1.0 - 0.45 * x * x);
            dvec3(at.x, 0.003 + (at.y - 0.003) * (0.25 + 0.75 * rise), at.z)
        });
        paper.extend(placed(leaves.collect(), notebook * around_y(side)));
    }
    for (index, turns) in [0.06, -0.045, 0.02].into_iter().enumerate() {
        let up = DVec3::Y * (0.0016 * index as f64 + SUNK_M + 0.0002);
        let curl = if index == 2 { 0.03 } else { 0.0 };
        paper.extend(stood(sheet([0.21, 0.297], curl), turns, on_desk(-0.42, 0.14) + up));
    }
    let notes = chamfered(dvec3(-0.038, 0.0, -0.038), dvec3(0.038, 0.022, 0.038), 0.001, 0.1);
    colored[3].extend(stood(notes, 0.08, on_desk(-0.40, 0.10) + DVec3::Y * 0.0045));
    // A ruler across the sheets.
    let ruler = chamfered(dvec3(-0.155, 0.0, -0.017), dvec3(0.155, 0.003, 0.017), 0.001, 0.1);
    assembly.fixed(
        "ruler",
        materials.wood,
        &stood(ruler, 0.03, on_desk(-0.45, 0.235) + DVec3::Y * 0.0055).collect::<Vec<_>>(),
    );
    let half = dvec2(0.065, 0.085);
    let rim = DVec2::splat(0.012);
    let lean = DAffine3::from_translation(on_desk(-0.62, -0.1) + DVec3::Y * 0.083)
        * around_y(0.1)
        * DAffine3::from_mat3(DMat3::from_cols(
            DVec3::X,
            dvec3(0.0, 0.97, -0.24).normalize(),
            dvec3(0.0, 0.24, 0.97).normalize(),
        ));
    let frame = placed(pierced([-half, half], [rim - half, half - rim], 0.014, 0.1), lean);
    assembly.fixed("frame", materials.clay, &frame.collect::<Vec<_>>());
    let inner = half - 0.9 * rim;
    let back = cuboid_of((-inner).extend(-0.012), inner.extend(-0.006), 0.1, [1; 3]);
    assembly.fixed("print", materials.china, &placed(back, lean).collect::<Vec<_>>());
}

/// A mug, a pot for pencils, a bowl of apples, a plant.
fn vessels(assembly: &mut Assembly, materials: &Materials, random: &mut Pcg32) {
    let mut put = |name: &str, material: usize, patches: Vec<Patch>, turns: f64, at: DVec3| {
        assembly.fixed(name, material, &stood(patches, turns, at).collect::<Vec<_>>());
    };
    put("mug", materials.china, mug(32), 0.1, on_desk(0.21, -0.12));
    let coffee = tube(DVec3::Y * 0.05, DVec3::Y * 0.078, 0.0375, 32);
    put("coffee", materials.soil, coffee, 0.0, on_desk(0.21, -0.12));
    put("pencil_pot", materials.clay, pot([0.036, 0.04], 0.095, 0.003, 32), 0.0, on_desk(-0.20, -0.25));
    let bowl_at = on_desk(0.33, 0.13);
    put("bowl", materials.china, bowl(0.115, 44), 0.0, bowl_at);
    for (index, (x, y, z, color)) in
        [(-0.036, 0.012, 0.02, 0), (0.038, 0.013, 0.022, 3), (0.0, 0.014, -0.042, 0), (0.002, 0.06, 0.002, 2)]
            .into_iter()
            .enumerate()
    {
        let turns = 0.3 * index as f64;
        let radius = between(random, 0.033, 0.036);
        let at = bowl_at + dvec3(x, y, z);
        put("apple", materials.colors[color], apple(radius, 22), turns, at);
        let stalk = at + dvec3(0.0, 1.45 * radius, 0.0);
        put("stalk", materials.soil, tube(DVec3::ZERO, dvec3(0.003, 0.02, 0.001), 0.0012, 6), turns, stalk);
    }
    let plant = on_desk(0.58, 0.13);
    put("flower_pot", materials.clay, pot([0.042, 0.056], 0.085, 0.004, 32), 0.0, plant);
    put("soil", materials.soil, tube(DVec3::Y * 0.06, DVec3::Y * 0.07, 0.0485, 24), 0.0, plant);
    put("plant", materials.leaf, leaves(20, 0.17, random), 0.0, plant + DVec3::Y * 0.066);
}
