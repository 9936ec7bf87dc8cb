//! Keller and Heidrich 2001: interleaved sampling.

mod figures;
mod moire;
mod samplers;
mod volumes;

use super::item::Paper;

pub const PAPER: Paper = Paper {
    name: "keller-2001",
    authors: "Alexander Keller, Wolfgang Heidrich",
    title: "Interleaved Sampling",
    venue: "Eurographics Workshop on Rendering 2001, pages 269 to 276",
    items: &[
        moire::SECTION_2_2,
        samplers::SAMPLERS_BY_EFFECT,
        figures::FIGURE_1,
        figures::FIGURE_2,
        volumes::FIGURE_3,
        figures::FIGURE_4,
        volumes::FIGURE_5,
        volumes::FIGURE_6,
        volumes::SECTION_3_3,
        samplers::SAMPLERS_ELSEWHERE,
    ],
};
