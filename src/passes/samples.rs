//! Samples of a pixel (`--msaa`), how often what is drawn into them is shaded (`--sample-shading`), and what they hold
//! (`--sample-format`). Kircher & Lawrance 2009, section 3, shades once a pixel; what each costs: docs/techniques/forward.md.

use crate::caps::{Ability, Need};
use crate::plan::PICTURE_FORMAT;
use crate::settings::{SampleFormat, Values};
use ash::vk;

/// Samples of each pixel that is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Samples {
    pub count: u32,
    /// Fragment shaders run once for each sample that is covered, at its place; else once for all of a pixel, at a place on the
    /// triangle.
    are_shaded: bool,
    /// They lie where `Commands::place_samples` says.
    pub are_placed: bool,
    /// The format of the picture that they are drawn into.
    pub format: vk::Format,
}

impl Samples {
    /// The middle of the pixel.
    pub const ONE: Self = Self { count: 1, are_shaded: false, are_placed: false, format: PICTURE_FORMAT };

    /// What the settings ask for.
    pub fn new(values: &Values) -> Self {
        let count = values.integer("msaa") as u32;
        let format = match values.choice("sample-format") {
            SampleFormat::Half if count > 1 => vk::Format::R16G16B16A16_SFLOAT,
            _ => PICTURE_FORMAT,
        };
        Self { count, are_shaded: count > 1 && values.is_on("sample-shading"), are_placed: false, format }
    }

    /// So many, each shaded at its place, which commands say.
    pub fn placed(count: u32) -> Self {
        Self { count, are_shaded: true, are_placed: true, format: PICTURE_FORMAT }
    }

    /// There is more than one.
    pub fn are_many(self) -> bool {
        self.count > 1
    }

    /// How often a surface that fills a pixel is shaded.
    pub fn shaded_count(self) -> u32 {
        if self.are_shaded { self.count } else { 1 }
    }

    /// The constant of fragment shaders whose colours become samples.
    pub fn constant(self) -> (&'static str, u32) {
        ("SAMPLES_ARE_HALVES", u32::from(self.format != PICTURE_FORMAT))
    }

    /// The axis SHADED of fragment shaders.
    pub fn shaded_name(self) -> &'static str {
        if self.are_shaded { "sample" } else { "pixel" }
    }
}

/// What `--msaa` and `--sample-shading` need of a device.
pub fn needs(values: &Values) -> impl Iterator<Item = Need> {
    let Samples { count, are_shaded, .. } = Samples::new(values);
    let counted = match count {
        4 => Some((Ability::FourSamples, "--msaa 1 works everywhere")),
        8 => Some((Ability::EightSamples, "--msaa 4 works on more devices, --msaa 1 everywhere")),
        _ => None,
    };
    let counted = counted.map(|(ability, instead)| Need { of: format!("--msaa {count}"), ability, instead });
    let shaded = are_shaded.then(|| Need {
        of: "--sample-shading on".to_owned(),
        ability: Ability::SampleShading,
        instead: "--sample-shading off works without it",
    });
    counted.into_iter().chain(shaded)
}
