//! The hall's stones: columns, arcades, walls, vaults, floors.

use glam::{DAffine3, DVec3, dvec3};

use super::materials::Materials;
use crate::scene::procedural::assembly::{place, shifted};
use crate::scene::procedural::hall::layout::{
    BAY_M, Details, LENGTH_M, NAVE_M, OUTER_M, SPRINGING_M, VAULT_M, WALL_M, bays, both_sides, column_lines,
};
use crate::scene::procedural::patch::{Detail, Patch, sin_cos_turns};
use crate::scene::procedural::pieces::Piece;
use crate::scene::procedural::shapes::{
    Curve, Mapping, Opening, Turning, WallExtent, arch, cuboid, face, moulding, pane, pierced_face, reveal, turned,
    turned_with,
};

const WINDOW: Opening = Opening { radius_m: 0.8, sill_m: 1.9, springing_m: 3.9 };
const GREAT_WINDOW: Opening = Opening { radius_m: 2.0, sill_m: 3.6, springing_m: 7.2 };
const PORTAL: Opening = Opening { radius_m: 1.6, sill_m: 0.0, springing_m: 3.0 };
/// How far windows and doors lie behind the face of their wall.
const RECESS_M: f64 = 0.5;

/// Everything that is built in.
pub fn pieces(materials: &Materials, details: Details) -> Vec<Piece> {
    let mut pieces = columns(materials, details);
    pieces.extend(arcade(materials, details));
    pieces.extend(aisles(materials, details));
    pieces.extend(ends(materials, details));
    pieces
}

fn columns(materials: &Materials, details: Details) -> Vec<Piece> {
    const SHAFT_FOOT_M: f64 = 0.6;
    const SHAFT_TOP_M: f64 = 3.8;
    const FLUTES: u32 = 20;
    let fine = details.fine;
    let around = fine.along(2.4, 6);
    let turning = |segments: u32, repeats: u32| Turning { segments, repeats, tile_m: 0.9, detail: fine };

    let mut base = cuboid(dvec3(-0.5, 0.0, -0.5), dvec3(0.5, 0.22, 0.5), 0.8, fine);
    if !details.sketch {
        let mouldings = [
            Curve::bent([0.47, 0.22], [0.56, 0.295], [0.47, 0.37]),
            Curve::bent([0.42, 0.37], [0.36, 0.425], [0.40, 0.48]),
            Curve::bent([0.42, 0.48], [0.485, 0.53], [0.42, 0.58]),
            Curve::line([0.42, 0.58], [0.37, SHAFT_FOOT_M]),
        ];
        base.extend(turned(&mouldings, turning(around, 3)));
    }
    base.extend(cuboid(dvec3(-0.52, 4.42, -0.52), dvec3(0.52, SPRINGING_M, 0.52), 0.8, fine));

    // A flute needs its two edges and its middle: where there is no room for them the shaft is smooth.
    // Their edge counts fourfold: they are what the eye follows.
    let per_flute = fine.along(4.0 * 2.3 / f64::from(FLUTES), 1);
    let fluted = per_flute >= 2;
    let foot_m = if details.sketch { 0.22 } else { SHAFT_FOOT_M };
    let shaft = || {
        if !fluted {
            return turned(&[Curve::line([0.36, foot_m], [0.31, SHAFT_TOP_M])], turning(around, 2));
        }
        let profile = [
            Curve::line([0.36, SHAFT_FOOT_M], [0.36, 0.66]),
            Curve::line([0.36, 0.66], [0.358, 0.8]),
            Curve::bent([0.358, 0.8], [0.35, 2.2], [0.312, 3.6]),
            Curve::line([0.312, 3.6], [0.31, 3.72]),
            Curve::line([0.31, 3.72], [0.31, SHAFT_TOP_M]),
        ];
        let long = Detail { edge_m: fine.edge_m * 4.0 };
        let turning = Turning { segments: FLUTES * per_flute, repeats: 2, tile_m: 1.3, detail: long };
        turned_with(&profile, turning, |turns, piece, t| {
            let across = turns * f64::from(FLUTES);
            let across = 2.0 * (across - across.floor()) - 1.0;
            let depth = [0.0, t, 1.0, 1.0 - t, 0.0][piece];
            1.0 - 0.085 * (1.0 - across * across) * depth
        })
    };

    // Two rows of leaves curl out of the bell.
    let lobed = around >= 24;
    let bell = if details.sketch {
        vec![Curve::line([0.31, SHAFT_TOP_M], [0.5, 4.42])]
    } else {
        vec![
            Curve::bent([0.31, SHAFT_TOP_M], [0.38, 3.83], [0.32, 3.87]),
            Curve::bent([0.33, 3.87], [0.33, 4.06], [0.43, 4.12]),
            Curve::bent([0.34, 4.12], [0.36, 4.32], [0.54, 4.38]),
            Curve::line([0.54, 4.38], [0.48, 4.42]),
        ]
    };
    let segments = if lobed { around.next_multiple_of(32) } else { around };
    let capital = turned_with(&bell, turning(segments, 4), move |turns, piece, t| {
        if !lobed || !(1..=2).contains(&piece) {
            return 1.0;
        }
        // The leaves of the upper row stand between those of the lower.
        let shift = 0.5 * (piece - 1) as f64;
        1.0 + 0.11 * sin_cos_turns(8.0 * turns + shift).1 * (4.0 * t * (1.0 - t)).max(0.0)
    });

    let standing = |alternate: usize| {
        let lines = column_lines().enumerate().filter(move |(index, _)| index % 2 == alternate).map(|(_, z)| z);
        both_sides(NAVE_M + 0.5 * WALL_M, 0.0, true, lines)
    };
    let all: Vec<_> = [standing(0), standing(1)].concat();
    vec![
        Piece { name: "column_base", material: materials.base, patches: base, places: all.clone() },
        Piece { name: "pale_shaft", material: materials.pale_shaft, patches: shaft(), places: standing(0) },
        Piece { name: "red_shaft", material: materials.red_shaft, patches: shaft(), places: standing(1) },
        Piece { name: "capital", material: materials.capital, patches: capital, places: all },
    ]
}

/// The walls on the columns, their arches, and what runs along them.
fn arcade(materials: &Materials, details: Details) -> Vec<Piece> {
    let Details { fine, middle, broad, .. } = details;
    let opening = Opening { radius_m: 1.55, sill_m: SPRINGING_M, springing_m: SPRINGING_M };
    let wall = |top_m: f64| WallExtent { half_width_m: 0.5 * BAY_M, bottom_m: SPRINGING_M, top_m };
    let half = 0.5 * BAY_M;
    let band = [[-half, 7.0], [half, 7.0], [half, 8.0], [-half, 8.0]].map(|[x, y]| dvec3(x, y, 0.015));
    let cornice = [
        Curve::line([0.0, 0.0], [0.06, 0.0]),
        Curve::bent([0.06, 0.0], [0.1, 0.14], [0.24, 0.16]),
        Curve::line([0.24, 0.16], [0.24, 0.22]),
        Curve::bent([0.24, 0.22], [0.36, 0.22], [0.36, 0.32]),
        Curve::line([0.36, 0.32], [0.0, 0.34]),
    ];
    let string_course = [
        Curve::bent([0.0, 0.0], [0.0, 0.1], [0.14, 0.1]),
        Curve::line([0.14, 0.1], [0.14, 0.18]),
        Curve::line([0.14, 0.18], [0.0, 0.2]),
    ];
    let archivolt = arch([1.5, 1.86], -0.36, 0.36, 9, middle);
    let stylobate = cuboid(dvec3(-half, -0.1, -0.75), dvec3(half, 0.04, 0.75), 1.6, broad);
    let wall_middle_m = NAVE_M + 0.5 * WALL_M;
    // Mouldings face +x in their own space, walls +z.
    let mouldings = |y: f64| -> Vec<_> {
        bays()
            .flat_map(|z| [place([0.0, 1.0], 1.0, dvec3(-NAVE_M, y, z)), place([0.0, -1.0], 1.0, dvec3(NAVE_M, y, z))])
            .collect()
    };
    vec![
        Piece {
            name: "arcade_wall",
            material: materials.nave_wall,
            patches: pierced_face(wall(VAULT_M), opening, 2.0, broad),
            places: both_sides(NAVE_M, 0.0, true, bays()),
        },
        Piece {
            name: "arcade_back",
            material: materials.aisle_vault,
            patches: pierced_face(wall(7.0), opening, 2.0, broad),
            places: both_sides(NAVE_M + WALL_M, 0.0, false, bays()),
        },
        Piece {
            name: "archivolt",
            material: materials.arch,
            patches: archivolt,
            places: both_sides(wall_middle_m, SPRINGING_M, true, bays()),
        },
        Piece {
            name: "frieze",
            material: materials.frieze,
            patches: vec![face(band, Mapping::Repeat { tile_m: 1.0 }, broad)],
            places: both_sides(NAVE_M, 0.0, true, bays()),
        },
        Piece {
            name: "cornice",
            material: materials.cornice,
            patches: moulding(&cornice, BAY_M, 1.0, fine_along_only(fine)),
            places: mouldings(VAULT_M - 0.22),
        },
        Piece {
            name: "string_course",
            material: materials.cornice,
            patches: moulding(&string_course, BAY_M, 1.0, fine_along_only(fine)),
            places: mouldings(6.72),
        },
        Piece {
            name: "stylobate",
            material: materials.stylobate,
            patches: stylobate,
            places: both_sides(wall_middle_m, 0.0, true, bays()),
        },
    ]
}

/// Mouldings are straight along their length: four times the edge shows no difference.
fn fine_along_only(fine: Detail) -> Detail {
    Detail { edge_m: fine.edge_m * 4.0 }
}

fn aisles(materials: &Materials, details: Details) -> Vec<Piece> {
    let Details { broad, .. } = details;
    let half = 0.5 * BAY_M;
    let wall = WallExtent { half_width_m: half, bottom_m: 0.0, top_m: 7.0 };
    let mut wall_patches = pierced_face(wall, WINDOW, 1.6, broad);
    wall_patches.extend(reveal(WINDOW, RECESS_M, 1.6, broad));
    let behind = |patches: Vec<Patch>, depth_m: f64| -> Vec<Patch> {
        let place = DAffine3::from_translation(DVec3::Z * -depth_m);
        patches.into_iter().map(|patch| patch.moved(place)).collect()
    };
    let Opening { radius_m: r, sill_m, springing_m } = WINDOW;
    let lattice = [[-r, sill_m], [r, sill_m], [r, springing_m + r], [-r, springing_m + r]];
    let lattice = face(lattice.map(|[x, y]| dvec3(x, y, -0.3)), Mapping::Repeat { tile_m: 0.4 }, broad);
    let mut pilaster = cuboid(dvec3(-0.3, 0.0, -0.05), dvec3(0.3, 4.45, 0.2), 0.8, broad);
    pilaster.extend(cuboid(dvec3(-0.36, 4.4, -0.05), dvec3(0.36, SPRINGING_M, 0.28), 0.8, broad));
    let mut wainscot = cuboid(dvec3(-half, 0.0, -0.05), dvec3(half, 1.25, 0.05), 1.3, broad);
    wainscot.extend(cuboid(dvec3(-half, 1.25, -0.05), dvec3(half, 1.33, 0.1), 1.3, broad));
    let aisle_middle_m = OUTER_M - half;
    let along_aisles = |y: f64, lines: Vec<f64>| -> Vec<_> {
        let sides = [-aisle_middle_m, aisle_middle_m];
        lines.iter().flat_map(|z| sides.map(|x| shifted(dvec3(x, y, *z)))).collect()
    };
    let floor = [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]].map(|[x, z]| dvec3(x * half, 0.0, z * half));
    let on_walls = || both_sides(OUTER_M, 0.0, true, bays());
    vec![
        Piece { name: "aisle_wall", material: materials.aisle_wall, patches: wall_patches, places: on_walls() },
        Piece {
            name: "window",
            material: materials.window,
            patches: behind(pane(WINDOW, broad), RECESS_M - 0.02),
            places: on_walls(),
        },
        Piece { name: "grille", material: materials.grille, patches: vec![lattice], places: on_walls() },
        Piece {
            name: "pilaster",
            material: materials.base,
            patches: pilaster,
            places: both_sides(OUTER_M, 0.0, true, column_lines()),
        },
        Piece { name: "wainscot", material: materials.wainscot, patches: wainscot, places: on_walls() },
        Piece {
            name: "aisle_floor",
            material: materials.aisle_floor,
            patches: vec![face(floor, Mapping::Repeat { tile_m: 2.0 }, broad)],
            places: along_aisles(0.0, bays().collect()),
        },
    ]
}

fn ends(materials: &Materials, details: Details) -> Vec<Piece> {
    let Details { middle, broad, .. } = details;
    let wall = WallExtent { half_width_m: OUTER_M + 0.1, bottom_m: 0.0, top_m: VAULT_M + NAVE_M + 0.3 };
    let end = |opening: Opening| {
        let mut patches = pierced_face(wall, opening, 3.0, broad);
        patches.extend(reveal(opening, RECESS_M, 3.0, middle));
        patches
    };
    let window = place([0.0, 1.0], 1.0, dvec3(0.0, 0.0, -0.5 * LENGTH_M));
    let door = place([0.0, -1.0], 1.0, dvec3(0.0, 0.0, 0.5 * LENGTH_M));
    let recessed = |opening: Opening| -> Vec<Patch> {
        let place = DAffine3::from_translation(DVec3::Z * (0.02 - RECESS_M));
        pane(opening, middle).into_iter().map(|patch| patch.moved(place)).collect()
    };
    let surround = |opening: Opening| {
        let Opening { radius_m: r, sill_m, springing_m } = opening;
        let rise = DAffine3::from_translation(DVec3::Y * springing_m);
        let mut patches: Vec<_> =
            arch([r - 0.04, r + 0.4], -0.1, 0.12, 11, middle).into_iter().map(|patch| patch.moved(rise)).collect();
        for x in [-r - 0.4, r - 0.04] {
            patches.extend(cuboid(dvec3(x, sill_m, -0.1), dvec3(x + 0.44, springing_m, 0.12), 0.88, middle));
        }
        patches
    };
    vec![
        Piece { name: "window_wall", material: materials.end_wall, patches: end(GREAT_WINDOW), places: vec![window] },
        Piece { name: "door_wall", material: materials.end_wall, patches: end(PORTAL), places: vec![door] },
        Piece {
            name: "great_window",
            material: materials.rose_window,
            patches: recessed(GREAT_WINDOW),
            places: vec![window],
        },
        Piece { name: "door", material: materials.door, patches: recessed(PORTAL), places: vec![door] },
        Piece {
            name: "window_surround",
            material: materials.arch,
            patches: surround(GREAT_WINDOW),
            places: vec![window],
        },
        Piece { name: "portal", material: materials.arch, patches: surround(PORTAL), places: vec![door] },
    ]
}
