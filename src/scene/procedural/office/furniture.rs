//! Desks with what stands on them, chairs, shelves. Each is made on y = 0 around the y axis; who sits at a desk, or
//! on a chair, looks along -z.

use glam::{DAffine3, DVec3, dvec3};

use crate::sampling::pcg::Pcg32;
use crate::scene::procedural::assembly::Assembly;
use crate::scene::procedural::office::materials::Materials;
use crate::scene::procedural::patch::{Detail, Patch, around_y, bent, placed};
use crate::scene::procedural::room::{SUNK_M, standing, stood};
use crate::scene::procedural::shapes::{bar, cuboid, cuboid_of, prism, tube};
use crate::scene::procedural::solids::{chamfered, open_box};
use crate::scene::procedural::wares::{between, book, lying_book, mug, pencil, pot, sheet, vase};

/// Height of a desk's top, and its width and depth.
pub const DESK_M: DVec3 = dvec3(1.4, 0.74, 0.7);

fn solid(low: [f64; 3], high: [f64; 3]) -> Vec<Patch> {
    cuboid(low.into(), high.into(), 0.6, Detail::COARSE)
}

/// Index of each mesh that is used more than once.
pub struct Meshes {
    desk: [usize; 3],
    chair: [usize; 2],
    monitor: [usize; 2],
    keyboard: [usize; 2],
    mouse: usize,
    mug: usize,
    pot: usize,
    sheet: usize,
}

impl Meshes {
    pub fn add(assembly: &mut Assembly, materials: &Materials) -> Self {
        let [top, frame, drawers] = desk();
        let [wood, cushion] = chair();
        let [case, screen] = monitor();
        let [board, keys] = keyboard();
        let mouse = bent(cuboid_of(dvec3(-0.03, 0.0, -0.05), dvec3(0.03, 0.03, 0.05), 0.1, [4, 2, 5]), |at| {
            // Rounder the higher: a loaf.
            let narrow = 1.0 - 120.0 * at.y * at.y;
            let back = 1.0 - 260.0 * at.z * at.z;
            dvec3(at.x * narrow * (0.6 + 0.4 * back), at.y * (0.25 + 0.75 * back), at.z * narrow)
        });
        Self {
            desk: [
                assembly.mesh("desk_top", materials.beech, &top),
                assembly.mesh("desk_frame", materials.steel, &frame),
                assembly.mesh("desk_drawers", materials.lacquer, &drawers),
            ],
            chair: [
                assembly.mesh("chair", materials.beech, &wood),
                assembly.mesh("chair_cushion", materials.cushion, &cushion),
            ],
            monitor: [
                assembly.mesh("monitor", materials.charcoal, &case),
                assembly.mesh("monitor_screen", materials.screen, &screen),
            ],
            keyboard: [
                assembly.mesh("keyboard", materials.charcoal, &board),
                assembly.mesh("keyboard_keys", materials.keys, &keys),
            ],
            mouse: assembly.mesh("mouse", materials.charcoal, &mouse.collect::<Vec<_>>()),
            mug: assembly.mesh("mug", materials.china, &mug(12)),
            pot: assembly.mesh("pencil_pot", materials.clay, &pot([0.034, 0.038], 0.1, 0.003, 14)),
            sheet: assembly.mesh("sheet", materials.paper, &sheet([0.21, 0.297], 0.008)),
        }
    }

    /// A desk at `at` on the floor, turned by `turns`, with what one works with on it.
    pub fn desk(&self, assembly: &mut Assembly, loose: &mut Loose, turns: f64, at: DVec3, random: &mut Pcg32) {
        self.desk.iter().for_each(|mesh| assembly.draw(*mesh, standing(turns, at)));
        // A place on the top, by right and toward the sitter.
        let turned = around_y(turns);
        let on = move |x: f64, z: f64| at + turned.transform_vector3(dvec3(x, DESK_M.y - SUNK_M, z));
        // Each desk tosses for the hand that its owner writes with.
        let side = if random.below(2) == 0 { -1.0 } else { 1.0 };
        let aside = between(random, -0.04, 0.04);
        self.monitor.iter().for_each(|mesh| assembly.draw(*mesh, standing(turns + 0.1 * aside, on(aside, -0.16))));
        let skew = between(random, -0.01, 0.01);
        self.keyboard.iter().for_each(|mesh| assembly.draw(*mesh, standing(turns + skew, on(aside, 0.17))));
        assembly.draw(self.mouse, standing(turns + skew, on(aside + 0.3, 0.18)));
        let cup = on(side * between(random, 0.4, 0.46), between(random, -0.02, 0.08));
        assembly.draw(self.mug, standing(f64::from(random.unit()), cup));
        let pot = on(-side * between(random, 0.42, 0.5), -0.22);
        assembly.draw(self.pot, standing(0.0, pot));
        for index in 0..2 + random.below(4) {
            loose.pencil(pot, index, random);
        }
        let heap = on(-side * 0.5, 0.08);
        for layer in 0..2 + random.below(3) {
            let up = DVec3::Y * (0.0012 * f64::from(layer) + SUNK_M + 0.0002);
            assembly.draw(self.sheet, standing(turns + between(random, -0.04, 0.04), heap + up));
        }
        let mut top = on(side * 0.53, -0.18);
        for _ in 0..2 + random.below(3) {
            let size = dvec3(between(random, 0.19, 0.24), between(random, 0.02, 0.045), between(random, 0.14, 0.18));
            loose.lying(size, turns + between(random, -0.06, 0.06), top, random);
            top.y += size.y - SUNK_M;
        }
    }

    /// A chair at `at` on the floor, turned by `turns`.
    pub fn chair(&self, assembly: &mut Assembly, turns: f64, at: DVec3) {
        self.chair.iter().for_each(|mesh| assembly.draw(*mesh, standing(turns, at)));
    }
}

/// Things of which no two are alike, gathered by what they are made of.
#[derive(Default)]
pub struct Loose {
    covers: [Vec<Patch>; 6],
    paper: Vec<Patch>,
    wood: Vec<Patch>,
    lead: Vec<Patch>,
    china: Vec<Patch>,
}

impl Loose {
    fn book(&mut self, [cover, pages]: [Vec<Patch>; 2], place: DAffine3, random: &mut Pcg32) {
        self.covers[random.below(6) as usize].extend(placed(cover, place));
        self.paper.extend(placed(pages, place));
    }

    fn lying(&mut self, size_m: DVec3, turns: f64, at: DVec3, random: &mut Pcg32) {
        let place = DAffine3::from_translation(at - DVec3::Y * SUNK_M) * around_y(turns);
        self.book(lying_book(size_m), place, random);
    }

    /// One of some pencils that lean in a pot.
    fn pencil(&mut self, pot: DVec3, index: u32, random: &mut Pcg32) {
        let way = around_y(0.29 * f64::from(index) + between(random, -0.05, 0.05));
        // From the foot across to the rim.
        let lean = DAffine3::from_mat3(glam::DMat3::from_cols(
            dvec3(0.98, -0.2, 0.0).normalize(),
            dvec3(0.2, 0.98, 0.0).normalize(),
            DVec3::Z,
        ));
        let place = DAffine3::from_translation(pot + DVec3::Y * 0.006)
            * way
            * DAffine3::from_translation(dvec3(0.004, 0.0, 0.0))
            * lean;
        let [body, wood, lead] = pencil(between(random, 0.13, 0.17));
        self.covers[random.below(6) as usize].extend(placed(body, place));
        self.wood.extend(placed(wood, place));
        self.lead.extend(placed(lead, place));
    }

    /// A row of books and binders; now and then a gap, a vase or a heap.
    pub fn row(&mut self, row: &Row, random: &mut Pcg32) {
        let Row { x_m: [from, to], foot_m: foot, clear_m, back_m: z } = *row;
        let mut x = from + between(random, 0.004, 0.03);
        while x < to - 0.03 {
            let room = to - x;
            let at = dvec3(x, foot - SUNK_M, z);
            let kind = random.below(20);
            if kind == 0 && room > 0.3 {
                let height = between(random, 0.5, 0.75) * clear_m;
                self.china.extend(stood(vase(height, 10), 0.0, dvec3(x + 0.1, foot, z - 0.1)));
                x += 0.2;
            } else if kind == 1 && room > 0.32 {
                let mut top = dvec3(x + 0.13, foot, z - 0.1);
                for _ in 0..3 + random.below(3) {
                    let size =
                        dvec3(between(random, 0.19, 0.24), between(random, 0.02, 0.04), between(random, 0.14, 0.18));
                    self.lying(size, between(random, -0.02, 0.02), top, random);
                    top.y += size.y - SUNK_M;
                }
                x += 0.27;
            } else if kind == 2 {
                x += between(random, 0.05, 0.16);
            } else {
                // Binders come in runs of one kind; books are all unlike.
                let is_binder = kind == 3 && room > 0.3;
                let count = if is_binder { 3 } else { 1 };
                for index in 0..count {
                    let size = if is_binder {
                        dvec3(0.07, 0.86 * clear_m, 0.24)
                    } else {
                        let height = between(random, 0.55, 0.88) * clear_m;
                        dvec3(between(random, 0.014, 0.045), height, between(random, 0.15, 0.22))
                    };
                    if x + size.x > to - 0.002 {
                        return;
                    }
                    let at = dvec3(x, at.y, z - size.z - between(random, 0.0, 0.012));
                    self.book(book(size), DAffine3::from_translation(at), random);
                    // A hair apart, so that covers are not one plane.
                    x += size.x + 0.0008 + if index + 1 == count { between(random, 0.0, 0.002) } else { 0.0 };
                }
            }
        }
    }

    pub fn add(self, assembly: &mut Assembly, materials: &Materials) {
        let named = ["red", "navy", "green", "ochre", "cream", "grey"].map(|color| format!("{color}_things"));
        let of_covers = named.into_iter().zip(self.covers).zip(materials.covers);
        let rest = [
            (("pages".to_owned(), self.paper), materials.paper),
            (("pencil_wood".to_owned(), self.wood), materials.beech),
            (("pencil_leads".to_owned(), self.lead), materials.charcoal),
            (("vases".to_owned(), self.china), materials.china),
        ];
        for ((name, patches), material) in of_covers.chain(rest) {
            if !patches.is_empty() {
                assembly.fixed(&name, material, &patches);
            }
        }
    }
}

/// Its top, its frame and a box of drawers with a panel toward -z.
fn desk() -> [Vec<Patch>; 3] {
    let DVec3 { x: width, y: height, z: depth } = DESK_M;
    let (w, d, under) = (0.5 * width, 0.5 * depth, height - 0.028);
    let top = chamfered(dvec3(-w, under, -d), dvec3(w, height, d), 0.003, 0.8);
    let mut frame = Vec::new();
    for x in [0.05 - w, w - 0.05] {
        for z in [0.06 - d, d - 0.06] {
            frame.extend(bar(dvec3(x, 0.0, z), dvec3(x, under + 0.006, z), 0.02));
        }
        frame.extend(bar(dvec3(x, under - 0.02, 0.07 - d), dvec3(x, under - 0.02, d - 0.07), 0.015));
    }
    frame.extend(bar(dvec3(0.06 - w, under - 0.022, 0.06 - d), dvec3(w - 0.06, under - 0.022, 0.06 - d), 0.015));
    let [left, right] = [w - 0.5, w - 0.09];
    let mut drawers = solid([left, 0.05, 0.12 - d], [right, under + 0.003, d - 0.09]);
    for row in 0..3 {
        let foot = 0.07 + 0.21 * f64::from(row);
        let low = dvec3(left + 0.008, foot, d - 0.1);
        drawers.extend(cuboid(low, dvec3(right - 0.008, foot + 0.2, d - 0.075), 0.6, Detail::COARSE));
        let handle = dvec3(0.5 * (left + right), foot + 0.15, d - 0.073);
        drawers.extend(bar(handle - DVec3::X * 0.06, handle + DVec3::X * 0.06, 0.005));
    }
    drawers.extend(solid([0.065 - w, 0.32, 0.068 - d], [w - 0.5 + SUNK_M, under - 0.05, 0.087 - d]));
    [top, frame, drawers]
}

/// Its wood, and its cushion: four splayed legs, a seat, and a back of slats between two posts.
fn chair() -> [Vec<Patch>; 2] {
    const SEAT_M: f64 = 0.44;
    let mut wood: Vec<Patch> = Vec::new();
    let leg = |from: [f64; 3], to: [f64; 3]| tube(from.into(), to.into(), 0.016, 6);
    for x in [-1.0, 1.0] {
        wood.extend(leg([x * 0.215, 0.0, -0.2], [x * 0.185, SEAT_M, -0.165]));
        wood.extend(leg([x * 0.215, 0.0, 0.24], [x * 0.19, SEAT_M, 0.17]));
        wood.extend(leg([x * 0.19, SEAT_M - 0.03, 0.17], [x * 0.2, 0.86, 0.27]));
        // A stretcher from the front to the back.
        wood.extend(tube(dvec3(x * 0.203, 0.2, -0.186), dvec3(x * 0.204, 0.2, 0.21), 0.009, 6));
    }
    wood.extend(tube(dvec3(-0.2, 0.26, -0.18), dvec3(0.2, 0.26, -0.18), 0.009, 6));
    wood.extend(chamfered(dvec3(-0.22, SEAT_M - 0.02, -0.2), dvec3(0.22, SEAT_M, 0.2), 0.006, 0.6));
    // Slats of the back are bowed, and lean with the posts.
    for row in 0..3 {
        let y = 0.56 + 0.11 * f64::from(row);
        let slat = cuboid_of(dvec3(-0.205, y, -0.008), dvec3(0.205, y + 0.065, 0.008), 0.6, [6, 1, 1]);
        wood.extend(bent(slat, |at| {
            let lean = 0.17 + 0.1 * (at.y - 0.41) / 0.45;
            dvec3(at.x, at.y, at.z + lean + 0.035 * (1.0 - at.x * at.x / 0.042) - 0.004)
        }));
    }
    let cushion = cuboid_of(dvec3(-0.2, SEAT_M - SUNK_M, -0.185), dvec3(0.2, SEAT_M + 0.03, 0.185), 0.6, [4, 1, 4]);
    let cushion = bent(cushion, |at| {
        let (x, z) = (at.x / 0.2, at.z / 0.185);
        let full = 1.0 - 0.5 * (x * x * x * x).max(z * z * z * z);
        let up = (at.y - SEAT_M) * full;
        dvec3(at.x * (1.0 - 0.25 * z * z * x * x * 0.4), SEAT_M + up, at.z * (1.0 - 0.1 * x * x * z * z))
    });
    [wood, cushion.collect()]
}

/// Its case on a foot, and the screen, which faces +z.
fn monitor() -> [Vec<Patch>; 2] {
    let mut case = chamfered(dvec3(-0.28, 0.13, -0.015), dvec3(0.28, 0.47, 0.012), 0.004, 0.6);
    case.extend(solid([-0.1, 0.2, -0.05], [0.1, 0.4, -0.012]));
    case.extend(solid([-0.03, 0.008, -0.07], [0.03, 0.34, -0.045]));
    case.extend(chamfered(dvec3(-0.12, 0.0, -0.12), dvec3(0.12, 0.012, 0.06), 0.003, 0.6));
    [case, solid([-0.268, 0.15, 0.0], [0.268, 0.458, 0.0135])]
}

fn keyboard() -> [Vec<Patch>; 2] {
    let board = chamfered(dvec3(-0.21, 0.0, -0.07), dvec3(0.21, 0.014, 0.07), 0.004, 0.6);
    // Rows of keys: one by one they would be narrower than a pixel.
    let row = |index: u32| {
        let z = -0.053 + 0.0215 * f64::from(index);
        solid([-0.198, 0.013, z], [0.198, 0.019, z + 0.0165])
    };
    let keys = (0..5).flat_map(row).collect();
    [board, keys]
}

/// Where books stand in a row, in the room or in their case.
pub struct Row {
    /// From and to.
    pub x_m: [f64; 2],
    /// Height of the board that they stand on, and how much room is above it.
    pub foot_m: f64,
    pub clear_m: f64,
    /// z of the books' backs.
    pub back_m: f64,
}

impl Row {
    /// The same elsewhere.
    pub fn moved(self, shift: DVec3) -> Self {
        Self {
            x_m: self.x_m.map(|x| x + shift.x),
            foot_m: self.foot_m + shift.y,
            back_m: self.back_m + shift.z,
            ..self
        }
    }
}

/// A case of shelves against the far wall, open toward +z: width, height and depth in `size_m`, its lower left back
/// corner at the origin. With it the rows that can be filled.
pub fn shelves(size_m: DVec3, columns: u32, rows: u32) -> (Vec<Patch>, Vec<Row>) {
    const BOARD_M: f64 = 0.022;
    /// How far boards reach into each other.
    const JOINT_M: f64 = 0.006;
    let DVec3 { x: width, y: height, z: depth } = size_m;
    let mut patches = solid([JOINT_M, 0.02, -1.2 * SUNK_M], [width - JOINT_M, height - 1.5 * JOINT_M, 0.008]);
    for column in 0..=columns {
        let x = f64::from(column) / f64::from(columns) * (width - BOARD_M);
        // Partitions stand back a little.
        let front = if column % columns == 0 { depth } else { depth - 0.004 };
        patches.extend(solid([x, 0.0, -0.5 * SUNK_M], [x + BOARD_M, height - JOINT_M, front]));
    }
    patches.extend(chamfered(
        dvec3(-0.01, height - BOARD_M, -2.0 * SUNK_M),
        dvec3(width + 0.01, height, depth + 0.012),
        0.003,
        0.6,
    ));
    let [lowest, clear] = [0.06, (height - BOARD_M - 0.06) / f64::from(rows)];
    for row in 0..rows {
        let y = lowest + clear * f64::from(row);
        patches.extend(solid([BOARD_M - JOINT_M, y, JOINT_M], [width - BOARD_M + JOINT_M, y + BOARD_M, depth - 0.008]));
    }
    let mut all = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let x = |column: u32| f64::from(column) / f64::from(columns) * (width - BOARD_M);
            let foot = lowest + clear * f64::from(row) + BOARD_M;
            all.push(Row {
                x_m: [x(column) + BOARD_M, x(column + 1)],
                foot_m: foot,
                clear_m: clear - BOARD_M,
                back_m: depth - 0.03,
            });
        }
    }
    (patches, all)
}

/// A basket for paper, and what was thrown in.
pub fn basket(random: &mut Pcg32) -> [Vec<Patch>; 2] {
    let mut balls = Vec::new();
    for index in 0..5 {
        let ball = bent(prism(5, [0.03, 0.02], 0.05, 0.1), |at| at + dvec3(0.3 * at.y, 0.0, 0.2 * at.x));
        let at = around_y(0.21 * f64::from(index)).transform_vector3(dvec3(0.05, 0.012, 0.0));
        let at = at + DVec3::Y * if index > 2 { between(random, 0.03, 0.05) } else { 0.0 };
        balls.extend(stood(ball.collect(), f64::from(random.unit()), at));
    }
    [pot([0.105, 0.14], 0.3, 0.004, 20), balls]
}

/// A tray for letters that opens upward.
pub fn tray() -> Vec<Patch> {
    // The open box opens toward +z.
    let lie = DAffine3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y, DVec3::ZERO);
    placed(open_box(dvec3(0.26, 0.33, 0.06), 0.004, 0.6), lie).collect()
}
