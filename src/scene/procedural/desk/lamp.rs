//! The lamp: a heavy foot, two arms with a joint between, and a shade with a disc in it that shines.
//!
//! The disc, and no bulb, is the light: of a bulb every point of the desk sees one half, so that there would be no
//! place that is wholly lit.

use glam::{DVec3, Vec3, dvec3, vec3};

use crate::scene::Material;
use crate::scene::procedural::assembly::Assembly;
use crate::scene::procedural::desk::materials::Materials;
use crate::scene::procedural::patch::{Patch, placed};
use crate::scene::procedural::room::stood;
use crate::scene::procedural::shapes::{Curve, sphere, toward, tube, turned};
use crate::scene::procedural::wares::turning;

const FOOT: DVec3 = dvec3(-0.44, 0.0, -0.20);
const ELBOW: DVec3 = dvec3(-0.57, 0.44, -0.29);
/// The middle of the shade's rim, and where on the desk it points.
const HEAD: DVec3 = dvec3(-0.19, 0.49, -0.13);
const AIM: DVec3 = dvec3(-0.02, 0.0, 0.0);

/// Half the disc's width, and how far it is inside the rim.
const DISC_M: f64 = 0.055;
const INSIDE_M: f64 = 0.035;

/// A warm lamp; the desk under it is about as bright as white at exposure 0.
const DISC_RADIANCE: Vec3 = vec3(240.0, 200.0, 145.0);

/// The lamp on a desk `top_m` above the floor.
pub fn add(assembly: &mut Assembly, materials: &Materials, top_m: f64) {
    let up = DVec3::Y * top_m;
    let foot = [
        Curve::line([0.0, 0.0], [0.09, 0.0]),
        Curve::line([0.09, 0.0], [0.09, 0.012]),
        Curve::bent([0.09, 0.012], [0.086, 0.024], [0.02, 0.026]),
        Curve::line([0.02, 0.026], [0.016, 0.05]),
        Curve::line([0.016, 0.05], [0.0, 0.05]),
    ];
    let shade = [
        // Down its inside, around the rim, up its outside.
        Curve::line([0.0, 0.088], [0.02, 0.088]),
        Curve::bent([0.02, 0.088], [0.075, 0.08], [0.092, 0.0]),
        Curve::line([0.092, 0.0], [0.095, 0.0]),
        Curve::bent([0.095, 0.0], [0.078, 0.086], [0.026, 0.094]),
        Curve::line([0.026, 0.094], [0.022, 0.13]),
        Curve::line([0.022, 0.13], [0.0, 0.13]),
    ];
    // The shade's own y points away from the desk.
    let head = toward(HEAD + up, HEAD + up + (HEAD - AIM));
    let in_shade = |patches: Vec<Patch>| placed(patches, head).collect::<Vec<_>>();
    let mut enamel: Vec<Patch> = stood(turned(&foot, turning(36, 0.03)), 0.0, FOOT + up).collect();
    enamel.extend(in_shade(turned(&shade, turning(40, 0.02))));
    assembly.fixed("lamp", materials.enamel, &enamel);

    let neck = head.transform_point3(dvec3(0.0, 0.11, 0.0));
    let mut arms = Vec::new();
    for side in [-0.009, 0.009] {
        // Two rods side by side, as lamps with springs have them.
        let aside = dvec3(0.0, 0.0, side);
        arms.extend(tube(FOOT + up + aside + DVec3::Y * 0.04, ELBOW + up + aside, 0.0045, 8));
        arms.extend(tube(ELBOW + up + aside, neck + aside, 0.0045, 8));
    }
    for joint in [FOOT + up + DVec3::Y * 0.055, ELBOW + up, neck] {
        arms.extend(placed(sphere(0.017, 12), glam::DAffine3::from_translation(joint)));
    }
    assembly.fixed("lamp_arms", materials.steel, &arms);
    // A plate behind the disc, so that the shade's inside is shut.
    let plate = Curve::lines(&[[0.0, INSIDE_M + 0.001], [0.06, INSIDE_M + 0.001], [0.06, 0.05], [0.0, 0.05]]);
    assembly.fixed("lamp_plate", materials.lacquer, &in_shade(turned(&plate, turning(32, 1.0))));
    let disc = [Curve::line([0.0, INSIDE_M], [DISC_M, INSIDE_M])];
    let material = Material { emissive: DISC_RADIANCE, ..Material::diffuse("lamp_disc", Vec3::ZERO) };
    let material = assembly.material(material);
    assembly.fixed("lamp_disc", material, &in_shade(turned(&disc, turning(32, 1.0))));
}
