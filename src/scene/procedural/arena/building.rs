//! The arena's stones: niches with windows below, a gallery above, piers, and the ribbed vault.

use glam::{DAffine3, DMat3, DVec3, Mat4, dvec2, dvec3};

use super::gothic::{Lancet, course, pane, pierced, rib, surround, to_the_right, tracery};
use super::materials::Materials;
use crate::scene::procedural::arena::layout::{
    BAY_COUNT, Details, GALLERY_M, HALF_BAY_M, LANTERN_M, LANTERN_RADIUS_M, NICHE_M, RADIUS_M, VAULT_M, bays, corners,
};
use crate::scene::procedural::assembly::shifted;
use crate::scene::procedural::patch::{Detail, Patch, Point, moved, sin_cos_turns};
use crate::scene::procedural::pieces::Piece;
use crate::scene::procedural::shapes::{Curve, Mapping, Turning, WallExtent, cuboid, face, torus, turned, turned_with};

/// From the wall of the round to that of a niche: thickness of the wall between.
const WALL_M: f64 = 0.8;
const NICHE: Lancet = Lancet { half_m: 1.12, center_m: 0.55, sill_m: 0.0, springing_m: 3.0 };
const WINDOW: Lancet = Lancet { half_m: 0.72, center_m: 0.5, sill_m: 1.3, springing_m: 2.9 };
const GALLERY: Lancet = Lancet { half_m: 0.5, center_m: 0.3, sill_m: GALLERY_M, springing_m: 7.7 };
/// How far the openings of the gallery reach back.
const GALLERY_DEPTH_M: f64 = 1.1;

/// Everything that is built in but the pavement.
pub fn pieces(materials: &Materials, details: Details) -> Vec<Piece> {
    let mut pieces = niches(materials, details);
    pieces.extend(gallery(materials, details));
    pieces.extend(vault(materials, details));
    pieces.push(Piece { name: "pier", material: materials.pier, patches: pier(details), places: corners() });
    pieces
}

/// Rolls and hollows of an arch, from its own edge outward and to the front.
fn rolls(wide_m: f64) -> Vec<Curve> {
    let w = wide_m;
    vec![
        Curve::bent([0.0, 0.0], [0.0, 0.45 * w], [0.18 * w, 0.45 * w]),
        Curve::bent([0.18 * w, 0.45 * w], [0.36 * w, 0.45 * w], [0.36 * w, 0.28 * w]),
        Curve::bent([0.36 * w, 0.28 * w], [0.52 * w, 0.28 * w], [0.55 * w, 0.5 * w]),
        Curve::bent([0.55 * w, 0.5 * w], [0.75 * w, 0.75 * w], [0.95 * w, 0.5 * w]),
        Curve::line([0.95 * w, 0.5 * w], [w, -0.05]),
    ]
}

fn niches(materials: &Materials, details: Details) -> Vec<Piece> {
    let Details { fine, middle, broad } = details;
    let wall = WallExtent { half_width_m: HALF_BAY_M, bottom_m: 0.0, top_m: GALLERY_M };
    // A niche widens outward as its bay does; its head rises with it.
    let widening_m = 0.24;
    let back = DVec3::NEG_Z * NICHE_M;
    let inside = [Curve::line([widening_m, -NICHE_M], [0.0, -WALL_M]), Curve::line([0.0, -WALL_M], [0.0, 0.0])];
    let behind = WallExtent { half_width_m: NICHE.half_m + widening_m + 0.1, bottom_m: 0.0, top_m: 5.2 };
    let mut back_wall: Vec<Patch> = moved(pierced(behind, WINDOW, 1.6, broad), back).collect();
    let splay = [Curve::line([-0.06, -0.35], [0.0, 0.0])];
    back_wall.extend(moved(surround(WINDOW, &splay, 1.6, middle), back));
    let sill = [[-1.0, -0.35], [1.0, -0.35], [1.0, 0.0], [-1.0, 0.0]];
    let sill = sill.map(|[x, z]| dvec3(x * WINDOW.half_m, WINDOW.sill_m, -NICHE_M + z));
    // From the left front corner: z grows toward the viewer.
    let [a, b, c, d] = sill;
    back_wall.push(face([d, c, b, a], Mapping::Repeat { tile_m: 1.6 }, broad));
    let glazed = WINDOW.offset(-0.05);
    let panes = |parity: usize| bays().into_iter().skip(parity).step_by(2).collect::<Vec<_>>();
    let window = || moved(pane(glazed, middle), back - DVec3::Z * 0.32).collect::<Vec<_>>();
    // Attached shafts on both sides of the opening, turned, with their own bases and capitals.
    let shaft = [
        Curve::line([0.13, 0.0], [0.13, 0.12]),
        Curve::bent([0.13, 0.12], [0.15, 0.17], [0.09, 0.22]),
        Curve::line([0.09, 0.22], [0.085, 2.62]),
        Curve::bent([0.085, 2.62], [0.13, 2.64], [0.09, 2.68]),
        Curve::bent([0.09, 2.68], [0.09, 2.86], [0.17, 2.94]),
        Curve::line([0.17, 2.94], [0.17, 3.0]),
        Curve::line([0.17, 3.0], [0.0, 3.0]),
    ];
    let turning = Turning { segments: fine.along(0.6, 8), repeats: 1, tile_m: 0.8, detail: fine };
    let beside = |side: f64| {
        let shift = Mat4::from_translation(dvec3(side * (NICHE.half_m + 0.2), 0.0, 0.1).as_vec3());
        bays().into_iter().map(move |bay| bay * shift).collect::<Vec<_>>()
    };
    let string = [
        Curve::bent([0.0, 5.28], [0.06, 5.36], [0.14, 5.38]),
        Curve::bent([0.14, 5.38], [0.26, 5.38], [0.26, 5.46]),
        Curve::line([0.26, 5.46], [0.26, 5.54]),
        Curve::line([0.26, 5.54], [-0.1, GALLERY_M + 0.01]),
    ];
    vec![
        Piece {
            name: "arcade_wall",
            material: materials.wall,
            patches: pierced(wall, NICHE, 2.2, broad),
            places: bays(),
        },
        Piece {
            name: "niche",
            material: materials.niche,
            patches: surround(NICHE, &inside, 1.8, middle),
            places: bays(),
        },
        Piece {
            name: "archivolt",
            material: materials.arch,
            patches: surround(Lancet { sill_m: 3.0, springing_m: 3.02, ..NICHE }, &rolls(0.36), 0.7, fine_along(fine)),
            places: bays(),
        },
        Piece { name: "niche_back", material: materials.niche, patches: back_wall, places: bays() },
        Piece { name: "red_window", material: materials.glass[0], patches: window(), places: panes(0) },
        Piece { name: "blue_window", material: materials.glass[1], patches: window(), places: panes(1) },
        Piece {
            name: "tracery",
            material: materials.dressed,
            patches: moved(tracery(WINDOW, 0.055, fine), back - DVec3::Z * 0.22).collect(),
            places: bays(),
        },
        Piece {
            name: "left_shaft",
            material: materials.dressed,
            patches: turned(&shaft, turning),
            places: beside(-1.0),
        },
        Piece {
            name: "right_shaft",
            material: materials.dressed,
            patches: turned(&shaft, turning),
            places: beside(1.0),
        },
        Piece {
            name: "string_course",
            material: materials.dressed,
            patches: course(&string, HALF_BAY_M + 0.03, 1.0, fine_along(fine)),
            places: bays(),
        },
    ]
}

/// Mouldings bend across, not along: there a longer edge shows no difference.
fn fine_along(fine: Detail) -> Detail {
    Detail { edge_m: fine.edge_m * 1.5 }
}

fn gallery(materials: &Materials, details: Details) -> Vec<Piece> {
    let Details { fine, middle, broad } = details;
    let half = 0.5 * HALF_BAY_M;
    let wall = WallExtent { half_width_m: half, bottom_m: GALLERY_M, top_m: VAULT_M };
    // Two openings a bay.
    let twice = || -> Vec<Mat4> {
        let beside = |bay: Mat4, side: f64| bay * Mat4::from_translation((DVec3::X * (side * half)).as_vec3());
        bays().into_iter().flat_map(|bay| [-1.0, 1.0].map(|side| beside(bay, side))).collect()
    };
    let mut wall_patches = pierced(wall, GALLERY, 2.2, broad);
    wall_patches.extend(surround(GALLERY, &[Curve::line([0.0, -GALLERY_DEPTH_M], [0.0, 0.0])], 2.2, middle));
    let floor = [[-1.0, 0.0], [1.0, 0.0], [1.0, -GALLERY_DEPTH_M], [-1.0, -GALLERY_DEPTH_M]];
    let floor = floor.map(|[x, z]| dvec3(x * GALLERY.half_m, GALLERY_M, z));
    wall_patches.push(face(floor, Mapping::Repeat { tile_m: 2.2 }, broad));
    let baluster = [
        Curve::line([0.05, 0.0], [0.05, 0.06]),
        Curve::bent([0.05, 0.06], [0.02, 0.1], [0.03, 0.2]),
        Curve::bent([0.03, 0.2], [0.085, 0.32], [0.03, 0.5]),
        Curve::bent([0.03, 0.5], [0.02, 0.58], [0.05, 0.62]),
    ];
    let turning = Turning { segments: fine.along(0.35, 6), repeats: 1, tile_m: 0.6, detail: fine };
    let width_m = HALF_BAY_M - 0.3;
    let mut rail: Vec<Patch> = Vec::new();
    for index in 0..8 {
        let x = (f64::from(index) - 3.5) * 0.25 * width_m;
        rail.extend(moved(turned(&baluster, turning), dvec3(x, GALLERY_M + 0.1, 0.14)));
    }
    for [low_m, high_m] in [[GALLERY_M, GALLERY_M + 0.1], [GALLERY_M + 0.7, GALLERY_M + 0.82]] {
        rail.extend(cuboid(dvec3(-width_m, low_m, 0.04), dvec3(width_m, high_m, 0.24), 0.8, broad));
    }
    let shaft = [
        Curve::line([0.12, GALLERY_M], [0.12, GALLERY_M + 0.12]),
        Curve::bent([0.12, GALLERY_M + 0.12], [0.1, 5.84], [0.075, 5.86]),
        Curve::line([0.075, 5.86], [0.07, 7.4]),
        Curve::bent([0.07, 7.4], [0.12, 7.42], [0.075, 7.46]),
        Curve::bent([0.075, 7.46], [0.08, 7.6], [0.15, 7.66]),
        Curve::line([0.15, 7.66], [0.15, 7.72]),
        Curve::line([0.15, 7.72], [0.0, 7.72]),
    ];
    let cornice = [
        Curve::bent([0.0, 9.3], [0.08, 9.38], [0.16, 9.4]),
        Curve::bent([0.16, 9.4], [0.3, 9.42], [0.3, 9.56]),
        Curve::bent([0.3, 9.56], [0.46, 9.58], [0.46, 9.72]),
        Curve::line([0.46, 9.72], [0.46, VAULT_M]),
        Curve::line([0.46, VAULT_M], [-0.5, VAULT_M + 0.02]),
    ];
    vec![
        Piece { name: "gallery_wall", material: materials.wall, patches: wall_patches, places: twice() },
        Piece {
            name: "gallery_arch",
            material: materials.arch,
            patches: surround(
                Lancet { sill_m: 7.7, springing_m: 7.72, ..GALLERY },
                &rolls(0.22),
                0.5,
                fine_along(fine),
            ),
            places: twice(),
        },
        Piece {
            name: "gallery_window",
            material: materials.dusk,
            patches: moved(pane(GALLERY, broad), DVec3::NEG_Z * GALLERY_DEPTH_M).collect(),
            places: twice(),
        },
        Piece { name: "balustrade", material: materials.dressed, patches: rail, places: bays() },
        Piece {
            name: "gallery_shaft",
            material: materials.dressed,
            patches: moved(turned(&shaft, turning), DVec3::Z * 0.06).collect(),
            places: bays(),
        },
        Piece { name: "rosette", material: materials.dressed, patches: rosette(fine), places: bays() },
        Piece {
            name: "cornice",
            material: materials.dressed,
            patches: course(&cornice, HALF_BAY_M + 0.06, 1.0, fine_along(fine)),
            places: bays(),
        },
    ]
}

/// A ring of stone with six foils, between the heads of the gallery's openings.
fn rosette(fine: Detail) -> Vec<Patch> {
    let upright = DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y);
    let middle = DAffine3::from_mat3_translation(upright, dvec3(0.0, 8.85, 0.03));
    let ring = |radius_m: f64, tube_m: f64| torus(radius_m, tube_m, fine.along(6.3 * radius_m, 10), fine.along(0.3, 5));
    let mut patches: Vec<Patch> = ring(0.36, 0.06).into_iter().map(|patch| patch.moved(middle)).collect();
    for foil in 0..6 {
        let (sine, cosine) = sin_cos_turns(f64::from(foil) / 6.0);
        let at = middle * DAffine3::from_translation(dvec3(0.2 * cosine, 0.0, 0.2 * sine));
        patches.extend(ring(0.1, 0.035).into_iter().map(|patch| patch.moved(at)));
    }
    patches
}

/// A pier of eight shafts about a core, from the floor to the vault, ringed at the gallery's floor.
fn pier(details: Details) -> Vec<Patch> {
    let Details { fine, .. } = details;
    let profile = [
        Curve::line([0.72, 0.0], [0.72, 0.3]),
        Curve::bent([0.72, 0.3], [0.76, 0.4], [0.66, 0.46]),
        Curve::bent([0.62, 0.46], [0.52, 0.52], [0.56, 0.62]),
        Curve::bent([0.56, 0.62], [0.6, 0.7], [0.48, 0.76]),
        Curve::line([0.48, 0.76], [0.46, 5.3]),
        Curve::bent([0.46, 5.3], [0.66, 5.36], [0.46, 5.62]),
        Curve::line([0.46, 5.62], [0.44, 9.1]),
        Curve::bent([0.44, 9.1], [0.52, 9.12], [0.46, 9.2]),
        Curve::bent([0.46, 9.2], [0.46, 9.5], [0.72, 9.66]),
        Curve::line([0.72, 9.66], [0.72, VAULT_M + 0.05]),
        Curve::line([0.72, VAULT_M + 0.05], [0.0, VAULT_M + 0.05]),
    ];
    let segments = fine.along(3.2, 24).next_multiple_of(16);
    // Straight along the shafts, finer where it is moulded.
    let turning = Turning { segments, repeats: 4, tile_m: 0.9, detail: Detail { edge_m: fine.edge_m * 1.5 } };
    turned_with(
        &profile,
        turning,
        |turns, piece, _| {
            if matches!(piece, 4..=6) { 1.0 + 0.13 * sin_cos_turns(8.0 * turns).1 } else { 1.0 }
        },
    )
}

/// The way of the ribs, as (z, y) from a pier's head to the lantern.
fn rib_path() -> Curve {
    let top = [RADIUS_M - LANTERN_RADIUS_M, LANTERN_M];
    Curve::bent([0.1, VAULT_M], [1.2, 16.6], top)
}

fn vault(materials: &Materials, details: Details) -> Vec<Piece> {
    let Details { fine, middle, .. } = details;
    let path = rib_path();
    let length_m = path.length();
    // Between two ribs the stones arch outward, most at their feet.
    let web = Patch::new(middle.along(2.0 * HALF_BAY_M, 6), middle.along(length_m, 12), move |s, t| {
        let (sine, cosine) = sin_cos_turns((s - 0.5) / f64::from(BAY_COUNT));
        let swell = 0.55 * 4.0 * s * (1.0 - s) * (1.0 - t);
        let at = path.at(t) - to_the_right(path, t) * swell;
        let radius_m = RADIUS_M - at.x;
        // As wide in the picture everywhere as it is at the foot: courses narrow toward the lantern.
        let uv = dvec2(s * 3.4, -t * length_m) / 2.0;
        Point { position: dvec3(radius_m * sine, at.y, RADIUS_M - radius_m * cosine), uv }
    });
    let opening_ring = [
        Curve::bent([LANTERN_RADIUS_M - 0.3, 0.5], [LANTERN_RADIUS_M - 0.35, -0.1], [LANTERN_RADIUS_M - 0.05, -0.3]),
        Curve::bent([LANTERN_RADIUS_M - 0.05, -0.3], [LANTERN_RADIUS_M + 0.3, -0.4], [LANTERN_RADIUS_M + 0.4, 0.1]),
    ];
    let around = Turning { segments: middle.along(14.0, 24), repeats: 12, tile_m: 1.0, detail: middle };
    let radius_m = LANTERN_RADIUS_M - 0.2;
    // Seen from below: x runs to the right where z runs up.
    let glass = Patch::new(around.segments, 3, move |s, t| {
        let (sine, cosine) = sin_cos_turns(s);
        let place = dvec3(cosine, 0.0, sine) * (radius_m * (1.0 - t));
        Point { position: place, uv: dvec2(0.5 + place.x / (2.0 * radius_m), 0.5 - place.z / (2.0 * radius_m)) }
    });
    let boss =
        [Curve::bent([0.0, -0.42], [0.16, -0.42], [0.2, -0.26]), Curve::bent([0.2, -0.26], [0.34, -0.2], [0.24, 0.0])];
    let boss = turned_with(
        &boss,
        Turning { segments: fine.along(1.4, 16).next_multiple_of(8), repeats: 1, tile_m: 0.6, detail: fine },
        |turns, piece, t| {
            if piece == 1 { 1.0 + 0.14 * sin_cos_turns(8.0 * turns).1 * (4.0 * t * (1.0 - t)).max(0.0) } else { 1.0 }
        },
    );
    let half_way = path.at(0.62);
    let on_ribs = |at: glam::DVec2| -> Vec<Mat4> {
        let shift = Mat4::from_translation(dvec3(0.0, at.y, at.x).as_vec3());
        corners().into_iter().map(|corner| corner * shift).collect()
    };
    vec![
        Piece {
            name: "rib",
            material: materials.arch,
            patches: vec![rib(path, 0.22, 0.36, 0.8, middle)],
            places: corners(),
        },
        Piece { name: "web", material: materials.web, patches: vec![web], places: bays() },
        Piece { name: "boss", material: materials.gold, patches: boss, places: on_ribs(half_way) },
        Piece {
            name: "lantern_ring",
            material: materials.dressed,
            patches: turned(&opening_ring, around).into_iter().collect(),
            places: vec![shifted(DVec3::Y * LANTERN_M)],
        },
        Piece {
            name: "lantern_window",
            material: materials.glass[1],
            patches: vec![glass.collapsed(false, true)],
            places: vec![shifted(DVec3::Y * (LANTERN_M + 0.3))],
        },
    ]
}
