//! A yard at night: what Kircher & Lawrance 2009 show of alpha and of edges, in one scene. Chain-link and barbed wire as
//! textures with alpha (figure 10), handrails under many small lamps (figure 9: 122 of them), four panes one behind the
//! other, and a rotor above three sheets of glass, through which its shadow falls (figure 6).
//!
//! x runs along the fence to the right, z out of the yard toward the street, the ground is y = 0. The fence stands along
//! z = 5 m as far as the gate and along x = -10 m, a brick wall along z = -6 m.

mod layout;
mod pieces;

use glam::{DVec3, dvec3, vec3};

use self::pieces::{Materials, Shapes};
use super::assembly::{Assembly, place, shifted};
use crate::sampling::pcg::Pcg32;
use crate::scene::procedural::fence::layout::{
    AMBER, BLUE, FENCE_M, FIELD_M, HUNG, MINT, NEON, PLATFORM, ROTOR_LAMP, Row, WALL_Z_M, WHITE,
};
use crate::scene::procedural::values::Values;

/// Where the fence's corner stands, and how many fields go from there to the gate and to the wall.
const CORNER: DVec3 = dvec3(-10.0, 0.0, 5.0);
const FRONT_FIELDS: u32 = 5;
const SIDE_FIELDS: u32 = 4;

/// Candela of all small lamps together, however many there are, and of one at most.
const SMALL_LAMPS_CD: f32 = 420.0;
const MOST_CD: f32 = 9.0;
/// Where a small lamp ends.
const SMALL_RANGE_M: f32 = 3.6;

const STANDING: DVec3 = dvec3(0.0, -0.15, 0.0);
const BEHIND: DVec3 = dvec3(0.0, 0.0, -0.4);

/// The tops of the poles from which cables hang that end neither at the gantry nor at the wall.
const POLES: [DVec3; 4] = [dvec3(-9.6, 3.6, 3.4), dvec3(-9.6, 3.9, -5.3), dvec3(-10.6, 3.5, 7.6), dvec3(3.5, 3.5, 5.0)];

fn rows() -> Vec<Row> {
    let row = |from: DVec3, to: DVec3, sag_m: f64, bulb: DVec3, colors| Row { from, to, sag_m, bulb, colors };
    let [low, high] = PLATFORM;
    let [left, right] = pieces::gantry_tops();
    let edge_z = low.z + 0.45;
    vec![
        row(POLES[0], left, 0.7, HUNG, AMBER),
        row(POLES[1], dvec3(4.0, 4.1, -5.5), 0.6, HUNG, WHITE),
        row(right, dvec3(9.2, 3.9, -5.8), 0.6, HUNG, AMBER),
        // Over the street, so that the wire is lit from the side that one sees.
        row(POLES[2], POLES[3], 0.6, HUNG, WHITE),
        row(dvec3(-9.4, 0.2, WALL_Z_M + 0.4), dvec3(2.2, 0.2, WALL_Z_M + 0.4), 0.0, STANDING, NEON),
        row(dvec3(low.x + 0.3, 0.75, edge_z), dvec3(high.x, 0.75, edge_z), 0.0, BEHIND, MINT),
        row(dvec3(low.x + 0.3, 2.9, WALL_Z_M + 0.45), dvec3(high.x, 2.9, WALL_Z_M + 0.45), 0.0, BEHIND, WHITE),
        // Along the fence, inside.
        row(dvec3(-9.2, 0.2, 4.6), dvec3(2.9, 0.2, 4.6), 0.0, STANDING, BLUE),
        row(dvec3(-9.6, 0.2, 4.0), dvec3(-9.6, 0.2, -5.0), 0.0, STANDING, MINT),
        // Among the panes.
        row(dvec3(-6.4, 0.2, 2.5), dvec3(-3.4, 0.2, -2.6), 0.0, STANDING, AMBER),
    ]
}

/// The scene for `lights` lamps with wire of `alpha`; the seed chooses grain and tones.
pub fn make(values: &Values, seed: u64) -> Assembly {
    let mut assembly = Assembly::default();
    let materials = Materials::add(&mut assembly, values.get("alpha") == 1, seed as u32);
    let shapes = Shapes::add(&mut assembly, &materials);
    pieces::ground_and_wall(&mut assembly, &materials);
    pieces::platform(&mut assembly, &materials, &shapes);
    pieces::goods(&mut assembly, &materials);
    fence(&mut assembly, &shapes);
    pieces::panes(&mut assembly, &materials);
    pieces::rotor(&mut assembly, &materials, &shapes);
    let rows = rows();
    for (index, row) in rows.iter().enumerate().filter(|(_, row)| row.bulb == HUNG) {
        pieces::cable(&mut assembly, &materials, index, row);
    }
    lamps(&mut assembly, &shapes, &rows, values.get("lights") as u32, seed);
    for (name, eye, target, y_fov) in [
        ("yard", dvec3(5.4, 2.2, 9.6), dvec3(-1.2, 1.55, -0.6), 0.68),
        ("fence", dvec3(-2.7, 1.55, 5.2), dvec3(-6.8, 1.3, 1.6), 0.9),
        ("rotor", dvec3(3.6, 2.9, 4.6), dvec3(0.8, 1.7, 1.0), 0.8),
        ("rails", dvec3(0.2, 1.7, 0.4), dvec3(5.0, 1.4, -4.6), 0.85),
    ] {
        assembly.camera(name, eye, target, y_fov);
    }
    assembly
}

fn fence(assembly: &mut Assembly, shapes: &Shapes) {
    for top in POLES {
        shapes.strut(assembly, top.with_y(0.0), top + DVec3::Y * 0.2, 0.035);
    }
    // Fields run along their own x; the side's are turned by a quarter, to run toward -z.
    let runs = [(FRONT_FIELDS, [0.0, 1.0], DVec3::X), (SIDE_FIELDS, [1.0, 0.0], DVec3::NEG_Z)];
    for (count, turn, along) in runs {
        for field in 0..=count {
            let at = CORNER + along * (FIELD_M * f64::from(field));
            if field > 0 || along == DVec3::X {
                shapes.strut(assembly, at, at + DVec3::Y * (FENCE_M + 0.1), 0.04);
                // The arm that holds the barbed wire leans out of the yard.
                let out = along.cross(DVec3::Y) * 0.27;
                shapes.strut(assembly, at + DVec3::Y * (FENCE_M + 0.05), at + DVec3::Y * (FENCE_M + 0.55) + out, 0.022);
            }
            if field < count {
                assembly.draw(shapes.chain_link, place(turn, 1.0, at));
                assembly.draw(shapes.barbed_wire, place(turn, 1.0, at));
                let top = DVec3::Y * FENCE_M;
                shapes.strut(assembly, at + top, at + top + along * FIELD_M, 0.024);
            }
        }
    }
}

/// One strong lamp above the rotor, all others small, evenly along the rows.
fn lamps(assembly: &mut Assembly, shapes: &Shapes, rows: &[Row], count: u32, seed: u64) {
    let mut random = Pcg32::new(seed, 5);
    assembly.point_light("rotor_lamp".to_owned(), ROTOR_LAMP.as_vec3(), vec3(1.0, 0.93, 0.8) * 45.0, Some(11.0));
    assembly.draw(shapes.bulbs[0], shifted(ROTOR_LAMP + HUNG));
    let small_count = count - 1;
    let length_m: f64 = rows.iter().map(Row::length_m).sum();
    let each_cd = (SMALL_LAMPS_CD / small_count.max(1) as f32).min(MOST_CD);
    let (mut row, mut before_m) = (0, 0.0);
    for index in 0..small_count {
        let at_m = length_m * (f64::from(index) + 0.5) / f64::from(small_count);
        while row + 1 < rows.len() && at_m > before_m + rows[row].length_m() {
            before_m += rows[row].length_m();
            row += 1;
        }
        let at = rows[row].at((at_m - before_m) / rows[row].length_m());
        let color = index as usize % 2;
        let intensity = rows[row].colors[color] * (each_cd * random.between(0.8, 1.2));
        assembly.point_light(format!("lamp_{index}"), at.as_vec3(), intensity, Some(SMALL_RANGE_M));
        assembly.draw(shapes.bulbs[pieces::bulb_of(rows[row].colors[color])], shifted(at + rows[row].bulb));
    }
}
