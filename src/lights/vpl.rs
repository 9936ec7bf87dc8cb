//! Virtual point lights by Instant Radiosity (Segovia 2006, section 6; Keller 1997): a low-discrepancy light walk on the
//! host whose landings become lights.
//!
//! Walks start on punctual lights and, with `--emissive on`, on emissive triangles, chosen by power. A start on an
//! emissive triangle is a virtual light itself where no other light represents the panel (`Walk::starts`); a start on a
//! punctual light is not, because `--direct` has it. A sun starts on a disc over the scene, so that roofs stop it.
//!
//! Walks continue until N lights are found, and all are divided by the number of walks: walks that leave the scene, or
//! end on the back of a single-sided surface, count and leave nothing. Stopping at the N-th light instead of at a fixed
//! number of walks biases the sum by about 1/N.

use crate::bvh::{Bvh, Hit, HitPlace};
use crate::gpu::shader::structs::{MediumBlock, VplBlock};
use crate::lights::emitters::luminous;
use crate::scene::{Light, Scene};
use crate::shading::light::LightStart;
use crate::shading::material::MeshPoint;
use crate::shading::{light, material};
use glam::Vec3;

/// Inputs of the walk.
#[derive(Clone, Copy, Debug)]
pub struct Walk {
    /// How many lights to find (`--vpls`).
    pub count: u32,
    /// Surfaces that a walk lands on at most (`--vpl-bounces`).
    pub bounces: u32,
    /// Whether emissive triangles send walks.
    pub emissive: bool,
    /// Whether a start on one of them is a light itself; without, what the panel gives straight is another's.
    pub starts: bool,
    /// What the walks pass through.
    pub medium: Option<MediumBlock>,
    pub seed: u32,
}

/// What the walk found.
#[derive(Clone, Debug)]
pub struct VplWalk {
    /// In the order of the walks: any stretch of them is as well spread as the whole.
    pub vpls: Vec<VplBlock>,
    /// How many of them walks have found; the rest are dark.
    pub found_count: u32,
    pub walk_count: u32,
}

/// How far the walks of earlier runs have come: the next ones go on there, so that lights of many runs are those of one long walk.
#[derive(Clone, Debug, Default)]
pub struct Course {
    runs: u32,
    walk_count: u64,
    /// Lights of the last walk that its run had no room for; not yet divided.
    left: Vec<VplBlock>,
}

impl Course {
    /// Walks of all runs so far.
    pub fn walk_count(&self) -> u64 {
        self.walk_count
    }
}

/// Walks tried for each light wanted, before a scene counts as one that no light lands in.
const PATIENCE: u64 = 1024;

/// Where a walk starts.
enum Source<'a> {
    Punctual(&'a Light),
    /// `is_mirrored`: its draw turns the winding around, not the surface.
    Emissive {
        corners: [Vec3; 3],
        mesh: usize,
        triangle: usize,
        is_mirrored: bool,
    },
}

/// Rays start off their surface by this part of the scene's diagonal.
const RAY_OFFSET: f32 = 1e-4;

/// Walks until `walk.count` lights are found. Where nothing shines, or no walk lands, there is no indirect light: the rest
/// of the lights are dark ones, so that a picture is a picture all the same.
pub fn walk(scene: &Scene, bvh: &Bvh, lights: &[Light], walk: &Walk) -> VplWalk {
    walk_on(scene, bvh, lights, walk, &mut Course::default())
}

/// The same for one run of many, from where `course` stands. Lights are divided by the walks that a run took on average so far: what
/// stopping at a run's last light biases falls with the number of runs, and a walk's lights may be two runs'.
pub fn walk_on(scene: &Scene, bvh: &Bvh, lights: &[Light], walk: &Walk, course: &mut Course) -> VplWalk {
    let bounds = scene.bounds();
    let radius = 0.5 * bounds.diagonal();
    let (sources, powers) = sources(scene, lights, walk.emissive, radius);
    let total: f64 = powers.iter().sum();
    let mut vpls = std::mem::take(&mut course.left);
    let patience = if total > 0.0 { PATIENCE * u64::from(walk.count) } else { 0 };
    let cumulative: Vec<f64> = powers
        .iter()
        .scan(0.0, |sum, power| {
            *sum += power / total;
            Some(*sum)
        })
        .collect();
    let offset = RAY_OFFSET * bounds.diagonal();
    let tracer = Tracer { scene, bvh, center: bounds.center(), radius, offset };
    let mut walk_count = 0u64;
    while (vpls.len() as u64) < u64::from(walk.count) && walk_count < patience {
        let mut numbers = Numbers::new(course.walk_count + walk_count, walk.seed);
        walk_count += 1;
        let pick = f64::from(numbers.next());
        let index = cumulative.partition_point(|sum| *sum <= pick).min(sources.len() - 1);
        let chance = powers[index] / total;
        tracer.one(&sources[index], chance as f32, walk, &mut numbers, &mut vpls);
    }
    (course.runs, course.walk_count) = (course.runs + 1, course.walk_count + walk_count);
    let walks_a_run = course.walk_count as f64 / f64::from(course.runs);
    course.left = vpls.split_off(vpls.len().min(walk.count as usize));
    for vpl in &mut vpls {
        vpl.intensity = vpl.intensity.map(|channel| (f64::from(channel) / walks_a_run) as f32);
    }
    let found_count = vpls.len() as u32;
    vpls.resize(walk.count as usize, vpl(bounds.center(), Vec3::Y, Vec3::ZERO));
    VplWalk { vpls, found_count, walk_count: walk_count as u32 }
}

fn sources<'a>(scene: &Scene, lights: &'a [Light], emissive: bool, radius: f32) -> (Vec<Source<'a>>, Vec<f64>) {
    let mut sources = Vec::new();
    let mut powers = Vec::new();
    for punctual in lights {
        powers.push(luminous(light::flux(punctual, radius)));
        sources.push(Source::Punctual(punctual));
    }
    if !emissive {
        return (sources, powers);
    }
    for draw in &scene.draws {
        let mesh = &scene.meshes[draw.mesh];
        let material = &scene.materials[mesh.material];
        if !material.is_emissive() {
            continue;
        }
        for triangle in 0..mesh.triangle_count() {
            let corners = mesh.triangle(triangle).map(|corner| draw.world_from_object.transform_point3(corner));
            let area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).length();
            // By the factor, not by the texture: a choice that is off costs variance, not truth.
            let power = luminous(material.emissive) * f64::from(std::f32::consts::PI * area);
            if power > 0.0 {
                powers.push(power);
                let is_mirrored = draw.world_from_object.determinant() < 0.0;
                sources.push(Source::Emissive { corners, mesh: draw.mesh, triangle, is_mirrored });
            }
        }
    }
    (sources, powers)
}

/// The numbers of one walk, one dimension after the other.
struct Numbers {
    index: u32,
    seed: u32,
    dimension: u32,
}

impl Numbers {
    fn new(walk: u64, seed: u32) -> Self {
        // The sequence has 2^16 points; each further stretch is scrambled on its own.
        let stretch = (walk >> 16) as u32;
        Self { index: (walk & 0xffff) as u32, seed: seed ^ stretch.wrapping_mul(0x9e37_79b9), dimension: 0 }
    }

    fn next(&mut self) -> f32 {
        self.dimension += 1;
        sobol_burley::sample(self.index, self.dimension - 1, self.seed)
    }

    fn pair(&mut self) -> [f32; 2] {
        [self.next(), self.next()]
    }
}

struct Tracer<'a> {
    scene: &'a Scene,
    bvh: &'a Bvh,
    /// The sphere around the scene.
    center: Vec3,
    radius: f32,
    offset: f32,
}

/// A surface point that a walk landed on.
struct Landing {
    /// From where the ray began, in metres.
    distance: f32,
    position: Vec3,
    normal: Vec3,
    albedo: Vec3,
}

impl Tracer<'_> {
    fn one(&self, source: &Source<'_>, chance: f32, walk: &Walk, numbers: &mut Numbers, vpls: &mut Vec<VplBlock>) {
        let LightStart { mut origin, mut direction, mut flux } = match source {
            Source::Punctual(punctual) => {
                let start = LightStart::of(punctual, numbers.pair(), self.center, self.radius);
                // Points have no numbers for a place on them.
                if punctual.radius > 0.0 { start.on_sphere(punctual, numbers.pair()) } else { start }
            }
            Source::Emissive { corners, mesh, triangle, is_mirrored } => {
                let mesh = &self.scene.meshes[*mesh];
                let material = &self.scene.materials[mesh.material];
                let (u, v) = (numbers.next(), numbers.next());
                let root = u.sqrt();
                let weights = [1.0 - root, root * (1.0 - v), root * v];
                let position = corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2];
                let point = MeshPoint::on(mesh, mesh.corners(*triangle), weights);
                let twice = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
                let mut normal = if *is_mirrored { -twice } else { twice }.normalize_or_zero();
                let mut area = 0.5 * twice.length();
                if material.double_sided {
                    // Both sides shine: each walk takes one of them, and stands for both.
                    area *= 2.0;
                    normal = if numbers.next() < 0.5 { normal } else { -normal };
                }
                let radiance = material::emissive_at(self.scene, material, &point);
                if walk.starts {
                    vpls.push(vpl(position, normal, radiance * area / chance));
                }
                LightStart {
                    origin: position + normal * self.offset,
                    direction: cosine_direction(normal, numbers),
                    flux: radiance * area * std::f32::consts::PI,
                }
            }
        };
        flux /= chance;
        for _ in 0..walk.bounces {
            let Some(landing) = self.land(origin, direction) else { return };
            let passed = walk.medium.map_or(1.0, |medium| medium.passed(origin, direction, landing.distance));
            flux *= landing.albedo * passed;
            // A black or metallic surface sends nothing on: no light is spent on it.
            if flux == Vec3::ZERO {
                return;
            }
            vpls.push(vpl(landing.position, landing.normal, flux / std::f32::consts::PI));
            origin = landing.position + landing.normal * self.offset;
            direction = cosine_direction(landing.normal, numbers);
        }
    }

    /// The first surface that stops a ray; None where there is none, or where the ray meets a single-sided one's back.
    fn land(&self, origin: Vec3, direction: Vec3) -> Option<Landing> {
        let hit = self.bvh.closest_hit(origin, direction, 4.0 * self.radius, |hit| !self.is_hole(hit))?;
        let place @ HitPlace { mesh, draw, material, vertices, .. } = self.bvh.place(self.scene, &hit);
        let positions = vertices.map(|vertex| draw.world_from_object.transform_point3(mesh.positions[vertex]));
        let mut normal = (positions[1] - positions[0]).cross(positions[2] - positions[0]).normalize_or_zero();
        // A mirrored draw turns the winding around, not the surface.
        if draw.world_from_object.determinant() < 0.0 {
            normal = -normal;
        }
        if normal.dot(direction) > 0.0 {
            if !material.double_sided {
                return None;
            }
            normal = -normal;
        }
        let albedo = material::albedo_at(self.scene, material, &point(&place));
        Some(Landing { distance: hit.distance, position: origin + direction * hit.distance, normal, albedo })
    }

    fn is_hole(&self, hit: &Hit) -> bool {
        let place = self.bvh.place(self.scene, hit);
        material::is_hole(self.scene, place.material, &point(&place))
    }
}

fn point(place: &HitPlace<'_>) -> MeshPoint {
    MeshPoint::on(place.mesh, place.vertices, place.weights)
}

fn cosine_direction(normal: Vec3, numbers: &mut Numbers) -> Vec3 {
    let (u, v) = (numbers.next(), numbers.next());
    let (r, angle) = (u.sqrt(), std::f32::consts::TAU * v);
    if normal == Vec3::ZERO {
        return Vec3::Y;
    }
    let (x, y) = normal.any_orthonormal_pair();
    (x * (r * angle.cos()) + y * (r * angle.sin()) + normal * (1.0 - u).max(0.0).sqrt()).normalize()
}

fn vpl(position: Vec3, normal: Vec3, intensity: Vec3) -> VplBlock {
    VplBlock {
        position_ws: position.extend(0.0).to_array(),
        normal_ws: normal.extend(0.0).to_array(),
        intensity: intensity.extend(0.0).to_array(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Draw, LightKind, Material, Mesh};
    use glam::{Mat4, Vec4};

    /// A large horizontal square at y = `y`, facing up, and its material.
    fn square(y: f32, half: f32, material: usize) -> Mesh {
        Mesh {
            positions: [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)]
                .map(|(x, z)| Vec3::new(x * half, y, z * half))
                .to_vec(),
            normals: vec![Vec3::Y; 4],
            indices: vec![0, 1, 2, 0, 2, 3],
            material,
            ..Mesh::default()
        }
    }

    fn floor(albedo: f32) -> Scene {
        Scene {
            meshes: vec![square(0.0, 50.0, 0)],
            draws: vec![Draw { mesh: 0, world_from_object: Mat4::IDENTITY }],
            materials: vec![Material::diffuse("floor", Vec3::splat(albedo))],
            ..Scene::default()
        }
    }

    fn point(height: f32) -> Light {
        Light {
            name: String::new(),
            kind: LightKind::Point,
            intensity: Vec3::new(2.0, 1.0, 0.5),
            position: Vec3::new(0.0, height, 0.0),
            direction: -Vec3::Y,
            range: None,
            radius: 0.0,
        }
    }

    fn total(found: &VplWalk) -> Vec3 {
        found.vpls.iter().map(|vpl| Vec4::from_array(vpl.intensity).truncate()).sum()
    }

    /// A sun's walks fall straight through the two metres of the medium's box, and the floor sends on what is left.
    #[test]
    fn a_medium_takes_its_part_of_a_walk() {
        let scene = floor(0.5);
        let bvh = Bvh::build(&scene).unwrap();
        let sun = Light { kind: LightKind::Directional, ..point(1.0) };
        let medium = MediumBlock {
            min_ws: [-50.0, 0.0, -50.0, 0.0],
            max_ws: [50.0, 2.0, 50.0, 0.0],
            extinction: 0.25,
            ..bytemuck::Zeroable::zeroed()
        };
        let light = |medium| {
            total(&walk(
                &scene,
                &bvh,
                std::slice::from_ref(&sun),
                &Walk { count: 64, bounces: 1, emissive: false, starts: true, medium, seed: 1 },
            ))
        };
        let ratio = light(Some(medium)) / light(None);
        assert!((ratio - (-0.5f32).exp()).abs().max_element() < 1e-4, "{ratio}");
    }

    #[test]
    fn the_flux_that_lands_is_the_flux_that_leaves() {
        let scene = floor(0.5);
        let bvh = Bvh::build(&scene).unwrap();
        let found = walk(
            &scene,
            &bvh,
            &[point(1.0)],
            &Walk { count: 4096, bounces: 1, emissive: false, starts: true, medium: None, seed: 3 },
        );
        assert_eq!(found.vpls.len(), 4096);
        // Half of 4 pi I goes down and nearly all of that lands on a floor of 50 m; half of it is kept; a Lambert patch
        // that sends the flux F has the intensity F / pi along its normal.
        let landing = Vec3::new(2.0, 1.0, 0.5) * (2.0 * std::f32::consts::PI) * 0.98;
        let expected = landing * 0.5 / std::f32::consts::PI;
        assert!((total(&found) / expected - 1.0).abs().max_element() < 0.02, "{} {expected}", total(&found));
        assert!(found.vpls.iter().all(|vpl| vpl.normal_ws[1] > 0.99 && vpl.position_ws[1].abs() < 1e-3));
    }

    /// Runs of few lights are one long walk: the same lights in the same order, and on average the same flux, of which stopping each run by
    /// itself would make some percent too much.
    #[test]
    fn runs_go_on_where_the_one_before_has_ended() {
        let mut scene = floor(0.5);
        scene.meshes.push(square(3.0, 1.0, 0));
        scene.draws.push(Draw { mesh: 1, world_from_object: Mat4::IDENTITY });
        let bvh = Bvh::build(&scene).unwrap();
        for bounces in [1, 3] {
            let of = |count| Walk { count, bounces, emissive: false, starts: true, medium: None, seed: 3 };
            let light = [point(1.0)];
            let whole = walk(&scene, &bvh, &light, &of(8 * 512));
            let mut course = Course::default();
            let runs: Vec<VplWalk> = (0..512).map(|_| walk_on(&scene, &bvh, &light, &of(8), &mut course)).collect();
            let place = |vpl: &VplBlock| [vpl.position_ws, vpl.normal_ws];
            let [one, many]: [Vec<_>; 2] =
                [whole.vpls.iter().map(place).collect(), runs.iter().flat_map(|run| &run.vpls).map(place).collect()];
            assert_eq!(one, many, "{bounces} bounces");
            let mean = runs.iter().map(total).sum::<Vec3>() / 512.0;
            let ratio = mean / total(&whole);
            assert!((ratio - 1.0).abs().max_element() < 0.005, "{bounces} bounces: {ratio}");
        }
    }

    #[test]
    fn an_emissive_panel_stands_for_itself() {
        let mut scene = floor(0.0);
        scene.materials.push(Material { emissive: Vec3::splat(3.0), ..Material::diffuse("panel", Vec3::ZERO) });
        scene.meshes.push(square(2.0, 1.0, 1));
        scene.draws.push(Draw { mesh: 1, world_from_object: Mat4::IDENTITY });
        let bvh = Bvh::build(&scene).unwrap();
        let found = walk(
            &scene,
            &bvh,
            &[],
            &Walk { count: 512, bounces: 1, emissive: true, starts: true, medium: None, seed: 1 },
        );
        // Radiance 3 times an area of 4; the panel faces up and the floor is black, so nothing else is lit.
        assert!((total(&found) - 12.0).abs().max_element() < 1e-3, "{}", total(&found));
    }

    /// The winding of a mirrored draw is turned around, and its front is where it was.
    #[test]
    fn a_mirrored_panel_shines_the_way_its_front_faces() {
        let mut scene = floor(0.5);
        scene.materials.push(Material { emissive: Vec3::splat(3.0), ..Material::diffuse("panel", Vec3::ZERO) });
        scene.meshes.push(square(2.0, 1.0, 1));
        scene.draws.push(Draw { mesh: 1, world_from_object: Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0)) });
        let bvh = Bvh::build(&scene).unwrap();
        let walk = Walk { count: 64, bounces: 1, emissive: true, starts: true, medium: None, seed: 1 };
        let found = super::walk(&scene, &bvh, &[], &walk);
        // It faces up: its lights are its own starts, and none is on the floor.
        assert_eq!(found.found_count, 64);
        assert!(found.vpls.iter().all(|vpl| vpl.normal_ws[1] > 0.99 && (vpl.position_ws[1] - 2.0).abs() < 1e-5));
    }

    #[test]
    fn a_roof_stops_the_sun_and_its_back_holds_no_light() {
        let mut scene = floor(0.5);
        scene.meshes.push(square(0.0, 50.0, 0));
        // A roof that faces down into the room: the sun meets its back.
        let down = Mat4::from_translation(Vec3::new(0.0, 3.0, 0.0)) * Mat4::from_rotation_x(std::f32::consts::PI);
        scene.draws.push(Draw { mesh: 1, world_from_object: down });
        let sun = Light { kind: LightKind::Directional, ..point(0.0) };
        let bvh = Bvh::build(&scene).unwrap();
        let found = walk(
            &scene,
            &bvh,
            &[sun],
            &Walk { count: 4, bounces: 1, emissive: false, starts: true, medium: None, seed: 1 },
        );
        assert_eq!((found.vpls.len(), found.found_count, total(&found)), (4, 0, Vec3::ZERO));
    }

    #[test]
    fn where_nothing_shines_all_lights_are_dark() {
        let scene = floor(0.5);
        let bvh = Bvh::build(&scene).unwrap();
        let found = walk(
            &scene,
            &bvh,
            &[],
            &Walk { count: 4, bounces: 1, emissive: true, starts: true, medium: None, seed: 1 },
        );
        assert_eq!((found.vpls.len(), found.found_count, found.walk_count), (4, 0, 0));
    }
}
