//! Stencil shadow volumes of inferred lighting (Kircher 2009, section 4): where shadow rays find shadow, they must too, on
//! solid surfaces and on layers of glass, wherever eye and light stand.

use crate::support;
use crate::support::boxes::{camera, point_light, rectangle};
use crate::support::choices::words_but;
use crate::support::program::Program;
use crate::support::watched::{Changes, Watched, both};
use glam::{Mat4, Quat, Vec3, vec3};
use quincunx::gpu::commands::Submits;
use quincunx::scene::{self, AlphaMode, Camera, Draw, Light, LightKind, Material, Mesh, Projection, Scene};
use quincunx::session::Renderer;

const NAME: &str = "inferred_lighting";
const IRRADIANCE: &str = "light.l_buffer.irradiance";
const SIZE: [u32; 2] = [160, 120];
/// The light buffer is as large as the frame.
const COMMON: Changes<'_> =
    &[("size", "160x120"), ("light-size", "160x120"), ("light-cutoff", "0"), ("volumes", "scissor")];
const TRACED: Changes<'_> = &[("direct-shadow", "ray")];
const COUNTED: Changes<'_> = &[("direct-shadow", "none"), ("shadow-volumes", "9")];

/// Draws of `table`, which are the objects' ids too: its glass, and what casts first.
const SHEETS: std::ops::Range<u32> = 1..4;
const BLOCK: usize = 4;

/// Three sheets of glass over a floor; above them a block that is turned, a ring that a mirroring transform brings there,
/// and a ball.
fn table(lights: Vec<Light>, camera: Camera) -> Scene {
    let mut scene = Scene { name: "table".to_owned(), lights, cameras: vec![camera], ..Scene::default() };
    let gray = Material::diffuse("gray", Vec3::splat(0.5));
    rectangle(&mut scene, Vec3::ZERO, 6.0 * Vec3::X, -6.0 * Vec3::Z, gray);
    for sheet in SHEETS {
        let glass = Material {
            base_color: vec3(0.6, 0.7, 0.9).extend(0.4),
            alpha: AlphaMode::Blend,
            double_sided: true,
            ..Material::diffuse("glass", Vec3::ONE)
        };
        let at = vec3(0.2 * sheet as f32, 0.4 * sheet as f32, 0.0);
        rectangle(&mut scene, at, 1.6 * Vec3::X, -1.2 * Vec3::Z, glass);
    }
    let turned = Quat::from_euler(glam::EulerRot::YXZ, 0.5, 0.4, -0.3);
    let mirror = Mat4::from_scale(vec3(-1.3, 1.0, 1.0));
    for (shape, world_from_object) in [
        ("block", Mat4::from_scale_rotation_translation(Vec3::splat(0.5), turned, vec3(0.2, 1.9, 0.1))),
        ("ring", Mat4::from_translation(vec3(1.3, 1.6, 0.3)) * mirror),
        ("ball", Mat4::from_translation(vec3(-1.1, 0.6, 0.9)) * Mat4::from_scale(Vec3::splat(0.6))),
    ] {
        let mesh = Mesh { material: 0, ..shaped(shape) };
        scene.meshes.push(mesh);
        scene.draws.push(Draw { mesh: scene.meshes.len() - 1, world_from_object });
    }
    scene
}

/// A closed mesh of the scene lamps.
fn shaped(shape: &str) -> Mesh {
    let lamps = scene::load("lamps", 1).unwrap();
    lamps.meshes.into_iter().find(|mesh| mesh.name.starts_with(shape)).expect("the scene has one")
}

fn sun(direction: Vec3) -> Light {
    Light { kind: LightKind::Directional, direction: direction.normalize(), ..point_light(Vec3::ZERO, 2.0) }
}

fn above() -> Light {
    point_light(vec3(0.5, 4.5, 0.4), 40.0)
}

fn view() -> Camera {
    camera(vec3(2.6, 3.4, 4.6), vec3(0.2, 0.7, 0.0), 0.9)
}

fn irradiance(watched: &Watched, changes: Changes<'_>) -> Vec<[f32; 3]> {
    let renderer = watched.render_stages(NAME, &both(COMMON, changes), &[IRRADIANCE]);
    watched.rgb(&renderer, IRRADIANCE)
}

/// The object of each texel.
fn objects(watched: &Watched) -> Vec<u32> {
    let renderer = watched.render_stages(NAME, COMMON, &["geometry.dsf.id"]);
    watched.integers(&renderer, "geometry.dsf.id").iter().map(|id| id >> 8).collect()
}

/// What two ways of casting shadows agree on.
struct Agreement {
    /// Texels of the object whose light is another with shadows, by the rays.
    shadowed: usize,
    /// Texels of the object that volumes light otherwise than rays do.
    other: usize,
    /// Those of them that are not at the edge of a shadow that rays see.
    astray: usize,
}

/// Agreement over the objects that `is_meant` names. At an edge: a texel of the same object, at most as far as the next
/// cell of the stipple, is shadowed by another set of lights.
fn agreement(
    watched: &Watched,
    counted: Changes<'_>,
    traced: Changes<'_>,
    is_meant: impl Fn(u32) -> bool,
) -> Agreement {
    let ids = objects(watched);
    let lit = irradiance(watched, &[("direct-shadow", "none")]);
    let by_rays = irradiance(watched, traced);
    let by_volumes = irradiance(watched, counted);
    let [width, height] = SIZE.map(|side| side as i32);
    let part = |index: usize| -> f32 {
        let sum = |light: &[f32; 3]| light.iter().sum::<f32>();
        sum(&by_rays[index]) / sum(&lit[index]).max(1e-6)
    };
    let is_edge = |index: usize| {
        let (x, y) = (index as i32 % width, index as i32 / width);
        let around = (-2..=2).flat_map(|dy| (-2..=2).map(move |dx| (x + dx, y + dy)));
        let mut inside = around.filter(|(x, y)| (0..width).contains(x) && (0..height).contains(y));
        inside.any(|(x, y)| {
            let near = (y * width + x) as usize;
            ids[near] == ids[index] && (part(near) - part(index)).abs() > 0.02
        })
    };
    let meant = |index: &usize| is_meant(ids[*index]);
    let all = || (0..ids.len()).filter(meant);
    let others: Vec<usize> = all().filter(|index| by_volumes[*index] != by_rays[*index]).collect();
    Agreement {
        shadowed: all().filter(|index| by_rays[*index] != lit[*index]).count(),
        other: others.len(),
        astray: others.iter().filter(|index| !is_edge(**index)).count(),
    }
}

/// Texels that are no more at any edge of the rays' shadows: of slivers that are narrower than a texel one of both may see
/// nothing, and where several lights shine an edge may be too faint to count.
const MOST_ASTRAY: usize = 2;

/// Rays start a little off their surface and run in parallel to where they should; the edges of a volume are rounded to parts
/// of a texel. So texels at shadow edges may differ, in both ways, and no others.
fn require_agreement(watched: &Watched, what: &str, counted: Changes<'_>, traced: Changes<'_>) {
    for (surfaces, is_meant) in
        [("solid", &(|id| !SHEETS.contains(&id)) as &dyn Fn(u32) -> bool), ("glass", &|id| SHEETS.contains(&id))]
    {
        let Agreement { shadowed, other, astray } = agreement(watched, counted, traced, is_meant);
        println!("{what}, {surfaces}: {shadowed} texels in shadow, {other} otherwise, {astray} of them at no edge");
        assert!(shadowed > 150, "{what}, {surfaces}: {shadowed} texels are in shadow");
        assert!(astray <= MOST_ASTRAY, "{what}, {surfaces}: {astray} texels that are at no edge");
        assert!(other * 25 < shadowed, "{what}, {surfaces}: {other} texels of {shadowed} in shadow");
    }
}

#[test]
fn shadows_fall_on_solid_surfaces_and_on_layers_of_glass_as_rays_cast_them() {
    let spot = Light {
        kind: LightKind::Spot { inner_angle: 0.5, outer_angle: 0.9 },
        direction: vec3(0.5, -1.0, -0.3).normalize(),
        ..point_light(vec3(-1.5, 4.0, 1.0), 60.0)
    };
    for (what, lights) in [
        ("a point", vec![above()]),
        ("a spot", vec![spot.clone()]),
        ("the sun", vec![sun(vec3(0.3, -1.0, -0.2))]),
        ("all three", vec![above(), spot, sun(vec3(0.3, -1.0, -0.2))]),
    ] {
        let watched = Watched::with_scene(table(lights, view()));
        require_agreement(&watched, what, COUNTED, TRACED);
    }
}

/// A closed scan of 202,520 triangles, most smaller than a texel: what faces the light is not shadowed by itself.
#[test]
fn a_fine_surface_casts_on_itself_as_rays_do() {
    // What keeps a lit surface before its own volume is as much as a 256th of a pixel asks for.
    if !support::has(&support::driver(), support::Feature::ExactPositions) {
        return;
    }
    let Some(folder) = support::shared_scenes() else { return };
    let watched = Watched::open(folder.join("meshes/dragon.glb").to_str().unwrap());
    let lit = irradiance(&watched, &[("direct-shadow", "none")]);
    let [by_volumes, by_rays] = [COUNTED, TRACED].map(|changes| irradiance(&watched, changes));
    let differing = |a: &[[f32; 3]], b: &[[f32; 3]]| a.iter().zip(b).filter(|(a, b)| a != b).count();
    let (shadowed, other) = (differing(&by_rays, &lit), differing(&by_volumes, &by_rays));
    println!("{shadowed} texels in shadow, {other} otherwise");
    assert!(shadowed > 300 && other * 10 < shadowed, "{other} texels of {shadowed} in shadow");
}

/// The eye in the shadow of the block, its near plane cut by the volume's sides, and a far plane that cuts volumes off. A
/// count of the faces before a surface would be wrong in all of these.
#[test]
fn the_eye_may_be_inside_of_a_shadow() {
    for (what, eye, target) in [
        ("under the block", vec3(0.1, 0.9, 0.05), vec3(1.2, 0.0, -0.6)),
        ("at the edge of its shadow", vec3(-0.22, 0.9, 0.05), vec3(0.4, 0.0, -0.9)),
        ("under the ring", vec3(1.75, 0.7, 0.3), vec3(0.0, 0.3, 0.2)),
    ] {
        for z_far in [None, Some(5.0)] {
            let mut camera = camera(eye, target, 1.3);
            let Projection::Perspective { z_far: end, .. } = &mut camera.projection else { panic!("{what}: an eye") };
            *end = z_far;
            let watched = Watched::with_scene(table(vec![above()], camera));
            let Agreement { shadowed, other, astray } = agreement(&watched, COUNTED, TRACED, |_| true);
            println!("{what}, far plane {z_far:?}: {shadowed} in shadow, {other} otherwise, {astray} at no edge");
            assert!(
                shadowed > 1000 && astray <= MOST_ASTRAY && other * 25 < shadowed,
                "{what}: {shadowed}, {other}, {astray}"
            );
        }
    }
}

#[test]
fn parallel_projection_sees_the_same_shadows() {
    // What keeps a lit surface before its own volume is as much as a 256th of a pixel asks for.
    if !support::has(&support::driver(), support::Feature::ExactPositions) {
        return;
    }
    let mut camera = view();
    camera.projection = Projection::Orthographic { x_mag: 2.8, y_mag: 2.1, z_near: 0.1, z_far: 20.0 };
    for (what, light) in [("a point", above()), ("the sun", sun(vec3(0.3, -1.0, -0.2)))] {
        let watched = Watched::with_scene(table(vec![light], camera.clone()));
        require_agreement(&watched, what, COUNTED, TRACED);
    }
    // Along the eye's own way: the end of the volumes is where the eye looks.
    let forward = -camera.world_from_view.z_axis.truncate();
    let behind = point_light(camera.world_from_view.w_axis.truncate() - forward + vec3(0.4, 0.3, 0.0), 40.0);
    for light in [sun(forward), behind] {
        let watched = Watched::with_scene(table(vec![light], camera.clone()));
        let Agreement { other, astray, .. } = agreement(&watched, COUNTED, TRACED, |_| true);
        println!("along the eye: {other} otherwise, {astray} at no edge");
        assert!(astray <= MOST_ASTRAY && other < 100, "{other}, {astray}");
    }
}

/// Nothing outside is lit by a lamp that is shut up in a block.
#[test]
fn a_light_inside_of_a_closed_surface_lights_nothing_outside() {
    let scene = table(vec![], view());
    let block = &scene.draws[BLOCK];
    let mesh = &scene.meshes[block.mesh];
    let middle = mesh.positions.iter().sum::<Vec3>() / mesh.positions.len() as f32;
    let inside = point_light(block.world_from_object.transform_point3(middle), 40.0);
    let watched = Watched::with_scene(Scene { lights: vec![inside], ..scene });
    let lit = irradiance(&watched, &[("direct-shadow", "none")]);
    assert!(lit.iter().filter(|texel| texel[0] > 0.0).count() > 5000);
    for changes in [COUNTED, TRACED] {
        let dark = irradiance(&watched, changes);
        assert!(dark.iter().all(|texel| *texel == [0.0; 3]), "{changes:?}");
    }
}

/// The lights that cast by volumes are the strongest; the others cast by rays or not at all, as --direct-shadow says.
#[test]
fn lights_beside_those_with_volumes_keep_their_own_shadows() {
    let weak = point_light(vec3(-2.0, 3.0, 1.0), 8.0);
    let watched = Watched::with_scene(table(vec![weak.clone(), above()], view()));
    let one = ("shadow-volumes", "1");
    require_agreement(&watched, "volumes and rays", &[one, ("direct-shadow", "ray")], TRACED);
    // The weak one alone, without shadows, is what is left where the strong one is in shadow.
    let alone = Watched::with_scene(table(vec![weak], view()));
    let weak_light = irradiance(&alone, &[("direct-shadow", "none")]);
    let mixed = irradiance(&watched, &[one, ("direct-shadow", "none")]);
    let strong = irradiance(&Watched::with_scene(table(vec![above()], view())), COUNTED);
    let unlit: Vec<usize> = (0..strong.len()).filter(|index| strong[*index] == [0.0; 3]).collect();
    assert!(unlit.len() > 1000 && unlit.iter().all(|index| mixed[*index] == weak_light[*index]));
}

#[test]
fn every_method_of_the_lights_leaves_the_same_shadows() {
    let near = Light { range: Some(3.0), ..point_light(vec3(-0.4, 2.6, 0.8), 30.0) };
    let watched = Watched::with_scene(table(vec![above(), near, sun(vec3(0.3, -1.0, -0.2))], view()));
    for casting in ["1", "2", "3"] {
        let of = |method: &str| irradiance(&watched, &[("shadow-volumes", casting), ("volumes", method)]);
        let first = of("scissor");
        // Volumes of shadow are drawn after those of light, and `tiled` draws none.
        for volumes in words_but(NAME, "volumes", &["tiled", "scissor"]).into_iter().chain(["auto"]) {
            assert!(of(volumes) == first, "{casting} lights, {volumes}: another L-buffer");
        }
    }
}

fn counter(renderer: &Renderer, name: &str) -> f64 {
    renderer.measured_counters().unwrap()[name]
}

/// The block alone casts, in one scene whole, in the other without its last triangle.
#[test]
fn a_mesh_that_is_not_closed_is_counted_and_casts_nothing() {
    let mut whole = table(vec![above()], view());
    whole.draws.truncate(BLOCK + 1);
    let mut open = whole.clone();
    let indices = &mut open.meshes[BLOCK].indices;
    indices.truncate(indices.len() - 3);
    for (scene, volume_count, open_count) in [(whole, 1.0, 1.0), (open, 0.0, 2.0)] {
        let watched = Watched::with_scene(scene);
        let renderer = watched.render(NAME, &both(COMMON, COUNTED));
        assert_eq!(counter(&renderer, "shadow_volumes"), volume_count);
        // The floor is a sheet.
        assert_eq!(counter(&renderer, "shadow_casters_not_closed"), open_count);
        assert_eq!(counter(&renderer, "shadow_volume_triangles") > 0.0, volume_count > 0.0);
        let (with, without) = (irradiance(&watched, COUNTED), irradiance(&watched, &[("direct-shadow", "none")]));
        assert_eq!(with != without, volume_count > 0.0);
    }
}

#[test]
fn who_casts_nothing_is_said() {
    let program = Program::new();
    let common = ["render", "cornell", "--technique", NAME, "--size", "16x16", "--volumes", "scissor"];
    let said = |more: &[&str]| program.run(&[&common[..], more].concat()).fine().out;
    let note = "note: draws without shadow volumes, because their meshes are not closed: ";
    assert!(said(&["--shadow-volumes", "1"]).contains(note));
    assert!(!said(&[]).contains(note));
}

#[test]
fn what_volumes_take_in_memory_is_planned_and_in_the_ledger() {
    let watched = Watched::with_scene(table(vec![above(), sun(vec3(0.3, -1.0, -0.2))], view()));
    let renderer = watched.render(NAME, &both(&both(COMMON, COUNTED), &[("alias", "off")]));
    let snapshot = watched.session.gpu.memory.snapshot();
    let scene_bytes = watched.session.stats.plan().bytes();
    assert_eq!(scene_bytes + renderer.plan.bytes(), snapshot.asked_bytes());
    let entry = |name: &str| {
        let full = format!("{NAME}.light.shadow_volumes.{name}");
        snapshot.resources.iter().find(|entry| entry.name == full).unwrap_or_else(|| panic!("no {full}")).bytes as f64
    };
    assert_eq!(entry("triangles"), 12.0 * counter(&renderer, "shadow_volume_triangles"));
    assert!(entry("positions") > 0.0);
    assert_eq!(counter(&renderer, "shadow_volumes"), 6.0);
    let passes: Vec<&str> = renderer.host_passes.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(passes, ["inferred_lighting.light.shadow_volumes"]);
    let plain = watched.render(NAME, COMMON);
    assert!(plain.plan.resources.iter().all(|planned| planned.group != "shadow-volumes"));
}

/// A light that is blended in halves, no light at all, and a method that has no stencil.
#[test]
fn halves_and_darkness_have_volumes_too() {
    let watched = Watched::with_scene(table(vec![above()], view()));
    let halves = both(COUNTED, &[("l-buffer", "half")]);
    let is_dark = |changes: Changes<'_>| -> Vec<bool> {
        irradiance(&watched, changes).iter().map(|texel| *texel == [0.0; 3]).collect()
    };
    assert!(is_dark(&halves) == is_dark(COUNTED));
    let dark = Watched::with_scene(table(vec![], view()));
    let renderer = dark.render_stages(NAME, &both(&both(COMMON, COUNTED), &[("rig", "none")]), &[IRRADIANCE]);
    assert!(dark.rgb(&renderer, IRRADIANCE).iter().all(|texel| *texel == [0.0; 3]));
    let tiled = [("shadow-volumes", "1"), ("volumes", "tiled")];
    let error = watched.try_renderer(NAME, &tiled, &[], Submits::One).err().unwrap();
    assert_eq!(error.exit_code(), 2);
    assert!(error.message().contains("--shadow-volumes 1 with --volumes tiled"), "{error}");
}
