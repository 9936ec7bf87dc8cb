//! By what a sample is tested against a triangle (`--coverage-test`).

use crate::choice::choices;

choices! {
    /// Test of a sample against a triangle that is blurred (`--coverage-test`).
    pub enum CoverageTest {
        /// Corners are placed as for all else, and then tested.
        "full" => Full,
        /// Only what edges need is placed.
        "reduced" => Reduced,
    }
}
