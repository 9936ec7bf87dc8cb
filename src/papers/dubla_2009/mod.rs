//! Dubla, Debattista and Chalmers 2009: adaptive interleaved sampling.

mod costs;
mod figures;
mod tables;

use super::item::Paper;

pub const PAPER: Paper = Paper {
    name: "dubla-2009",
    authors: "Piotr Dubla, Kurt Debattista, Alan Chalmers",
    title: "Adaptive Interleaved Sampling for Interactive High-Fidelity Rendering",
    venue: "Computer Graphics Forum 28, 2009, pages 2117 to 2130",
    items: &[
        tables::TABLE_1,
        tables::TABLE_2,
        tables::TABLE_3,
        figures::FIGURE_1,
        figures::FIGURE_2,
        figures::FIGURES_3_TO_5,
        figures::FIGURE_6,
        figures::FIGURE_7,
        figures::FIGURE_8,
        figures::FAILURES,
        figures::FLICKER,
        costs::SECTION_3,
    ],
};
