//! Many objects under many lamps: the scene of Kircher & Lawrance 2009, figure 8 (101 objects, 81 omni lights).
//!
//! Objects and lamps stand in shuffled cells of one square each, so that any number covers the field evenly and
//! nothing overlaps. The field grows with the objects. Lamps share one range, so that their cost grows with their
//! number, and share a fixed amount of light per object, so that the picture's brightness stays.

use glam::{DVec3, Vec3, dvec3, vec3};

use super::assembly::{Assembly, Maps, place};
use super::patch::{Detail, Patch, sin_cos_turns};
use super::patterns;
use super::shapes::{Curve, Mapping, Turning, arch, cuboid, face_of, prism, sphere, torus, turned, turned_with};
use crate::sampling::pcg::Pcg32;
use crate::scene::Material;
use crate::scene::procedural::values::Values;

/// Side of the square that an object has for itself.
const CELL_M: f64 = 1.6;
/// Where a lamp ends: it reaches the objects around it, not those across the field.
const RANGE_M: f32 = 4.0;
/// Candela of a lamp where there are as many lamps as objects.
const INTENSITY_CD: f32 = 7.0;

/// The scene for `objects` and `lights`.
pub fn make(values: &Values, seed: u64) -> Assembly {
    let (object_count, light_count) = (values.get("objects") as u32, values.get("lights") as u32);
    let mut random = Pcg32::new(seed, 1);
    let mut assembly = Assembly::default();
    let materials = materials(&mut assembly, seed as u32);
    let field_m = CELL_M * f64::from(object_count).sqrt().ceil();
    ground(&mut assembly, field_m, seed as u32);
    let shapes: [fn() -> Vec<Patch>; 9] = SHAPES;
    // Meshes are made when first used: few objects need few.
    let mut made = vec![None; shapes.len() * materials.len()];
    let cells = shuffled_cells(object_count, &mut random);
    for [x, z] in cells {
        let shape = random.below(shapes.len() as u32) as usize;
        let material = random.below(materials.len() as u32) as usize;
        let mesh = *made[shape * materials.len() + material].get_or_insert_with(|| {
            let material = materials[material];
            let name = format!("{}_{}", SHAPE_NAMES[shape], assembly.scene.materials[material].name);
            assembly.mesh(&name, material, &shapes[shape]())
        });
        let (sine, cosine) = sin_cos_turns(f64::from(random.unit()));
        let scale = f64::from(random.between(0.75, 1.15));
        // A shape of scale 1.15 is 0.58 m from its axis at most: it may stray by what is left of the cell's half.
        let mut stray = || f64::from(random.between(-0.2, 0.2));
        let shift = dvec3(x * field_m + stray(), 0.0, z * field_m + stray());
        assembly.draw(mesh, place([sine, cosine], scale, shift));
    }
    lights(&mut assembly, [object_count, light_count], field_m, &mut random);
    let far = field_m * 0.5;
    assembly.camera("raised", dvec3(-0.25 * far, 0.62 * far + 1.2, far + 3.0), dvec3(0.0, 0.2, 0.12 * far), 0.72);
    assembly.camera("above", dvec3(0.0, 2.6 * far, 0.01), DVec3::ZERO, 0.8);
    assembly.camera("low", dvec3(0.35 * far, 0.9, far + 2.0), dvec3(0.0, 0.5, 0.0), 0.8);
    assembly
}

/// Centres of `count` different cells of the smallest square that has so many, each coordinate -0.5 to 0.5.
fn shuffled_cells(count: u32, random: &mut Pcg32) -> Vec<[f64; 2]> {
    let side = f64::from(count).sqrt().ceil() as u32;
    let mut cells: Vec<u32> = (0..side * side).collect();
    for index in 0..count {
        cells.swap(index as usize, (index + random.below(side * side - index)) as usize);
    }
    let centre = |index: u32| (f64::from(index) + 0.5) / f64::from(side) - 0.5;
    cells[..count as usize].iter().map(|cell| [centre(cell % side), centre(cell / side)]).collect()
}

fn lights(assembly: &mut Assembly, [objects, lights]: [u32; 2], field_m: f64, random: &mut Pcg32) {
    const COLORS: [Vec3; 8] = [
        vec3(1.0, 0.35, 0.2),
        vec3(1.0, 0.7, 0.3),
        vec3(0.95, 0.9, 0.45),
        vec3(0.35, 0.9, 0.4),
        vec3(0.25, 0.8, 0.85),
        vec3(0.35, 0.5, 1.0),
        vec3(0.7, 0.4, 1.0),
        vec3(1.0, 0.4, 0.75),
    ];
    let share = (objects as f32 / lights as f32).min(4.0);
    for (index, [x, z]) in shuffled_cells(lights, random).into_iter().enumerate() {
        let color = COLORS[random.below(COLORS.len() as u32) as usize];
        let mut stray = || f64::from(random.between(-0.5, 0.5));
        let (x, z) = (x * field_m + stray(), z * field_m + stray());
        // Above the objects, which are 1.4 m high at most.
        let height = f64::from(random.between(1.5, 2.3));
        let intensity = color * (INTENSITY_CD * share * random.between(0.7, 1.3));
        assembly.point_light(format!("lamp_{index}"), dvec3(x, height, z).as_vec3(), intensity, Some(RANGE_M));
    }
}

fn ground(assembly: &mut Assembly, field_m: f64, seed: u32) {
    let maps = Maps { size_px: 512, relief: Some(0.004), metallic_roughness: true };
    let material = assembly.textured(Material { name: "ground".to_owned(), ..Material::default() }, maps, |at| {
        patterns::checker(at, 4, [[0.62, 0.60, 0.57], [0.44, 0.43, 0.43]], seed)
    });
    let half = field_m * 2.0 + 10.0;
    let corners = [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]].map(|[x, z]| dvec3(x * half, 0.0, z * half));
    // Vertex lighting and culling by bounds see more than two triangles.
    let ground = face_of(corners, Mapping::Repeat { tile_m: 2.4 }, 32, 32);
    let mesh = assembly.mesh("ground", material, &[ground]);
    assembly.draw(mesh, place([0.0, 1.0], 1.0, DVec3::ZERO));
}

fn materials(assembly: &mut Assembly, seed: u32) -> Vec<usize> {
    let named = |name: &str| Material { name: name.to_owned(), metallic: 0.0, ..Material::default() };
    let mut all = Vec::new();
    for (name, color, metallic, roughness) in [
        ("chalk", vec3(0.78, 0.77, 0.74), 0.0, 0.95),
        ("clay", vec3(0.56, 0.27, 0.17), 0.0, 0.8),
        ("red_glaze", vec3(0.58, 0.05, 0.04), 0.0, 0.25),
        ("blue_glaze", vec3(0.05, 0.13, 0.42), 0.0, 0.2),
        ("green_glaze", vec3(0.07, 0.32, 0.16), 0.0, 0.3),
        ("gold", vec3(0.95, 0.70, 0.32), 1.0, 0.32),
        ("copper", vec3(0.93, 0.58, 0.46), 1.0, 0.42),
        ("steel", vec3(0.62, 0.62, 0.61), 1.0, 0.5),
    ] {
        let base_color = color.extend(1.0);
        all.push(assembly.material(Material { base_color, metallic, roughness, ..named(name) }));
    }
    let maps = Maps { size_px: 256, relief: Some(0.01), metallic_roughness: true };
    all.push(
        assembly
            .textured(named("marble"), maps, |at| patterns::marble(at, [0.88, 0.86, 0.82], [0.42, 0.42, 0.45], seed)),
    );
    all.push(
        assembly.textured(named("oak"), maps, |at| patterns::boards(at, [0.35, 0.22, 0.13], [0.63, 0.45, 0.28], seed)),
    );
    let bricks = patterns::Masonry {
        columns: 4,
        rows: 8,
        dark: [0.50, 0.25, 0.19],
        light: [0.72, 0.42, 0.31],
        mortar: [0.66, 0.62, 0.56],
        joint: 0.12,
    };
    all.push(assembly.textured(named("brick"), maps, |at| patterns::masonry(at, &bricks, seed)));
    all.push(assembly.textured(named("bronze"), maps, |at| patterns::hammered(at, [0.80, 0.62, 0.42], seed)));
    all
}

const SHAPE_NAMES: [&str; 9] = ["block", "slab", "ball", "can", "cone", "ring", "vase", "prism", "arch"];

/// Each stands on y = 0, at most 0.5 m from its axis and 1.2 m high.
const SHAPES: [fn() -> Vec<Patch>; 9] = [
    || cuboid(dvec3(-0.35, 0.0, -0.35), dvec3(0.35, 0.7, 0.35), 0.7, Detail::COARSE),
    || cuboid(dvec3(-0.2, 0.0, -0.35), dvec3(0.2, 1.15, 0.35), 0.7, Detail::COARSE),
    || raised(sphere(0.45, 32), 0.45),
    || turned(&Curve::lines(&[[0.0, 0.0], [0.34, 0.0], [0.34, 0.8], [0.0, 0.8]]), TURNING),
    || turned(&Curve::lines(&[[0.0, 0.0], [0.45, 0.0], [0.0, 1.1]]), TURNING),
    || raised(torus(0.34, 0.14, 40, 16), 0.14),
    || {
        let profile = [
            Curve::line([0.0, 0.0], [0.2, 0.0]),
            Curve::bent([0.2, 0.0], [0.68, 0.42], [0.13, 0.85]),
            Curve::bent([0.13, 0.85], [0.13, 1.0], [0.26, 1.05]),
            Curve::bent([0.26, 1.05], [0.08, 1.0], [0.0, 0.7]),
        ];
        turned_with(&profile, TURNING, |turns, _, _| 1.0 + 0.03 * sin_cos_turns(10.0 * turns).0)
    },
    || prism(6, [0.42, 0.3], 0.9, 0.7),
    || arch([0.28, 0.48], -0.18, 0.18, 9, Detail { edge_m: 0.1 }),
];

const TURNING: Turning = Turning { segments: 40, repeats: 2, tile_m: 0.9, detail: Detail { edge_m: 0.14 } };

fn raised(patches: Vec<Patch>, height_m: f64) -> Vec<Patch> {
    let place = glam::DAffine3::from_translation(DVec3::Y * height_m);
    patches.into_iter().map(|patch| patch.moved(place)).collect()
}
