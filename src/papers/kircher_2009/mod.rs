//! Kircher and Lawrance 2009: inferred lighting. It has no numbered tables: its numbers stand in captions and in the text.

mod figures;
mod quality;
mod sections;

use super::item::Paper;

pub const PAPER: Paper = Paper {
    name: "kircher-2009",
    authors: "Scott Kircher, Alan Lawrance",
    title: "Inferred Lighting: Fast dynamic lighting and shadows for opaque and translucent objects",
    venue: "ACM SIGGRAPH Symposium on Video Games 2009",
    items: &[
        figures::FIGURE_1,
        figures::FIGURE_2,
        quality::FIGURE_3,
        figures::FIGURE_4,
        figures::FIGURE_5,
        figures::FIGURE_6,
        figures::FIGURE_7,
        figures::FIGURE_8,
        quality::FIGURE_9,
        figures::FIGURE_10,
        sections::BYTES,
        sections::SECTION_2_2,
        sections::VOLUMES,
        quality::SECTION_3,
    ],
};
