//! How lists are kept, reached and drawn (`--lists`, `--list-access`, `--duplicates`, `--shaded-triangles`).

use crate::choice::choices;

choices! {
    /// How the triangles to shade are listed (`--lists`).
    pub enum Lists {
        "linked" => Linked,
        /// The host inserts into them, and samples have no SPIDs.
        "direct" => Direct,
        /// Each sample is shaded where it is seen.
        "none" => None,
    }
}

choices! {
    /// How shaders reach what is kept of each sample and shading pixel (`--list-access`).
    pub enum ListAccess {
        "descriptors" => Descriptors,
        "addresses" => Addresses,
    }
}

choices! {
    /// What an insertion does when another one has changed the list first (`--duplicates`).
    pub enum Duplicates {
        "avoided" => Avoided,
        "tolerated" => Tolerated,
    }
}

choices! {
    /// Which triangles are drawn into shading space (`--shaded-triangles`).
    pub enum ShadedTriangles {
        "listed" => Listed,
        "all" => All,
    }
}
