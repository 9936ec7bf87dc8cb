//! The binary part of a .glb: bytes, and the views and accessors that name them.

use glam::Vec3;
use serde_json::{Value, json};

/// WebGL's numbers, which glTF uses.
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

#[derive(Default)]
pub struct Binary {
    pub bytes: Vec<u8>,
    pub views: Vec<Value>,
    pub accessors: Vec<Value>,
}

impl Binary {
    /// Appends bytes; returns the view's index. `target`: what a GPU would use them as.
    fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        // Each part begins where a float may.
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.bytes.extend_from_slice(bytes);
        self.views.push(view);
        self.views.len() - 1
    }

    /// Appends an encoded image; returns the view's index.
    pub fn image(&mut self, bytes: &[u8]) -> usize {
        self.view(bytes, None)
    }

    /// Appends vectors of floats; returns the accessor's index. `kind`: VEC2, VEC3 or VEC4.
    pub fn vectors(&mut self, floats: &[f32], kind: &str) -> usize {
        let view = self.view(bytemuck::cast_slice(floats), Some(ARRAY_BUFFER));
        let components = match kind {
            "VEC2" => 2,
            "VEC3" => 3,
            _ => 4,
        };
        let count = floats.len() / components;
        self.accessors.push(json!({ "bufferView": view, "componentType": FLOAT, "count": count, "type": kind }));
        self.accessors.len() - 1
    }

    /// The same for positions, whose box glTF requires.
    pub fn positions(&mut self, positions: &[Vec3]) -> usize {
        let accessor = self.vectors(bytemuck::cast_slice(positions), "VEC3");
        let low = positions.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let high = positions.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
        self.accessors[accessor]["min"] = json!(low.to_array());
        self.accessors[accessor]["max"] = json!(high.to_array());
        accessor
    }

    /// The times of keyframes, ascending, whose ends glTF requires.
    pub fn times(&mut self, times_s: &[f32]) -> usize {
        let view = self.view(bytemuck::cast_slice(times_s), None);
        let mut accessor =
            json!({ "bufferView": view, "componentType": FLOAT, "count": times_s.len(), "type": "SCALAR" });
        (accessor["min"], accessor["max"]) = (json!([times_s.first()]), json!([times_s.last()]));
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    pub fn indices(&mut self, indices: &[u32]) -> usize {
        let view = self.view(bytemuck::cast_slice(indices), Some(ELEMENT_ARRAY_BUFFER));
        self.accessors.push(
            json!({ "bufferView": view, "componentType": UNSIGNED_INT, "count": indices.len(), "type": "SCALAR" }),
        );
        self.accessors.len() - 1
    }
}
