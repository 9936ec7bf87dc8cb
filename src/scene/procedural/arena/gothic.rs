//! The shapes of gothic building: pointed openings, their mouldings, walls and panes.
//!
//! In their own space walls stand in the plane z = 0 and are seen from +z, x to the right, y up; metres.

use glam::{DAffine3, DMat3, DVec2, DVec3, dvec2, dvec3};

use crate::scene::procedural::patch::{Detail, Patch, Point, sin_cos_turns};
use crate::scene::procedural::shapes::{Curve, Mapping, WallExtent, face, torus};

/// A pointed opening: straight jambs, then two arcs that meet over the middle, x = 0.
#[derive(Clone, Copy, Debug)]
pub struct Lancet {
    /// Half of the width between the jambs.
    pub half_m: f64,
    /// How far beyond the middle each arc has its own middle: 0 is a round arch.
    pub center_m: f64,
    pub sill_m: f64,
    /// Where the arcs begin.
    pub springing_m: f64,
}

impl Lancet {
    /// The same outline `by_m` farther out.
    pub fn offset(self, by_m: f64) -> Self {
        Self { half_m: self.half_m + by_m, ..self }
    }

    fn radius_m(self) -> f64 {
        self.half_m + self.center_m
    }

    /// From the springing to the point.
    pub fn rise_m(self) -> f64 {
        (self.radius_m() * self.radius_m() - self.center_m * self.center_m).sqrt()
    }

    /// The left arc, from its foot (0) to the point (1).
    fn arc(self, along: f64) -> DVec2 {
        let radius_m = self.radius_m();
        let point = dvec2(-self.center_m, self.rise_m()) / radius_m;
        let direction = (dvec2(-1.0, 0.0) * (1.0 - along) + point * along).normalize();
        dvec2(self.center_m, self.springing_m) + direction * radius_m
    }

    /// The arc on the left (`side` -1), upward, or on the right (1), downward; 0 to 1, smooth a little beyond.
    fn arc_on(self, side: f64, along: f64) -> DVec2 {
        if side < 0.0 { self.arc(along) } else { self.arc(1.0 - along) * dvec2(-1.0, 1.0) }
    }

    /// About as long as one arc is.
    fn arc_m(self) -> f64 {
        1.05 * dvec2(self.half_m, self.rise_m()).length()
    }

    /// Half of the width `above_m` the springing.
    fn half_above_m(self, above_m: f64) -> f64 {
        (self.radius_m() * self.radius_m() - above_m * above_m).sqrt() - self.center_m
    }
}

/// What runs round an opening: jambs from the sill, both arcs. `profile` is a cross-section as (outward from the
/// opening, z), from the back of the opening to its front and then outward.
pub fn surround(opening: Lancet, profile: &[Curve], tile_m: f64, detail: Detail) -> Vec<Patch> {
    let Lancet { sill_m, springing_m, .. } = opening;
    let (jamb_m, arc_m) = (springing_m - sill_m, opening.arc_m());
    let mut patches = Vec::new();
    let mut before_m = 0.0;
    for &curve in profile {
        let (start_m, length_m) = (before_m, curve.length());
        before_m += length_m;
        let uv = move |along_m: f64, t: f64| dvec2(along_m, -(start_m + t * length_m)) / tile_m;
        let rows = curve.segments(detail);
        for side in [-1.0, 1.0] {
            // Up on the left, down on the right.
            let jamb = Patch::new(detail.along(jamb_m * 0.3, 1), rows, move |s, t| {
                let at = curve.at(t);
                let up = if side < 0.0 { s } else { 1.0 - s };
                let x = side * (opening.half_m + at.x);
                let along_m = if side < 0.0 { s * jamb_m } else { (1.0 + s) * jamb_m + 2.0 * arc_m };
                Point { position: dvec3(x, sill_m + up * jamb_m, at.y), uv: uv(along_m, t) }
            });
            let first = if side < 0.0 { 0.0 } else { 1.0 };
            let arc = Patch::new(detail.along(arc_m, 4), rows, move |s, t| {
                let at = curve.at(t);
                let place = opening.offset(at.x).arc_on(side, s);
                Point { position: place.extend(at.y), uv: uv(jamb_m + (first + s) * arc_m, t) }
            });
            patches.extend([jamb, arc]);
        }
    }
    patches
}

/// A wall with an opening in it.
pub fn pierced(wall: WallExtent, opening: Lancet, tile_m: f64, detail: Detail) -> Vec<Patch> {
    let WallExtent { half_width_m: w, bottom_m, top_m } = wall;
    let Lancet { half_m: r, sill_m, springing_m, .. } = opening;
    let rectangle = |x: [f64; 2], y: [f64; 2]| {
        let corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[i, j]| dvec3(x[i], y[j], 0.0));
        face(corners, Mapping::Repeat { tile_m }, detail)
    };
    let mut patches = Vec::new();
    for x in [[-w, -r], [r, w]] {
        if springing_m > bottom_m {
            patches.push(rectangle(x, [bottom_m, springing_m]));
        }
        patches.push(rectangle(x, [springing_m, top_m]));
    }
    if sill_m > bottom_m {
        patches.push(rectangle([-r, r], [bottom_m, sill_m]));
    }
    for side in [-1.0, 1.0] {
        let columns = detail.along(opening.arc_m(), 6);
        patches.push(Patch::new(columns, detail.along(top_m - springing_m, 1), move |s, t| {
            let at = opening.arc_on(side, s);
            let position = dvec3(at.x, at.y * (1.0 - t) + top_m * t, 0.0);
            Point { position, uv: dvec2(position.x, -position.y) / tile_m }
        }));
    }
    patches
}

/// What fills an opening at z = 0, the picture once over its bounding rectangle.
pub fn pane(opening: Lancet, detail: Detail) -> Vec<Patch> {
    let Lancet { half_m, sill_m, springing_m, .. } = opening;
    let rise_m = opening.rise_m();
    let height_m = springing_m + rise_m - sill_m;
    let point = move |x: f64, y: f64| Point {
        position: dvec3(x, y, 0.0),
        uv: dvec2(0.5 + x / (2.0 * half_m), 1.0 - (y - sill_m) / height_m),
    };
    let columns = detail.along(2.0 * half_m, 2);
    let below = Patch::new(columns, detail.along(springing_m - sill_m, 1), move |s, t| {
        point((2.0 * s - 1.0) * half_m, sill_m + t * (springing_m - sill_m))
    });
    let above = Patch::new(columns, detail.along(rise_m, 6), move |s, t| {
        point((2.0 * s - 1.0) * opening.half_above_m(t * rise_m), springing_m + t * rise_m)
    });
    vec![below, above.collapsed(false, true)]
}

/// Bars that part an opening into two lights with a ring above, seen from both sides of z = 0.
pub fn tracery(opening: Lancet, bar_m: f64, detail: Detail) -> Vec<Patch> {
    let half_m = 0.5 * opening.half_m;
    let springing_m = opening.springing_m - 0.2 * opening.rise_m();
    let light = Lancet { half_m: half_m - bar_m, center_m: 0.6 * half_m, springing_m, ..opening };
    // Round at the front, open toward the wall behind.
    let bar = [
        Curve::line([0.0, -0.5 * bar_m], [0.0, 0.1 * bar_m]),
        Curve::bent([0.0, 0.1 * bar_m], [0.0, bar_m], [0.6 * bar_m, bar_m]),
        Curve::bent([0.6 * bar_m, bar_m], [1.3 * bar_m, bar_m], [1.3 * bar_m, 0.1 * bar_m]),
        Curve::line([1.3 * bar_m, 0.1 * bar_m], [1.3 * bar_m, -0.5 * bar_m]),
    ];
    let mut patches = Vec::new();
    for side in [-1.0, 1.0] {
        let shift = DAffine3::from_translation(DVec3::X * (side * half_m));
        patches.extend(surround(light, &bar, 1.0, detail).into_iter().map(|patch| patch.moved(shift)));
    }
    let ring_m = 0.36 * opening.half_m;
    let top_m = opening.springing_m + opening.rise_m();
    let middle_m = top_m - 2.05 * ring_m - bar_m;
    let upright = DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y);
    let at = DAffine3::from_mat3_translation(upright, DVec3::Y * middle_m);
    let foils = 4;
    for (radius_m, tube_m, place) in std::iter::once((ring_m, 0.6 * bar_m, at)).chain((0..foils).map(|foil| {
        let (sine, cosine) = sin_cos_turns(f64::from(foil) / f64::from(foils));
        let shift = dvec3(0.5 * ring_m * cosine, 0.0, 0.5 * ring_m * sine);
        (0.42 * ring_m, 0.4 * bar_m, at * DAffine3::from_translation(shift))
    })) {
        let ring = torus(radius_m, tube_m, detail.along(6.3 * radius_m, 12), detail.along(6.3 * tube_m, 5));
        patches.extend(ring.into_iter().map(|patch| patch.moved(place)));
    }
    patches
}

/// A moulding along x, `half_m` to each side: a cross-section as (z, y), from below upward.
pub fn course(profile: &[Curve], half_m: f64, tile_m: f64, detail: Detail) -> Vec<Patch> {
    let mut before_m = 0.0;
    let strip = |&curve: &Curve| {
        let (start_m, length_m) = (before_m, curve.length());
        before_m += length_m;
        Patch::new(detail.along(half_m, 1), curve.segments(detail), move |s, t| {
            let (at, x) = (curve.at(t), (2.0 * s - 1.0) * half_m);
            Point { position: dvec3(x, at.y, at.x), uv: dvec2(x, -(start_m + t * length_m)) / tile_m }
        })
    };
    profile.iter().map(strip).collect()
}

/// A rib along `path`, given as (z, y) from its foot upward: half of a round bar, `half_m` wide to each side and
/// `depth_m` deep, on the path's side toward +z and below.
pub fn rib(path: Curve, half_m: f64, depth_m: f64, tile_m: f64, detail: Detail) -> Patch {
    let length_m = path.length();
    Patch::new(detail.along(2.0 * depth_m, 5), detail.along(length_m, 8), move |s, t| {
        let (sine, cosine) = sin_cos_turns(0.5 * s);
        let at = path.at(t) + to_the_right(path, t) * (depth_m * sine);
        let uv = dvec2(s * 2.0 * depth_m, -t * length_m) / tile_m;
        Point { position: dvec3(-half_m * cosine, at.y, at.x), uv }
    })
}

/// The unit vector to the right of a curve's way.
pub fn to_the_right(curve: Curve, t: f64) -> DVec2 {
    let along = (curve.middle - curve.start) * (1.0 - t) + (curve.end - curve.middle) * t;
    dvec2(along.y, -along.x).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::procedural::checks::assert_mesh_is_sound;
    use crate::scene::procedural::patch::mesh;

    const OPENING: Lancet = Lancet { half_m: 1.0, center_m: 0.5, sill_m: 0.4, springing_m: 2.0 };
    const DETAIL: Detail = Detail { edge_m: 0.15 };

    #[test]
    fn both_arcs_meet_over_the_middle_and_keep_their_distance() {
        // A triangle of the radius, the distance of the middles, and the rise: 1.5, 0.5, the root of 2.
        assert!((OPENING.rise_m() - 2f64.sqrt()).abs() < 1e-12);
        assert!(OPENING.arc(0.0).abs_diff_eq(dvec2(-1.0, 2.0), 1e-12));
        assert!(OPENING.arc(1.0).abs_diff_eq(dvec2(0.0, 2.0 + 2f64.sqrt()), 1e-12));
        for step in 0..=10 {
            let at = OPENING.arc(f64::from(step) * 0.1);
            assert!((at.distance(dvec2(0.5, 2.0)) - 1.5).abs() < 1e-12, "{at}");
            assert!((OPENING.half_above_m(at.y - 2.0) + at.x).abs() < 1e-9, "{at}");
        }
    }

    #[test]
    fn walls_panes_and_courses_face_the_viewer_and_surrounds_the_opening() {
        let wall = WallExtent { half_width_m: 1.6, bottom_m: 0.0, top_m: 4.4 };
        let profile = [Curve::line([0.0, 0.0], [0.2, 0.1]), Curve::bent([0.2, 0.1], [0.3, 0.3], [0.1, 0.5])];
        for (name, patches) in [
            ("wall", pierced(wall, OPENING, 1.0, DETAIL)),
            ("pane", pane(OPENING, DETAIL)),
            ("course", course(&profile, 1.0, 1.0, DETAIL)),
        ] {
            let mesh = mesh(name, 0, &patches, true);
            assert_mesh_is_sound(&mesh);
            assert!(mesh.normals.iter().all(|normal| normal.z > -0.2), "{name}");
        }
        let inside = mesh("reveal", 0, &surround(OPENING, &[Curve::line([0.0, -1.0], [0.0, 0.0])], 1.0, DETAIL), true);
        assert_mesh_is_sound(&inside);
        let middle = dvec3(0.0, 1.9, -0.5);
        for (position, normal) in inside.positions.iter().zip(&inside.normals) {
            assert!((middle - position.as_dvec3()).dot(normal.as_dvec3()) > 0.0, "{position}");
        }
        let path = Curve::bent([0.0, 0.0], [0.5, 5.0], [6.0, 6.0]);
        for (name, patches) in
            [("tracery", tracery(OPENING, 0.06, DETAIL)), ("rib", vec![rib(path, 0.2, 0.3, 1.0, DETAIL)])]
        {
            assert_mesh_is_sound(&mesh(name, 0, &patches, true));
        }
        let rib = mesh("rib", 0, &[rib(path, 0.2, 0.3, 1.0, DETAIL)], true);
        // From below and before it, where those stand who look up.
        let seen =
            rib.positions.iter().zip(&rib.normals).filter(|(position, normal)| {
                (dvec3(0.0, -2.0, 8.0) - position.as_dvec3()).dot(normal.as_dvec3()) > 0.0
            });
        assert!(2 * seen.count() > rib.positions.len());
    }
}
