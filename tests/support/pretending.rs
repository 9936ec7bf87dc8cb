//! Programs on a device that behaves as others may: the layer of tools/pretend.

use super::skip;

/// The layer, as a folder that tools/test has built it in.
pub struct Layer(String);

impl Layer {
    /// None, with a line that says so, where there is none.
    pub fn built() -> Option<Self> {
        let layer = std::env::var("QUINCUNX_PRETEND_LAYER").ok().map(Self);
        if layer.is_none() {
            skip("QUINCUNX_PRETEND_LAYER is not set: tools/test builds the layer of tools/pretend and sets it");
        }
        layer
    }

    /// What the environment of a program says for it to see the layer in these modes.
    pub fn variables<'a>(&'a self, modes: &'a str) -> [(&'static str, &'a str); 4] {
        [
            ("QUINCUNX_PRETEND", modes),
            ("VK_INSTANCE_LAYERS", "VK_LAYER_QUINCUNX_pretend"),
            ("VK_LAYER_PATH", self.0.as_str()),
            // A runner that names folders of its own (tools/test --layers) adds this one.
            ("VK_ADD_LAYER_PATH", self.0.as_str()),
        ]
    }
}
