//! Small glTF files, built in the test that needs them and written into a folder of their own.

use std::path::PathBuf;

use quincunx::scene::gltf::Model;
use quincunx::scene::{AnimationChoice, Scene, gltf};
use quincunx::{Error, Result};
use serde_json::{Value, json};
use tempfile::TempDir;

pub const U8: u32 = 5121;
pub const U16: u32 = 5123;
pub const U32: u32 = 5125;
pub const F32: u32 = 5126;

/// The document and the bytes of its one buffer.
#[derive(Clone)]
pub struct GltfFile {
    pub json: Value,
    pub bytes: Vec<u8>,
}

impl GltfFile {
    /// An empty scene.
    pub fn empty() -> Self {
        let json = json!({
            "asset": {"version": "2.0"},
            "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [],
            "accessors": [], "bufferViews": [], "buffers": [],
        });
        Self { json, bytes: Vec::new() }
    }

    /// One node that draws the triangle (0 0 0), (1 0 0), (0 1 0), without indices or normals.
    pub fn triangle() -> Self {
        let mut file = Self::empty();
        let positions = file.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        file.push("meshes", json!({"name": "leaf", "primitives": [{"attributes": {"POSITION": positions}}]}));
        file.root(json!({"mesh": 0}));
        file
    }

    /// The triangle, skinned: nodes 1 and 2 are the joints of skin 0, "bones", and all vertices are at joint 1, node 2.
    pub fn skinned_triangle() -> Self {
        let mut file = Self::triangle();
        file.bind(U8, [1, 0, 0, 0], [1.0, 0.0, 0.0, 0.0]);
        file.json["nodes"][0]["skin"] = json!(0);
        file.root(json!({}));
        file.root(json!({}));
        file.push("skins", json!({"joints": [1, 2], "name": "bones"}));
        file
    }

    /// Binds each of the triangle's three vertices to these joints, numbers of `component_type`, with these weights.
    pub fn bind(&mut self, component_type: u32, joints: [u32; 4], weights: [f32; 4]) {
        let joints = self.indices(component_type, &joints.repeat(3));
        self.json["accessors"][joints]["type"] = json!("VEC4");
        self.json["accessors"][joints]["count"] = json!(3);
        let weights = self.floats("VEC4", &weights.repeat(3));
        let attributes = &mut self.primitive()["attributes"];
        (attributes["JOINTS_0"], attributes["WEIGHTS_0"]) = (json!(joints), json!(weights));
    }

    /// Appends to one of the document's arrays; returns the index.
    pub fn push(&mut self, array: &str, value: Value) -> usize {
        let array =
            self.json.as_object_mut().unwrap().entry(array).or_insert_with(|| json!([])).as_array_mut().unwrap();
        array.push(value);
        array.len() - 1
    }

    /// Appends a node and makes it a root of the scene; returns its index.
    pub fn root(&mut self, node: Value) -> usize {
        let index = self.push("nodes", node);
        self.json["scenes"][0]["nodes"].as_array_mut().unwrap().push(json!(index));
        index
    }

    /// Appends a view of `bytes`; returns its index.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        let offset = self.bytes.len();
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.push("bufferViews", json!({"buffer": 0, "byteOffset": offset, "byteLength": bytes.len()}))
    }

    /// Appends an accessor of floats; returns its index.
    pub fn floats(&mut self, kind: &str, values: &[f32]) -> usize {
        let components = match kind {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "MAT4" => 16,
            _ => 4,
        };
        let view = self.view(&values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<_>>());
        let count = values.len() / components;
        self.push("accessors", json!({"bufferView": view, "componentType": F32, "count": count, "type": kind}))
    }

    /// Appends an accessor of indices; returns its index.
    pub fn indices(&mut self, component_type: u32, values: &[u32]) -> usize {
        let size = match component_type {
            U8 => 1,
            U16 => 2,
            _ => 4,
        };
        let view = self.view(&values.iter().flat_map(|value| value.to_le_bytes()[..size].to_vec()).collect::<Vec<_>>());
        let count = values.len();
        self.push(
            "accessors",
            json!({"bufferView": view, "componentType": component_type, "count": count, "type": "SCALAR"}),
        )
    }

    /// Appends an animation of one channel: `path` of `node` through `values`, of a type, at `times_s`. Returns its index.
    pub fn animate(
        &mut self,
        node: usize,
        path: &str,
        interpolation: &str,
        times_s: &[f32],
        values: (&str, &[f32]),
    ) -> usize {
        let input = self.floats("SCALAR", times_s);
        let output = self.floats(values.0, values.1);
        self.push(
            "animations",
            json!({
                "channels": [{"sampler": 0, "target": {"node": node, "path": path}}],
                "samplers": [{"input": input, "output": output, "interpolation": interpolation}],
            }),
        )
    }

    /// The first primitive of the first mesh.
    pub fn primitive(&mut self) -> &mut Value {
        &mut self.json["meshes"][0]["primitives"][0]
    }

    /// The .glb's bytes.
    pub fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        if !self.bytes.is_empty() && json["buffers"] == json!([]) {
            json["buffers"] = json!([{"byteLength": self.bytes.len()}]);
        }
        let mut text = json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut glb = b"glTF\x02\0\0\0".to_vec();
        glb.extend((12 + 8 + text.len() as u32 + 8 + self.bytes.len() as u32).to_le_bytes());
        for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &self.bytes)] {
            glb.extend((chunk.len() as u32).to_le_bytes());
            glb.extend(kind);
            glb.extend(chunk);
        }
        glb
    }

    /// Opens it as a .glb.
    pub fn model(&self, choice: &AnimationChoice) -> Result<Model> {
        let (_folder, path) = write(&[("scene.glb", &self.glb())]);
        Model::open(&path, choice)
    }

    /// Loads it as a .glb.
    pub fn load(&self) -> Result<Scene> {
        load_bytes("scene.glb", &self.glb())
    }
}

/// Writes files into a folder of their own; returns it and the path of the first.
pub fn write(files: &[(&str, &[u8])]) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    let path = folder.path().join(files[0].0);
    (folder, path)
}

/// Loads a file with these bytes.
pub fn load_bytes(name: &str, bytes: &[u8]) -> Result<Scene> {
    let (_folder, path) = write(&[(name, bytes)]);
    gltf::load(&path)
}

/// A picture of one colour.
pub fn png(width: u32, height: u32) -> Vec<u8> {
    painted_png(width, height, |_, _| [1, 2, 3, 4])
}

/// A picture whose texel at x, y is `texel(x, y)`.
pub fn painted_png(width: u32, height: u32, texel: impl Fn(u32, u32) -> [u8; 4]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::RgbaImage::from_fn(width, height, |x, y| image::Rgba(texel(x, y)))
        .write_to(&mut bytes, image::ImageFormat::Png)
        .unwrap();
    bytes.into_inner()
}

/// The error must be a bad request, name the file, and hold all `words`.
#[track_caller]
pub fn expect(error: &Error, file: &str, words: &[&str]) {
    let text = error.to_string();
    assert_eq!(error.exit_code(), 2, "{text}");
    for word in [&[file], words].concat() {
        assert!(text.contains(word), "{word:?} is missing in: {text}");
    }
}
