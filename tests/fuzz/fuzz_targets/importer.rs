//! Any bytes as a .glb or .gltf: refused with exit code 2, or a scene of which everything that the host does with one
//! can be made. The first byte chooses the moment.

#![no_main]

use libfuzzer_sys::{Corpus, fuzz_mutator, fuzz_target, fuzzer_mutate};
use quincunx::{Error, techniques};
use quincunx::bvh::Bvh;
use quincunx::frame::View;
use quincunx::lights::LightSet;
use quincunx::resident::{Geometry, SceneStats};
use quincunx::scene::gltf::{Model, self};
use quincunx::scene::{AnimationChoice, Scene};
use quincunx::settings::Values;
use quincunx::techniques::settings_of;
use quincunx::units::Extent;
use quincunx_fuzz::mutate;
use std::sync::LazyLock;
use tempfile::TempDir;

static FOLDER: LazyLock<TempDir> = LazyLock::new(|| {
    // What URIs find; the other half of the files is not there.
    let folder = quincunx_fuzz::memory_folder();
    std::fs::write(folder.path().join("a.bin"), [0; 256]).unwrap();
    std::fs::write(folder.path().join("a.png"), quincunx_fuzz::png(2, 2)).unwrap();
    folder
});

const TIMES_S: [f64; 4] = [0.0, 0.5, 1e3, 1e30];

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    mutate::file(data, size, max_size, seed, fuzzer_mutate)
});

fn require_request(error: &Error) {
    assert_eq!(error.exit_code(), 2, "{error}");
    assert!(error.message().contains("scene.glb"), "{error}");
}

/// What the renderer's host side asks of a scene before it has a device.
fn use_scene(scene: &Scene) {
    for mesh in &scene.meshes {
        let count = mesh.positions.len();
        assert!(mesh.indices.len() % 3 == 0 && mesh.indices.iter().all(|index| (*index as usize) < count));
        assert!(mesh.normals.len() == count && mesh.tangents.len() == count && mesh.uvs.len() == count);
        assert_eq!(mesh.normal_groups.len(), count);
        assert!([0, count].contains(&mesh.uvs_1.len()) && [0, count].contains(&mesh.colors.len()));
        assert!(mesh.positions.iter().all(|position| position.is_finite()));
        assert!(mesh.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-3));
        assert!(mesh.material < scene.materials.len());
    }
    for image in &scene.images {
        assert_eq!(image.rgba8.len() as u64, 4 * Extent::new(image.width, image.height).pixel_count());
    }
    assert!(scene.textures.iter().all(|texture| texture.image < scene.images.len()));
    assert!(scene.lasting_bounds().is_empty() || scene.lasting_bounds().diagonal().is_finite());
    assert!(SceneStats::of(scene).plan().bytes() > 0);
    if scene.draws.is_empty() {
        return;
    }
    assert_eq!(Geometry::of(scene).calls(scene).len(), scene.draws.len());
    let technique = techniques::find("deferred").unwrap();
    let values = Values::defaults(&settings_of(technique));
    match View::new(scene, "0", Extent::new(16, 9)).and_then(|view| LightSet::new(scene, &view, &values)) {
        Ok(_) => {}
        Err(error) => assert_eq!(error.exit_code(), 2, "{error}"),
    }
    if let Err(error) = Bvh::build(scene) {
        assert_eq!(error.exit_code(), 2, "{error}");
    }
}

fuzz_target!(init: quincunx_fuzz::seeds::write_if_asked("importer"), |bytes: &[u8]| -> Corpus {
    let Some((which, bytes)) = bytes.split_first() else { return Corpus::Reject };
    let path = FOLDER.path().join("scene.glb");
    std::fs::write(&path, bytes).unwrap();
    let model = match Model::open(&path, &AnimationChoice::All) {
        Ok(model) => model,
        Err(error) => {
            require_request(&error);
            return Corpus::Keep;
        }
    };
    match model.into_pose(TIMES_S[usize::from(*which) % TIMES_S.len()]) {
        Ok(scene) => use_scene(&scene),
        Err(error) => require_request(&error),
    }
    if which & 4 != 0 && let Err(error) = gltf::inspect(&path) {
        require_request(&error);
    }
    Corpus::Keep
});
