//! Where shading space is finer (`--shading-warp`).

use crate::choice::choices;

choices! {
    /// Where shading space is finer (`--shading-warp`).
    pub enum Warp {
        /// Nowhere.
        "even" => Even,
        /// In its middle.
        "foveated" => Foveated,
    }
}
