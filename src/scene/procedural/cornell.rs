//! The Cornell box after the measurements that Cornell's Program of Computer Graphics published: one unit is one
//! centimetre here, so the box is 5.56 m wide, 5.488 m high and 5.592 m deep, open toward the camera.
//!
//! x runs to the right as the camera sees it and z toward the camera, from the back wall at z = 0: the published x and
//! z, each counted from its other end.
//!
//! The ceiling panel is emissive, and a point light just below stands for it where emissive surfaces give no light.
//! A panel of radiance L and area A that shines as Lambert's law says gives pi * L * A of flux, all of it downward. The
//! panel is black, so it swallows what the point light sends up; the point light's intensity is that flux spread over
//! the lower half of the sphere: pi * L * A / (2 * pi) = L * A / 2. On the axis the panel is twice as bright.
//!
//! With `motion=on` both circle around the panel's place: a light that moves while the camera and all else stand, by which
//! the flicker of a technique is seen.

use glam::{DVec3, Vec3, dvec3, vec3};

use super::assembly::Assembly;
use super::curves;
use super::patch::{Detail, Patch, sin_cos_turns};
use super::shapes::{Mapping, face};
use crate::scene::Material;
use crate::scene::animation::Curve;
use crate::scene::procedural::values::Values;

/// Radius of the panel's way, metres: between the walls with a hand's breadth to spare.
const CIRCLE_M: f64 = 1.2;
/// Stops of the spline that stands for the circle, from which it is off by less than a percent.
const STOPS: u32 = 8;
const PERIOD_S: u32 = 4;

const WIDTH_CM: f64 = 556.0;
const HEIGHT_CM: f64 = 548.8;
const DEPTH_CM: f64 = 559.2;

/// Chosen so that the picture is well exposed at 0 by either light; the warm tint is that of the published spectrum.
const PANEL_RADIANCE: Vec3 = vec3(30.0, 25.0, 18.0);

/// From a published point, in units, to metres.
fn metres(x: f64, y: f64, z: f64) -> DVec3 {
    dvec3(WIDTH_CM - x, y, DEPTH_CM - z) / 100.0
}

fn flat(corners: [[f64; 3]; 4]) -> Patch {
    let corners = corners.map(|[x, y, z]| metres(x, y, z));
    face(corners, Mapping::Repeat { tile_m: 1.0 }, Detail::COARSE)
}

/// A box from the four corners of its top, clockwise from above in published coordinates; its foot is left open.
fn block(height: f64, top: [[f64; 2]; 4]) -> Vec<Patch> {
    let corner = |index: usize, y: f64| [top[index % 4][0], y, top[index % 4][1]];
    let mut patches = vec![flat([0, 1, 2, 3].map(|index| corner(index, height)))];
    for side in 0..4 {
        patches.push(flat([corner(side, 0.0), corner(side + 1, 0.0), corner(side + 1, height), corner(side, height)]));
    }
    patches
}

/// The panel's way around `middle`, metres.
fn circle(middle: DVec3) -> Curve {
    let stop = |index: u32| {
        let (sine, cosine) = sin_cos_turns(f64::from(index) / f64::from(STOPS));
        middle + CIRCLE_M * dvec3(cosine, 0.0, sine)
    };
    curves::circuit(&(0..STOPS).map(stop).collect::<Vec<_>>(), PERIOD_S)
}

/// The box; the seed changes nothing.
pub fn make(values: &Values, _seed: u64) -> Assembly {
    let moves = values.get("motion") == 1;
    let mut assembly = Assembly::default();
    let white = assembly.material(Material::diffuse("white", vec3(0.73, 0.73, 0.71)));
    let red = assembly.material(Material::diffuse("red", vec3(0.63, 0.065, 0.05)));
    let green = assembly.material(Material::diffuse("green", vec3(0.14, 0.45, 0.091)));
    let panel = assembly.material(Material { emissive: PANEL_RADIANCE, ..Material::diffuse("panel", Vec3::ZERO) });

    let (w, h, d) = (WIDTH_CM, HEIGHT_CM, DEPTH_CM);
    let floor = [[w, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, d], [w, 0.0, d]];
    let ceiling = [[w, h, d], [0.0, h, d], [0.0, h, 0.0], [w, h, 0.0]];
    let back = [[w, 0.0, d], [0.0, 0.0, d], [0.0, h, d], [w, h, d]];
    let left = [[w, 0.0, 0.0], [w, 0.0, d], [w, h, d], [w, h, 0.0]];
    let right = [[0.0, 0.0, d], [0.0, 0.0, 0.0], [0.0, h, 0.0], [0.0, h, d]];
    // The panel lies in a hole of the ceiling, or moves a millimetre below one without: devices that set planes up from
    // snapped corners see the one through the other where they are a tenth of a millimetre apart.
    let y = if moves { h - 0.1 } else { h };
    let light = [[343.0, y, 332.0], [213.0, y, 332.0], [213.0, y, 227.0], [343.0, y, 227.0]];
    let beside = |side: usize| [ceiling[side], ceiling[(side + 1) % 4], light[(side + 1) % 4], light[side]];
    let ceiling = if moves { vec![flat(ceiling)] } else { (0..4).map(|side| flat(beside(side))).collect() };
    let short = [[130.0, 65.0], [82.0, 225.0], [240.0, 272.0], [290.0, 114.0]];
    let tall = [[423.0, 247.0], [265.0, 296.0], [314.0, 456.0], [472.0, 406.0]];
    for (name, material, patches) in [
        ("floor", white, vec![flat(floor)]),
        ("ceiling", white, ceiling),
        ("back_wall", white, vec![flat(back)]),
        ("left_wall", red, vec![flat(left)]),
        ("right_wall", green, vec![flat(right)]),
        ("short_block", white, block(165.0, short)),
        ("tall_block", white, block(330.0, tall)),
        ("panel", panel, vec![flat(light)]),
    ] {
        if name == "panel" && moves {
            let mesh = assembly.mesh(name, material, &patches);
            assembly.moving(name, mesh, circle(DVec3::ZERO), None, PERIOD_S);
        } else {
            assembly.fixed(name, material, &patches);
        }
    }

    const PANEL_AREA_M2: f32 = 1.30 * 1.05;
    let (below_panel, intensity) = (metres(278.0, y - 5.0, 279.5), PANEL_RADIANCE * (PANEL_AREA_M2 / 2.0));
    match moves {
        true => assembly.moving_point_light("lamp", circle(below_panel), intensity, PERIOD_S),
        false => assembly.point_light("panel".to_owned(), below_panel.as_vec3(), intensity, None),
    }
    // The published lens: 35 mm in front of a film of 25 mm.
    let y_fov = 0.686_43;
    assembly.camera("camera", metres(278.0, 273.0, -800.0), metres(278.0, 273.0, 0.0), y_fov);
    assembly
}
