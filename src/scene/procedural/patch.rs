//! Curved quadrilaterals: what every procedural shape is made of.
//!
//! A patch is a function of two numbers. Counting its triangles costs nothing, so a scene can try tessellations until
//! it meets its budget and evaluate only the last. Normals and tangents come from differences of that function, so that
//! a shape is one formula and cannot disagree with its own normals.
//!
//! Only + - * / and sqrt are used, in f64: IEEE 754 fixes their results, libm's sine is another on every system.

use std::rc::Rc;

use glam::{DAffine3, DVec2, DVec3, Vec2, Vec3, Vec4};

use super::charts::{self, Chart};
use crate::scene::Mesh;

/// One point of a patch: metres, and texture coordinates in glTF's convention (v runs down).
#[derive(Clone, Copy, Debug)]
pub struct Point {
    pub position: DVec3,
    pub uv: DVec2,
}

type Surface = Rc<dyn Fn(f64, f64) -> Point>;

/// A grid of `columns` x `rows` quadrilaterals over s, t in 0 to 1.
///
/// s runs to the right and t upward as seen from outside, and so do u and -v: no texture is mirrored, the handedness of
/// every tangent is +1.
#[derive(Clone)]
pub struct Patch {
    columns: u32,
    rows: u32,
    /// Whether the row t = 0, and the row t = 1, is a single point.
    collapsed: [bool; 2],
    surface: Surface,
}

/// How finely to divide.
#[derive(Clone, Copy, Debug)]
pub struct Detail {
    /// Metres that an edge should have.
    pub edge_m: f64,
}

impl Detail {
    /// Every flat face one quadrilateral, every curve as coarse as it may be.
    pub const COARSE: Self = Self { edge_m: f64::INFINITY };

    /// How many segments a curve of `length_m` gets: at least `least`, which is at least 1.
    pub fn along(self, length_m: f64, least: u32) -> u32 {
        ((length_m / self.edge_m).round() as u32).max(least)
    }
}

impl Patch {
    /// `columns` and `rows` at least 1. `surface` is also evaluated a little outside of 0 to 1.
    pub fn new(columns: u32, rows: u32, surface: impl Fn(f64, f64) -> Point + 'static) -> Self {
        assert!(columns > 0 && rows > 0, "a patch of {columns} x {rows} has no triangles");
        Self { columns, rows, collapsed: [false; 2], surface: Rc::new(surface) }
    }

    /// Says which of the rows t = 0 and t = 1 are points: their triangles without area are left out.
    pub fn collapsed(mut self, first: bool, last: bool) -> Self {
        self.collapsed = [first, last];
        self
    }

    /// The same patch elsewhere. `place` must not mirror.
    pub fn moved(self, place: DAffine3) -> Self {
        let surface = self.surface;
        Self {
            surface: Rc::new(move |s, t| {
                let point = surface(s, t);
                Point { position: place.transform_point3(point.position), ..point }
            }),
            ..self
        }
    }

    /// The same patch with every place put where `bend` has it, which must neither mirror nor fold.
    pub fn bent(self, bend: impl Fn(DVec3) -> DVec3 + 'static) -> Self {
        let surface = self.surface;
        Self {
            surface: Rc::new(move |s, t| {
                let point = surface(s, t);
                Point { position: bend(point.position), ..point }
            }),
            ..self
        }
    }

    /// How many triangles it becomes.
    pub fn triangle_count(&self) -> u64 {
        let points = self.collapsed.iter().filter(|collapsed| **collapsed).count() as u64;
        u64::from(self.columns) * (2 * u64::from(self.rows) - points)
    }

    fn write(&self, mesh: &mut Mesh) {
        let base = mesh.positions.len() as u32;
        for row in 0..=self.rows {
            for column in 0..=self.columns {
                let s = f64::from(column) / f64::from(self.columns);
                let t = f64::from(row) / f64::from(self.rows);
                let point = (self.surface)(s, t);
                let (normal, tangent) = self.frame(s, t);
                // Adding +0 turns -0 into +0: vertices that are equal are then equal bit for bit.
                mesh.positions.push(point.position.as_vec3() + Vec3::ZERO);
                mesh.normals.push(normal);
                mesh.tangents.push(tangent.extend(1.0));
                mesh.uvs.push(point.uv.as_vec2() + Vec2::ZERO);
            }
        }
        for row in 0..self.rows {
            for column in 0..self.columns {
                let lower = base + row * (self.columns + 1) + column;
                let upper = lower + self.columns + 1;
                if !(row == 0 && self.collapsed[0]) {
                    mesh.indices.extend([lower, lower + 1, upper + 1]);
                }
                if !(row + 1 == self.rows && self.collapsed[1]) {
                    mesh.indices.extend([lower, upper + 1, upper]);
                }
            }
        }
    }

    /// How wide and how high its vertices, which follow each other in `positions`, lie: the mean length of its rows and of its
    /// columns, metres.
    fn size_m(&self, positions: &[Vec3]) -> DVec2 {
        let (columns, rows) = (self.columns as usize, self.rows as usize);
        let at = |column: usize, row: usize| positions[row * (columns + 1) + column].as_dvec3();
        let all = || (0..=rows).flat_map(|row| (0..=columns).map(move |column| (column, row)));
        let along: f64 = all().filter(|at| at.0 > 0).map(|(c, r)| at(c, r).distance(at(c - 1, r))).sum();
        let up: f64 = all().filter(|at| at.1 > 0).map(|(c, r)| at(c, r).distance(at(c, r - 1))).sum();
        DVec2::new(along / (rows + 1) as f64, up / (columns + 1) as f64)
    }

    /// Where its vertices lie in the atlas.
    fn write_atlas(&self, chart: &Chart, atlas: &mut Vec<Vec2>) {
        for row in 0..=self.rows {
            for column in 0..=self.columns {
                // v runs down.
                let part = [f64::from(column) / f64::from(self.columns), 1.0 - f64::from(row) / f64::from(self.rows)];
                atlas.push(chart.at(part).as_vec2().min(Vec2::ONE));
            }
        }
    }

    /// Unit normal, and unit tangent along increasing u.
    fn frame(&self, s: f64, t: f64) -> (Vec3, Vec3) {
        let (mut along_s, mut along_t) = self.slopes(s, t);
        let mut normal = along_s.position.cross(along_t.position);
        let size = along_s.position.length() + along_t.position.length();
        if normal.length() < 1e-6 * (size * size).max(1e-6) {
            // A pole, or a corner where the formula stands still: its neighbourhood knows.
            (along_s, along_t) = self.slopes(s + (0.5 - s) * 1e-3, t + (0.5 - t) * 1e-3);
            normal = along_s.position.cross(along_t.position);
        }
        let normal = normal.normalize();
        let area = along_s.uv.x * along_t.uv.y - along_s.uv.y * along_t.uv.x;
        let along_u = (along_s.position * along_t.uv.y - along_t.position * along_s.uv.y) / area;
        let tangent = (along_u - normal * normal.dot(along_u)).normalize();
        (normal.as_vec3().normalize(), tangent.as_vec3().normalize())
    }

    fn slopes(&self, s: f64, t: f64) -> (Point, Point) {
        const STEP: f64 = 1e-5;
        let difference = |before: Point, after: Point| Point {
            position: (after.position - before.position) / (2.0 * STEP),
            uv: (after.uv - before.uv) / (2.0 * STEP),
        };
        let at = &self.surface;
        (difference(at(s - STEP, t), at(s + STEP, t)), difference(at(s, t - STEP), at(s, t + STEP)))
    }
}

/// The same patches elsewhere. `place` must not mirror.
pub fn placed(patches: Vec<Patch>, place: DAffine3) -> impl Iterator<Item = Patch> {
    patches.into_iter().map(move |patch| patch.moved(place))
}

/// The same patches, shifted, metres.
pub fn moved(patches: Vec<Patch>, shift: DVec3) -> impl Iterator<Item = Patch> {
    placed(patches, DAffine3::from_translation(shift))
}

/// The same patches, every place put where `bend` has it, which must neither mirror nor fold.
pub fn bent(patches: Vec<Patch>, bend: impl Fn(DVec3) -> DVec3 + Copy + 'static) -> impl Iterator<Item = Patch> {
    patches.into_iter().map(move |patch| patch.bent(bend))
}

/// A turn about the y axis, from +z toward +x.
pub fn around_y(turns: f64) -> DAffine3 {
    let (sine, cosine) = sin_cos_turns(turns);
    let columns = [DVec3::new(cosine, 0.0, -sine), DVec3::Y, DVec3::new(sine, 0.0, cosine)];
    DAffine3::from_cols(columns[0], columns[1], columns[2], DVec3::ZERO)
}

/// How many triangles the patches become together.
pub fn triangle_count(patches: &[Patch]) -> u64 {
    patches.iter().map(Patch::triangle_count).sum()
}

/// The patches as one mesh, each with a rectangle of its atlas. Without `with_tangents` all tangents are zero (`Mesh::tangents`).
pub fn mesh(name: &str, material: usize, patches: &[Patch], with_tangents: bool) -> Mesh {
    let mut mesh = Mesh { name: name.to_owned(), material, ..Mesh::default() };
    let mut sizes_m = Vec::new();
    for patch in patches {
        let first = mesh.positions.len();
        patch.write(&mut mesh);
        sizes_m.push(patch.size_m(&mesh.positions[first..]));
    }
    mesh.atlas.reserve_exact(mesh.positions.len());
    for (patch, chart) in patches.iter().zip(charts::packed(&sizes_m)) {
        patch.write_atlas(&chart, &mut mesh.atlas);
    }
    if !with_tangents {
        mesh.tangents.fill(Vec4::ZERO);
    }
    mesh
}

/// Sine and cosine of an angle in turns (1 is a full circle), exact at every quarter.
pub fn sin_cos_turns(turns: f64) -> (f64, f64) {
    let quarters = (turns - turns.floor()) * 4.0;
    let quadrant = quarters.floor();
    // Taylor's series from an angle of at most an eighth of a turn: the next term would be below 1e-15.
    let small = |angle: f64| {
        let square = angle * angle;
        let mut sine = 0.0;
        let mut cosine = 0.0;
        for order in (0..8).rev() {
            let even = f64::from(2 * order);
            cosine = 1.0 - square / ((even + 1.0) * (even + 2.0)) * cosine;
            sine = 1.0 - square / ((even + 2.0) * (even + 3.0)) * sine;
        }
        (sine * angle, cosine)
    };
    let rest = quarters - quadrant;
    let (sine, cosine) = if rest <= 0.5 {
        small(rest * std::f64::consts::FRAC_PI_2)
    } else {
        let (sine, cosine) = small((1.0 - rest) * std::f64::consts::FRAC_PI_2);
        (cosine, sine)
    };
    match quadrant as u32 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_are_exact_at_quarters_and_close_elsewhere() {
        for (turns, expected) in [(0.0, (0.0, 1.0)), (0.25, (1.0, 0.0)), (0.5, (0.0, -1.0)), (-0.25, (-1.0, 0.0))] {
            let (sine, cosine) = sin_cos_turns(turns);
            assert_eq!((sine + 0.0, cosine + 0.0), expected, "{turns} turns");
        }
        for step in -50..50 {
            let turns = f64::from(step) * 0.0317;
            let (sine, cosine) = sin_cos_turns(turns);
            let angle = turns * std::f64::consts::TAU;
            // 1e-12: the series ends below 1e-15, the angle itself is rounded.
            assert!((sine - angle.sin()).abs() < 1e-12 && (cosine - angle.cos()).abs() < 1e-12, "{turns} turns");
        }
    }

    #[test]
    fn a_collapsed_row_costs_one_triangle_a_column() {
        let flat = |s: f64, t: f64| Point { position: DVec3::new(s * (1.0 - t), t, 0.0), uv: DVec2::new(s, -t) };
        let patch = Patch::new(3, 2, flat).collapsed(false, true);
        let mesh = mesh("fan", 0, std::slice::from_ref(&patch), true);
        assert_eq!(patch.triangle_count(), 9);
        assert_eq!(mesh.triangle_count(), 9);
        assert!(mesh.normals.iter().all(|normal| normal.abs_diff_eq(Vec3::Z, 1e-6)));
    }
}
