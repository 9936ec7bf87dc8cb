//! What stands in the yard: materials, meshes that are drawn many times, and the parts that are there once.

use glam::{DAffine3, DMat3, DVec3, Vec3, dvec2, dvec3, vec3, vec4};

use crate::scene::procedural::assembly::{Assembly, Maps, place, shifted};
use crate::scene::procedural::fence::layout::{
    AMBER, BLUE, FENCE_M, FIELD_M, HUNG, MINT, NEON, PLATFORM, ROTOR, ROTOR_LAMP, Row, WALL_Z_M, WHITE, between,
};
use crate::scene::procedural::patch::{Detail, Patch, Point, sin_cos_turns};
use crate::scene::procedural::patterns::{self, Masonry};
use crate::scene::procedural::shapes::{Curve, Mapping, Turning, cuboid, face, face_of, sphere, turned};
use crate::scene::{AlphaMode, Material};

/// Radiance of a bulb's glass in its lamp's colour: it shows as a lamp, and its own light is small beside that.
const BULB_RADIANCE: f32 = 1.7;
const BULB_M: f64 = 0.045;

const WIRE_PX: u32 = 512;

/// Every colour that a lamp may have; the first is the strong one's.
fn bulb_colors() -> impl Iterator<Item = Vec3> {
    [WHITE, AMBER, NEON, MINT, BLUE].into_iter().flatten()
}

/// Which of `Shapes::bulbs` has this colour.
pub fn bulb_of(color: Vec3) -> usize {
    bulb_colors().position(|known| known == color).expect("rows have no other colours")
}

/// Indices into `Scene::materials`.
pub struct Materials {
    steel: usize,
    dark_steel: usize,
    yellow: usize,
    concrete: usize,
    ground: usize,
    brick: usize,
    boards: usize,
    chain_link: usize,
    barbed_wire: usize,
    /// Meshes of the panes, and of the sheets under the rotor.
    panes: [usize; 4],
    sheets: [usize; 3],
    bulbs: Vec<usize>,
}

impl Materials {
    /// `is_masked`: wire is cut out of its textures instead of blended.
    pub fn add(assembly: &mut Assembly, is_masked: bool, seed: u32) -> Self {
        let named = |name: &str| Material { name: name.to_owned(), metallic: 0.0, ..Material::default() };
        let plain = |name: &str, color: Vec3, roughness: f32| Material {
            base_color: color.extend(1.0),
            roughness,
            ..named(name)
        };
        let glass = |name: &str, color: Vec3, alpha: f32| Material {
            base_color: color.extend(alpha),
            roughness: 0.18,
            alpha: AlphaMode::Blend,
            double_sided: true,
            ..named(name)
        };
        let alpha = if is_masked { AlphaMode::Mask { cutoff: 0.5 } } else { AlphaMode::Blend };
        let wire = |name: &str| Material { alpha, double_sided: true, roughness: 0.45, ..named(name) };
        let relief = |size_px: u32, relief: f32| Maps { size_px, relief: Some(relief), metallic_roughness: true };
        let flat = Maps { size_px: WIRE_PX, relief: None, metallic_roughness: false };
        let bricks = Masonry {
            columns: 6,
            rows: 14,
            dark: [0.42, 0.22, 0.18],
            light: [0.66, 0.40, 0.31],
            mortar: [0.56, 0.53, 0.49],
            joint: 0.14,
        };
        let a = assembly;
        Self {
            steel: a.material(Material { metallic: 0.6, ..plain("steel", vec3(0.62, 0.64, 0.66), 0.4) }),
            dark_steel: a.material(plain("painted_steel", vec3(0.10, 0.12, 0.13), 0.5)),
            yellow: a.material(plain("yellow_paint", vec3(0.85, 0.55, 0.06), 0.4)),
            concrete: a
                .textured(named("concrete"), relief(256, 0.006), |at| patterns::plaster(at, [0.60, 0.59, 0.56], seed)),
            ground: a.textured(named("slabs"), relief(512, 0.004), |at| {
                patterns::checker(at, 4, [[0.50, 0.50, 0.50], [0.46, 0.46, 0.47]], seed ^ 1)
            }),
            brick: a.textured(named("brick"), relief(512, 0.012), |at| patterns::masonry(at, &bricks, seed ^ 2)),
            boards: a.textured(named("boards"), relief(256, 0.008), |at| {
                patterns::boards(at, [0.34, 0.22, 0.13], [0.62, 0.45, 0.29], seed ^ 3)
            }),
            chain_link: a.textured(wire("chain_link"), flat, |at| patterns::chain_link(at, WIRE_PX)),
            barbed_wire: a.textured(wire("barbed_wire"), flat, |at| patterns::barbed_wire(at, WIRE_PX)),
            panes: [
                a.material(glass("clear_glass", vec3(0.75, 0.9, 0.95), 0.22)),
                a.material(glass("green_glass", vec3(0.25, 0.75, 0.45), 0.3)),
                a.material(glass("amber_glass", vec3(0.95, 0.6, 0.2), 0.3)),
                a.material(glass("rose_glass", vec3(0.9, 0.3, 0.45), 0.3)),
            ],
            sheets: [
                a.material(glass("frosted_sheet", vec3(0.9, 0.95, 1.0), 0.3)),
                a.material(glass("blue_sheet", vec3(0.45, 0.7, 0.95), 0.34)),
                a.material(glass("sand_sheet", vec3(0.95, 0.8, 0.55), 0.36)),
            ],
            bulbs: bulb_colors()
                .enumerate()
                .map(|(index, color)| {
                    a.material(Material {
                        base_color: vec4(0.02, 0.02, 0.02, 1.0),
                        emissive: color * BULB_RADIANCE,
                        ..named(&format!("bulb_{index}"))
                    })
                })
                .collect(),
        }
    }
}

/// Meshes that are drawn many times, as indices into `Scene::meshes`.
pub struct Shapes {
    /// A closed cylinder from y = 0 to 1 m, of 1 m radius.
    strut: usize,
    rail: usize,
    pub chain_link: usize,
    pub barbed_wire: usize,
    pub bulbs: Vec<usize>,
}

impl Shapes {
    pub fn add(assembly: &mut Assembly, materials: &Materials) -> Self {
        let turning = Turning { segments: 10, repeats: 1, tile_m: 1.0, detail: Detail::COARSE };
        let cylinder = || turned(&Curve::lines(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), turning);
        let corners = [[0.0, 0.06], [FIELD_M, 0.06], [FIELD_M, FENCE_M], [0.0, FENCE_M]];
        let wire = face(corners.map(|[x, y]| dvec3(x, y, 0.0)), Mapping::Repeat { tile_m: 0.44 }, Detail::COARSE);
        // Three pictures, twice as long as high, along the arms.
        let barbed = Patch::new(3, 1, |s, t| Point {
            position: dvec3(s * FIELD_M, FENCE_M + 0.12 + 0.4 * t, 0.04 + 0.22 * t),
            uv: dvec2(3.0 * s, 1.0 - t),
        });
        let bulb = |(index, material): (usize, &usize)| {
            assembly.mesh(&format!("bulb_{index}"), *material, &sphere(BULB_M, 12))
        };
        Self {
            bulbs: materials.bulbs.iter().enumerate().map(bulb).collect(),
            strut: assembly.mesh("strut", materials.steel, &cylinder()),
            rail: assembly.mesh("rail", materials.yellow, &cylinder()),
            chain_link: assembly.mesh("chain_link", materials.chain_link, &[wire]),
            barbed_wire: assembly.mesh("barbed_wire", materials.barbed_wire, &[barbed]),
        }
    }

    /// A round bar of steel from one place to another.
    pub fn strut(&self, assembly: &mut Assembly, from: DVec3, to: DVec3, radius_m: f64) {
        assembly.draw(self.strut, between(from, to, radius_m));
    }

    fn rail(&self, assembly: &mut Assembly, from: DVec3, to: DVec3) {
        assembly.draw(self.rail, between(from, to, 0.022));
    }
}

fn block(assembly: &mut Assembly, name: &str, material: usize, min: DVec3, max: DVec3) {
    let mesh = assembly.mesh(name, material, &cuboid(min, max, 1.2, Detail { edge_m: 1.5 }));
    assembly.draw(mesh, shifted(DVec3::ZERO));
}

pub fn ground_and_wall(assembly: &mut Assembly, materials: &Materials) {
    let corners = [[-30.0, 22.0], [30.0, 22.0], [30.0, -14.0], [-30.0, -14.0]].map(|[x, z]| dvec3(x, 0.0, z));
    let ground = face_of(corners, Mapping::Repeat { tile_m: 4.0 }, 30, 18);
    let mesh = assembly.mesh("ground", materials.ground, &[ground]);
    assembly.draw(mesh, shifted(DVec3::ZERO));
    block(assembly, "wall", materials.brick, dvec3(-11.0, 0.0, WALL_Z_M - 0.4), dvec3(10.5, 4.3, WALL_Z_M));
    let coping = [dvec3(-11.1, 4.3, WALL_Z_M - 0.5), dvec3(10.6, 4.45, WALL_Z_M + 0.1)];
    block(assembly, "coping", materials.concrete, coping[0], coping[1]);
    let door = [dvec3(6.6, 1.0, WALL_Z_M), dvec3(7.7, 3.1, WALL_Z_M + 0.06)];
    block(assembly, "door", materials.boards, door[0], door[1]);
}

/// The platform, its stairs on the left, and handrails around both.
pub fn platform(assembly: &mut Assembly, materials: &Materials, shapes: &Shapes) {
    const STEPS: u32 = 5;
    const TREAD_M: f64 = 0.3;
    let [low, high] = PLATFORM;
    let back = dvec3(high.x, high.y, low.z);
    block(assembly, "platform", materials.concrete, dvec3(low.x, 0.0, high.z), back);
    let stairs_z = [low.z - 1.5, low.z];
    for step in 0..STEPS {
        let from_edge = f64::from(STEPS - step) * TREAD_M;
        let top = high.y * f64::from(step + 1) / f64::from(STEPS + 1);
        let min = dvec3(low.x - from_edge, 0.0, stairs_z[0]);
        block(assembly, &format!("step_{step}"), materials.concrete, min, dvec3(min.x + TREAD_M, top, stairs_z[1]));
    }
    let run = |assembly: &mut Assembly, from: DVec3, to: DVec3, posts: u32| {
        for height in [0.5, 0.98] {
            shapes.rail(assembly, from + DVec3::Y * height, to + DVec3::Y * height);
        }
        for post in 0..=posts {
            let foot = from.lerp(to, f64::from(post) / f64::from(posts));
            shapes.rail(assembly, foot, foot + DVec3::Y * 0.98);
        }
    };
    let edge = |x: f64, z: f64| dvec3(x, high.y, z);
    run(assembly, edge(low.x, low.z - 0.06), edge(high.x, low.z - 0.06), 7);
    run(assembly, edge(low.x, stairs_z[0]), edge(low.x, high.z + 0.2), 1);
    for z in [stairs_z[0] + 0.05, low.z - 0.06] {
        run(assembly, dvec3(low.x - f64::from(STEPS) * TREAD_M, 0.1, z), edge(low.x, z), 3);
    }
}

/// Crates and barrels.
pub fn goods(assembly: &mut Assembly, materials: &Materials) {
    let crate_mesh = assembly.mesh(
        "crate",
        materials.boards,
        &cuboid(dvec3(-0.4, 0.0, -0.4), dvec3(0.4, 0.8, 0.4), 0.8, Detail::COARSE),
    );
    let profile = [
        Curve::line([0.0, 0.0], [0.28, 0.0]),
        Curve::bent([0.28, 0.0], [0.34, 0.43], [0.28, 0.86]),
        Curve::line([0.28, 0.86], [0.0, 0.86]),
    ];
    let turning = Turning { segments: 24, repeats: 2, tile_m: 0.8, detail: Detail { edge_m: 0.2 } };
    let barrel = assembly.mesh("barrel", materials.dark_steel, &turned(&profile, turning));
    for (mesh, turn, at) in [
        (crate_mesh, 0.03, dvec3(-7.9, 0.0, -4.6)),
        (crate_mesh, 0.11, dvec3(-6.8, 0.0, -4.8)),
        (crate_mesh, 0.07, dvec3(-7.4, 0.8, -4.7)),
        (crate_mesh, 0.2, dvec3(4.2, 1.0, -5.2)),
        (barrel, 0.0, dvec3(-2.3, 0.0, -4.9)),
        (barrel, 0.1, dvec3(-1.5, 0.0, -5.1)),
        (barrel, 0.2, dvec3(-1.8, 0.0, -4.3)),
        (barrel, 0.3, dvec3(5.6, 1.0, -5.3)),
    ] {
        let (sine, cosine) = sin_cos_turns(turn);
        assembly.draw(mesh, place([sine, cosine], 1.0, at));
    }
}

/// Four panes in frames, one behind the other as the street sees them, each a little farther to the left, so that the
/// picture has places with one, two, three and four of them.
pub fn panes(assembly: &mut Assembly, materials: &Materials) {
    const HALF_M: f64 = 1.15;
    let bar = |min: [f64; 2], max: [f64; 2]| {
        cuboid(dvec3(min[0], min[1], -0.03), dvec3(max[0], max[1], 0.03), 1.0, Detail::COARSE)
    };
    let w = HALF_M;
    let frame: Vec<Patch> = [
        bar([-w - 0.06, 0.0], [-w, 2.3]),
        bar([w, 0.0], [w + 0.06, 2.3]),
        bar([-w, 0.25], [w, 0.31]),
        bar([-w, 2.24], [w, 2.3]),
    ]
    .into_iter()
    .flatten()
    .collect();
    let frame = assembly.mesh("frame", materials.dark_steel, &frame);
    for (index, material) in materials.panes.into_iter().enumerate() {
        let corners = [[-w, 0.31], [w, 0.31], [w, 2.24], [-w, 2.24]].map(|[x, y]| dvec3(x, y, 0.0));
        let pane = assembly.mesh(&format!("pane_{index}"), material, &[face(corners, Mapping::Fit, Detail::COARSE)]);
        let behind = index as f64;
        let (sine, cosine) = sin_cos_turns(0.05);
        let stand = place([sine, cosine], 1.0, dvec3(-2.9 - 1.15 * behind, 0.0, 2.6 - 1.45 * behind));
        assembly.draw(pane, stand);
        assembly.draw(frame, stand);
    }
}

/// The ends of the beam from which the rotor hangs.
pub fn gantry_tops() -> [DVec3; 2] {
    [-2.9, 2.9].map(|x| dvec3(ROTOR.x + x, ROTOR_LAMP.y + 0.25, ROTOR.z))
}

/// The rotor under its gantry, its lamp's shade, and three sheets of glass below, each farther out and lower.
pub fn rotor(assembly: &mut Assembly, materials: &Materials, shapes: &Shapes) {
    const HALF: [f64; 2] = [1.35, 0.8];
    let hub = turned(
        &Curve::lines(&[[0.0, -0.12], [0.16, -0.12], [0.16, 0.1], [0.0, 0.1]]),
        Turning { segments: 16, repeats: 1, tile_m: 0.5, detail: Detail::COARSE },
    );
    let mut patches = hub;
    let (pitch_sine, pitch_cosine) = sin_cos_turns(0.04);
    let pitch = DMat3::from_cols(DVec3::X, dvec3(0.0, pitch_cosine, pitch_sine), dvec3(0.0, -pitch_sine, pitch_cosine));
    for blade in 0..4 {
        let (sine, cosine) = sin_cos_turns(f64::from(blade) * 0.25 + 0.07);
        let turn = DMat3::from_cols(dvec3(cosine, 0.0, -sine), DVec3::Y, dvec3(sine, 0.0, cosine));
        let at = DAffine3::from_mat3(turn * pitch);
        let shape = cuboid(dvec3(0.1, -0.012, -0.1), dvec3(1.3, 0.012, 0.1), 1.0, Detail::COARSE);
        patches.extend(shape.into_iter().map(|patch| patch.moved(at)));
    }
    let mesh = assembly.mesh("rotor", materials.yellow, &patches);
    assembly.turning("rotor", mesh, ROTOR, Vec3::Y, 8);
    let [left, right] = gantry_tops();
    let beam_y = left.y;
    shapes.strut(assembly, left, right, 0.05);
    for top in [left, right] {
        shapes.strut(assembly, top.with_y(0.0), top, 0.05);
    }
    shapes.strut(assembly, ROTOR, ROTOR.with_y(beam_y), 0.03);
    shapes.strut(assembly, ROTOR_LAMP + DVec3::Y * 0.17, ROTOR_LAMP.with_y(beam_y), 0.015);

    for (index, material) in materials.sheets.into_iter().enumerate() {
        let step = index as f64;
        let center = dvec3(ROTOR.x + 0.12 * step, 2.1 - 0.6 * step, ROTOR.z + 0.42 * step);
        // Lower toward the street, so that one sees onto it.
        let corner = |x: f64, z: f64| center + dvec3(x * HALF[0], -z * 0.22, z * HALF[1]);
        let corners = [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]].map(|[x, z]| corner(x, z));
        let sheet = assembly.mesh(&format!("sheet_{index}"), material, &[face(corners, Mapping::Fit, Detail::COARSE)]);
        assembly.draw(sheet, shifted(DVec3::ZERO));
        for at in corners {
            shapes.strut(assembly, at.with_y(0.0), at + DVec3::Y * 0.03, 0.02);
        }
    }
}

/// What a row of lamps hangs from.
pub fn cable(assembly: &mut Assembly, materials: &Materials, index: usize, row: &Row) {
    const RADIUS_M: f64 = 0.009;
    let row = *row;
    let beside = (row.to - row.from).cross(DVec3::Y).normalize();
    let tube = Patch::new(24, 6, move |s, t| {
        let (sine, cosine) = sin_cos_turns(t);
        // Through the tops of the bulbs.
        let middle = row.at(s) + HUNG + DVec3::Y * BULB_M;
        Point { position: middle + (beside * cosine + DVec3::Y * sine) * RADIUS_M, uv: dvec2(40.0 * s, -t) }
    });
    let mesh = assembly.mesh(&format!("cable_{index}"), materials.dark_steel, &[tube]);
    assembly.draw(mesh, shifted(DVec3::ZERO));
}
