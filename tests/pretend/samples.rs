//! `--members sample-locations` on a device that is told where samples lie and has them at its standard places all the same: which member each
//! of them is, whose pixels it is masked in, and that all come to their sums.

use crate::support::gltf_file::GltfFile;
use crate::support::pretending::Layer;
use crate::support::program::Program;
use crate::support::square::FOUR_PLACES;
use quincunx::picture::image_file;
use quincunx::techniques::patterns;
use serde_json::json;
use std::path::Path;

/// Square as what is drawn, and no whole number of bases.
const SIZE: [u32; 2] = [11, 11];

/// What is sent at a place of the picture, parts of it.
fn grey_at(place: [f32; 2]) -> f32 {
    0.2 + 0.5 * place[0] + 0.25 * place[1]
}

/// A square that fills the picture and sends that.
fn ramp() -> Vec<u8> {
    let mut file = GltfFile::empty();
    let corners = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.0, 0.0], [1.0, 1.0], [1.0, 0.0]];
    let places: Vec<f32> = corners.iter().flat_map(|[x, y]| [2.0 * x - 1.0, 1.0 - 2.0 * y, 0.0]).collect();
    let colors: Vec<f32> = corners.iter().flat_map(|corner| [grey_at(*corner); 3]).collect();
    let (positions, colors) = (file.floats("VEC3", &places), file.floats("VEC3", &colors));
    file.push("materials", json!({"extensions": {"KHR_materials_unlit": {}}}));
    let attributes = json!({"POSITION": positions, "COLOR_0": colors});
    file.push("meshes", json!({"primitives": [{"attributes": attributes, "material": 0}]}));
    file.root(json!({"mesh": 0}));
    let flat = json!({"xmag": 1.0, "ymag": 1.0, "znear": 0.1, "zfar": 9.0});
    file.push("cameras", json!({"type": "orthographic", "orthographic": flat}));
    file.root(json!({"camera": 0, "translation": [0.0, 0.0, 2.0]}));
    file.json["extensionsUsed"] = json!(["KHR_materials_unlit"]);
    file.glb()
}

#[test]
fn samples_of_the_device_are_members_in_their_pixels() {
    let Some(layer) = Layer::built() else { return };
    let program = Program::new();
    std::fs::write(program.path("ramp.glb"), ramp()).unwrap();
    let size = format!("{}x{}", SIZE[0], SIZE[1]);
    // One run, four of them, and one whose last has a sample to spare.
    for (basis, samples) in [("1x1", "4"), ("2x2", "1"), ("2x2", "4"), ("3x2", "2.5"), ("3x1", "0.67")] {
        let pattern =
            patterns::open(&format!("basis:basis={basis},samples={samples},places=sixteenths")).unwrap().pattern;
        for prepass in ["on", "off"] {
            let words = ["render", "ramp.glb", "--technique", "interleaved_sampling", "--members", "sample-locations"];
            let more = ["--basis", basis, "--samples", samples, "--depth-prepass", prepass, "--size", &size];
            let output = ["-o", "a.exr", "--quiet"];
            program.run_with(&[&words[..], &more, &output].concat(), &layer.variables("placed-samples")).fine();
            let picture = image_file::read(Path::new(&program.path("a.exr"))).unwrap();
            let mut compared = 0;
            for (index, found) in (0..).zip(&picture.pixels) {
                let pixel = [index % SIZE[0], index / SIZE[0]];
                let own = pattern.samples_of(pixel);
                let sent = own.iter().map(|sample| {
                    let place = FOUR_PLACES[sample.subset as usize % 4];
                    grey_at([0, 1].map(|axis| (pixel[axis] as f32 + place[axis]) / SIZE[axis] as f32))
                });
                let expected = sent.sum::<f32>() / own.len() as f32;
                if !own.is_empty() {
                    compared += 1;
                    assert!(
                        (found[0] - expected).abs() < 1e-5,
                        "{basis}, {samples}, {prepass}: {found:?} at {pixel:?}, {expected} expected"
                    );
                }
            }
            assert!(compared > 50, "{basis}, {samples}: {compared}");
        }
    }
}
