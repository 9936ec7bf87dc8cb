//! Clarberg and Munkberg 2014: deep shading buffers.

mod figures;
mod memory;
mod scenes;
mod shading_figures;
mod tables;
mod timings;

use super::item::Paper;

pub const PAPER: Paper = Paper {
    name: "clarberg-2014",
    authors: "Petrik Clarberg, Jacob Munkberg",
    title: "Deep Shading Buffers on Commodity GPUs",
    venue: "ACM Transactions on Graphics (SIGGRAPH Asia 2014)",
    items: &[
        tables::TABLE_1,
        timings::TABLE_2,
        tables::TABLE_3,
        memory::SECTION_6,
        figures::FIGURE_1,
        figures::FIGURE_2,
        figures::FIGURE_3,
        figures::FIGURE_4,
        figures::FIGURE_5,
        figures::FIGURE_6,
        figures::FIGURE_7,
        shading_figures::FIGURE_8,
        shading_figures::FIGURE_9,
        shading_figures::FIGURE_10,
        shading_figures::FIGURE_11,
        shading_figures::SECTION_4_5,
        shading_figures::SECTION_7,
    ],
};
