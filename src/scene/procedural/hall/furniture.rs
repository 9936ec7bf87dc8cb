//! What stands and hangs in the hall: the five spheres on their dais, lamps, benches, urns, veils, the carpet.

use glam::{DAffine3, DVec3, Mat4, dvec2, dvec3};

use super::materials::Materials;
use crate::scene::procedural::assembly::shifted;
use crate::scene::procedural::hall::layout::{
    Details, LENGTH_M, NAVE_M, OUTER_M, SPRINGING_M, VAULT_M, WALL_M, bays, both_sides, column_lines,
};
use crate::scene::procedural::patch::{Detail, Patch, Point, moved, sin_cos_turns};
use crate::scene::procedural::pieces::Piece;
use crate::scene::procedural::shapes::{Curve, Turning, cuboid, prism, sphere, torus, turned, turned_with};

/// The middle of the dais on the floor of the nave.
const DAIS: DVec3 = dvec3(0.0, 0.0, -3.0);
const DAIS_HEIGHT_M: f64 = 0.48;
/// Height of a candelabrum's glass.
pub const CANDELABRUM_M: f64 = 1.75;
const NAVE_LAMP_M: f64 = 5.6;
const AISLE_LAMP_M: f64 = 3.7;

/// Where the lamps are, of each kind.
pub struct Lamps {
    /// Glasses in the nave.
    pub nave: Vec<DVec3>,
    /// Glasses in the aisles, in every second bay.
    pub aisle: Vec<DVec3>,
    /// Feet of the candelabra around the dais.
    pub candelabra: Vec<DVec3>,
}

impl Lamps {
    /// How many there can be.
    pub const MOST: u64 = 17;

    /// The first `count` of them.
    pub fn new(count: usize) -> Self {
        let nave = [-12.0, -6.0, 0.0, 6.0, 12.0].map(|z| dvec3(0.0, NAVE_LAMP_M, z));
        let x = 0.5 * (NAVE_M + WALL_M + OUTER_M);
        let aisle = bays().skip(1).step_by(2).flat_map(|z| [-x, x].map(|x| dvec3(x, AISLE_LAMP_M, z)));
        let corners = [[-2.4, -2.2], [2.4, -2.2], [-2.4, 2.2], [2.4, 2.2]];
        let candelabra = corners.map(|[x, z]| DAIS + dvec3(x, 0.0, z));
        let aisle: Vec<DVec3> = aisle.take(count.saturating_sub(nave.len())).collect();
        let rest = count.saturating_sub(nave.len() + aisle.len());
        Self {
            nave: nave.into_iter().take(count).collect(),
            aisle,
            candelabra: candelabra.into_iter().take(rest).collect(),
        }
    }
}

fn places(positions: &[DVec3]) -> Vec<Mat4> {
    positions.iter().copied().map(shifted).collect()
}

/// Everything that could be carried out.
pub fn pieces(materials: &Materials, details: Details, lit: &Lamps) -> Vec<Piece> {
    let mut pieces = dais(materials, details);
    pieces.extend(lamps(materials, details, lit));
    pieces.extend(along_the_walls(materials, details));
    let half = 0.5 * LENGTH_M;
    pieces.push(Piece {
        name: "carpet",
        material: materials.carpet,
        patches: cuboid(dvec3(0.0, -0.01, DAIS.z + 1.9), dvec3(2.2, 0.015, half), 2.2, details.broad),
        // The texture's border is at x = 0 of the cuboid's own space.
        places: vec![shifted(dvec3(-1.1, 0.0, 0.0))],
    });
    pieces
}

fn dais(materials: &Materials, details: Details) -> Vec<Piece> {
    let fine = details.fine;
    let around = fine.along(6.0, 12);
    let steps =
        [[2.0, 0.0], [2.0, 0.16], [1.65, 0.16], [1.65, 0.32], [1.3, 0.32], [1.3, DAIS_HEIGHT_M], [0.0, DAIS_HEIGHT_M]];
    let turning = Turning { segments: around, repeats: 8, tile_m: 1.2, detail: details.middle };
    let pedestal = |height_m: f64| {
        if details.sketch {
            return prism(4, [0.2, 0.2], height_m, 0.6);
        }
        let profile = [
            Curve::line([0.26, 0.0], [0.26, 0.08]),
            Curve::bent([0.26, 0.08], [0.17, 0.1], [0.16, 0.2]),
            Curve::line([0.16, 0.2], [0.14, height_m - 0.12]),
            Curve::bent([0.14, height_m - 0.12], [0.15, height_m - 0.05], [0.22, height_m - 0.04]),
            Curve::line([0.22, height_m - 0.04], [0.22, height_m]),
            Curve::line([0.22, height_m], [0.0, height_m]),
        ];
        turned(&profile, Turning { segments: fine.along(1.4, 8), repeats: 1, tile_m: 0.6, detail: fine })
    };
    let corners = [[-0.78, -0.78], [0.78, -0.78], [-0.78, 0.78], [0.78, 0.78]];
    let on_dais = |x: f64, y: f64, z: f64| DAIS + dvec3(x, DAIS_HEIGHT_M + y, z);
    let ball = |radius_m: f64| sphere(radius_m, fine.along(7.0 * radius_m, 8));
    let mut pieces = vec![
        Piece {
            name: "dais",
            material: materials.dais,
            patches: turned(&Curve::lines(&steps), turning),
            places: vec![shifted(DAIS)],
        },
        Piece {
            name: "pedestal",
            material: materials.stylobate,
            patches: pedestal(0.6),
            places: places(&corners.map(|[x, z]| on_dais(x, 0.0, z))),
        },
        Piece {
            name: "middle_pedestal",
            material: materials.stylobate,
            patches: pedestal(1.1),
            places: vec![shifted(on_dais(0.0, 0.0, 0.0))],
        },
        Piece {
            name: "middle_sphere",
            material: materials.gold,
            patches: ball(0.46),
            places: vec![shifted(on_dais(0.0, 1.54, 0.0))],
        },
    ];
    let names = ["copper_sphere", "jade_sphere", "blue_sphere", "silver_sphere"];
    let stuffs = [materials.copper, materials.jade, materials.glaze, materials.silver];
    for ((name, material), [x, z]) in names.into_iter().zip(stuffs).zip(corners) {
        pieces.push(Piece { name, material, patches: ball(0.3), places: vec![shifted(on_dais(x, 0.88, z))] });
    }
    pieces
}

fn lamps(materials: &Materials, details: Details, lit: &Lamps) -> Vec<Piece> {
    let fine = details.fine;
    let turning = |around_m: f64| Turning { segments: fine.along(around_m, 6), repeats: 2, tile_m: 0.4, detail: fine };
    let glass = |radius_m: f64| sphere(radius_m, fine.along(8.0 * radius_m, if details.sketch { 4 } else { 8 }));
    let rod = |radius_m: f64, from_m: f64, to_m: f64| {
        let profile = [Curve::line([radius_m, from_m], [radius_m, to_m])];
        let detail = Detail::COARSE;
        turned(&profile, Turning { segments: fine.along(0.1, 4), repeats: 1, tile_m: 1.0, detail })
    };
    // A crown around the glass, hung by three spokes from a cup above.
    let crown = |radius_m: f64| {
        let mut patches: Vec<_> =
            moved(torus(radius_m, 0.035, fine.along(6.5 * radius_m, 8), fine.along(0.3, 4)), DVec3::Y * 0.02).collect();
        let cup = [
            Curve::line([0.0, 0.12], [0.11, 0.12]),
            Curve::bent([0.11, 0.12], [0.1, 0.26], [0.03, 0.3]),
            Curve::line([0.03, 0.3], [0.0, 0.3]),
        ];
        patches.extend(turned(&cup, turning(0.9)));
        for (sine, cosine) in [0.0, 1.0, 2.0].map(|third| sin_cos_turns(third / 3.0)) {
            let turn = DAffine3::from_cols(dvec3(cosine, 0.0, -sine), DVec3::Y, dvec3(sine, 0.0, cosine), DVec3::ZERO);
            let arm = cuboid(dvec3(0.04, 0.15, -0.012), dvec3(radius_m + 0.02, 0.174, 0.012), 0.4, fine);
            patches.extend(arm.into_iter().map(|patch| patch.moved(turn)));
            let hook = cuboid(dvec3(radius_m - 0.01, 0.02, -0.01), dvec3(radius_m + 0.01, 0.16, 0.01), 0.4, fine);
            patches.extend(hook.into_iter().map(|patch| patch.moved(turn)));
        }
        patches
    };
    let stand = [
        Curve::line([0.26, 0.0], [0.26, 0.05]),
        Curve::bent([0.26, 0.05], [0.06, 0.08], [0.045, 0.3]),
        Curve::line([0.045, 0.3], [0.035, 0.8]),
        Curve::bent([0.035, 0.8], [0.14, 0.87], [0.035, 0.94]),
        Curve::line([0.035, 0.94], [0.03, 1.45]),
        Curve::bent([0.03, 1.45], [0.04, 1.58], [0.2, 1.64]),
        Curve::bent([0.2, 1.64], [0.08, 1.64], [0.0, 1.62]),
    ];
    vec![
        Piece { name: "nave_glass", material: materials.glow, patches: glass(0.15), places: places(&lit.nave) },
        Piece { name: "nave_crown", material: materials.brass, patches: crown(0.62), places: places(&lit.nave) },
        Piece {
            name: "nave_rod",
            material: materials.iron,
            patches: rod(0.018, 0.3, VAULT_M + NAVE_M - NAVE_LAMP_M),
            places: places(&lit.nave),
        },
        Piece { name: "aisle_glass", material: materials.glow, patches: glass(0.11), places: places(&lit.aisle) },
        Piece { name: "aisle_crown", material: materials.brass, patches: crown(0.3), places: places(&lit.aisle) },
        Piece {
            name: "aisle_rod",
            material: materials.iron,
            patches: rod(0.014, 0.3, SPRINGING_M + 2.0 - AISLE_LAMP_M),
            places: places(&lit.aisle),
        },
        Piece {
            name: "candelabrum",
            material: materials.brass,
            patches: turned(&stand, turning(1.2)),
            places: places(&lit.candelabra),
        },
        Piece {
            name: "candelabrum_glass",
            material: materials.glow,
            patches: moved(glass(0.11), DVec3::Y * CANDELABRUM_M).collect(),
            places: places(&lit.candelabra),
        },
    ]
}

fn along_the_walls(materials: &Materials, details: Details) -> Vec<Piece> {
    let Details { fine, middle, broad, .. } = details;
    let mut bench = cuboid(dvec3(-1.1, 0.42, 0.1), dvec3(1.1, 0.48, 0.55), 0.9, middle);
    for x in [-0.95, 0.85] {
        bench.extend(cuboid(dvec3(x, 0.0, 0.14), dvec3(x + 0.1, 0.43, 0.5), 0.9, middle));
    }
    let mut plinth = cuboid(dvec3(-0.34, 0.0, -0.34), dvec3(0.34, 0.12, 0.34), 0.7, broad);
    plinth.extend(moved(prism(8, [0.27, 0.25], 0.7, 0.7), DVec3::Y * 0.12));
    plinth.extend(cuboid(dvec3(-0.3, 0.82, -0.3), dvec3(0.3, 0.9, 0.3), 0.7, broad));
    let urn = || {
        let profile = [
            Curve::line([0.15, 0.0], [0.15, 0.03]),
            Curve::bent([0.15, 0.03], [0.05, 0.06], [0.06, 0.12]),
            Curve::bent([0.06, 0.12], [0.33, 0.24], [0.27, 0.48]),
            Curve::bent([0.27, 0.48], [0.21, 0.64], [0.11, 0.68]),
            Curve::bent([0.11, 0.68], [0.09, 0.76], [0.19, 0.8]),
            Curve::bent([0.19, 0.8], [0.08, 0.78], [0.0, 0.5]),
        ];
        let around = fine.along(1.7, 8);
        let turning = Turning { segments: around.next_multiple_of(4), repeats: 3, tile_m: 0.6, detail: fine };
        let ribbed = around >= 48;
        let patches = turned_with(&profile, turning, move |turns, _, t| {
            if ribbed { 1.0 + 0.03 * sin_cos_turns(12.0 * turns).1 * (4.0 * t * (1.0 - t)).max(0.0) } else { 1.0 }
        });
        moved(patches, DVec3::Y * 0.9).collect::<Vec<_>>()
    };
    // Urns stand before every second pilaster, benches under the windows.
    let before_m = OUTER_M - 0.75;
    let urns = |which: usize| both_sides(before_m, 0.0, true, column_lines().skip(which).step_by(4));
    // Cloth that hangs in folds, gathered more toward the hem.
    let veil = Patch::new(middle.along(7.0, 20), middle.along(3.5, 1), |s, t| {
        let depth = 0.04 + 0.09 * (1.0 - t);
        let fold = sin_cos_turns(5.0 * s + 0.15 * t).0 + 0.25 * sin_cos_turns(3.0 * s - 0.3 * t).0;
        Point { position: dvec3((s - 0.5) * 2.6, 0.7 + 3.7 * t, depth * fold), uv: dvec2(s * 2.0, 1.0 - t) }
    });
    let wall_middle_m = NAVE_M + 0.5 * WALL_M;
    let veiled: Vec<f64> = bays().skip(1).step_by(3).collect();
    let hung = || both_sides(wall_middle_m, 0.0, true, veiled.iter().copied());
    let rail = cuboid(dvec3(-1.6, 4.38, -0.02), dvec3(1.6, 4.42, 0.02), 0.5, broad);
    vec![
        Piece {
            name: "bench",
            material: materials.bench,
            patches: bench,
            places: both_sides(OUTER_M - 0.05, 0.0, true, bays()),
        },
        Piece {
            name: "plinth",
            material: materials.base,
            patches: plinth,
            places: both_sides(before_m, 0.0, true, column_lines().step_by(2)),
        },
        Piece { name: "copper_urn", material: materials.copper, patches: urn(), places: urns(0) },
        Piece { name: "blue_urn", material: materials.glaze, patches: urn(), places: urns(2) },
        Piece { name: "veil", material: materials.veil, patches: vec![veil], places: hung() },
        Piece { name: "veil_rail", material: materials.iron, patches: rail, places: hung() },
    ]
}
