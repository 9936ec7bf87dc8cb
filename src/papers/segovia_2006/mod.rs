//! Segovia, Iehl, Mitanchey and Péroche 2006: interleaved deferred shading.

mod figures;
mod sections;
mod tables;

use super::item::Paper;

pub const PAPER: Paper = Paper {
    name: "segovia-2006",
    authors: "Benjamin Segovia, Jean-Claude Iehl, Richard Mitanchey, Bernard Péroche",
    title: "Non-interleaved Deferred Shading of Interleaved Sample Patterns",
    venue: "Graphics Hardware 2006",
    items: &[
        tables::TABLE_1,
        tables::TABLE_2,
        tables::TABLE_3,
        tables::TABLE_4,
        tables::TABLE_5,
        figures::FIGURE_1,
        figures::FIGURE_2,
        figures::FIGURE_3,
        figures::FIGURE_4,
        figures::FIGURE_5,
        figures::FIGURE_6,
        figures::FIGURE_7,
        figures::FIGURE_8,
        figures::FIGURE_9,
        sections::SECTION_5_1,
        sections::SECTION_5_3,
        sections::SECTION_5_4,
        sections::SECTION_6_2,
    ],
};
