//! Marks of surfaces in a file's `extras`, in keys of this program's own: the layer of a stipple that lights them.

use gltf::Document;
use gltf::json::Extras;
use serde::Deserialize;
use serde_json::Value;

use super::label;
use crate::error::{Error, Result};
use crate::scene::Node;

/// Key in a material's or a node's extras: the stipple layer that its BLEND surfaces are lit in (Kircher 2009,
/// section 4).
pub const STIPPLE_LAYER: &str = "quincunx_stipple_layer";
/// Greatest layer of a 4x4 stipple, the largest one.
const MOST_LAYER: u64 = 15;

#[derive(Deserialize)]
struct Marks {
    quincunx_stipple_layer: Option<Value>,
}

/// The layer that `extras` names, 1 to 15; None where they name none.
///
/// Errors: it is something else (exit code 2).
pub fn stipple_layer(extras: &Extras) -> Result<Option<u32>> {
    // Extras are anything; what is no object has no keys.
    let marks = extras.as_ref().and_then(|extras| serde_json::from_str::<Marks>(extras.get()).ok());
    let Some(value) = marks.and_then(|marks| marks.quincunx_stipple_layer) else { return Ok(None) };
    match value.as_u64() {
        Some(layer @ 1..=MOST_LAYER) => Ok(Some(layer as u32)),
        _ => Err(Error::request(format!(
            "extras.{STIPPLE_LAYER} is {}; it must be a whole number from 1 to {MOST_LAYER}",
            label::shown(&value.to_string())
        ))),
    }
}

/// The file's nodes.
///
/// Errors: as `stipple_layer`, of a node.
pub fn nodes(document: &Document) -> Result<Vec<Node>> {
    let read = |node: gltf::Node<'_>| {
        let layer = stipple_layer(node.extras());
        let stipple_layer = layer.map_err(|error| error.within(label::element("node", node.index(), node.name())))?;
        Ok(Node { name: node.name().unwrap_or_default().to_owned(), stipple_layer })
    };
    document.nodes().map(read).collect()
}
