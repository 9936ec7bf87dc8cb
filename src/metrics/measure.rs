//! The measures as one table: what each is called, what it measures, its unit, and its number among the others. Tables,
//! gates, help and JSON are made from it.

use serde::{Deserialize, Deserializer, Serialize};
use std::fmt::Display;

/// A measure of the error of a picture.
#[derive(Debug)]
pub struct Measure {
    /// As the command line and the reports write it.
    pub name: &'static str,
    /// As papers write it.
    pub title: &'static str,
    /// Whether it measures scene-linear light, where a picture whose file holds none above 1 is cut; else it measures
    /// what a screen shows.
    pub is_of_light: bool,
    /// Unit of its numbers, made with the threshold above which pixels count; empty where they have none.
    pub unit: fn(&dyn Display) -> String,
    /// Its number among those of a comparison.
    pub value: fn(&Metrics) -> f64,
}

impl Measure {
    /// The measure of a name; None: there is none.
    pub fn named(name: &str) -> Option<&'static Self> {
        Metrics::MEASURES.iter().find(|measure| measure.name == name)
    }

    /// A number of it as a person reads it. `is_cut`: a PNG is among the pictures.
    pub fn line(&self, value: f64, threshold: f64, is_cut: bool) -> String {
        let unit = match (self.unit)(&threshold) {
            unit if unit.is_empty() => unit,
            unit => format!(" {unit}"),
        };
        let cut = if is_cut && self.is_of_light { "  (light above 1 is cut by a PNG)" } else { "" };
        format!("  {:<14}  {value:>12.6}{unit}{cut}", self.name)
    }
}

/// Declares `Metrics`: a field for each measure, and the table of them in that order. A number that a document of
/// before the measure does not have is NaN; a NaN is not written.
macro_rules! measures {
    (
        $(#[$of_struct:meta])*
        pub struct $Metrics:ident {
            $(
                $(#[$of_field:meta])*
                $name:ident {
                    title: $title:literal, is_of_light: $is_of_light:literal, unit: $unit:expr, equal: $equal:expr $(,)?
                }
            )+
        }
    ) => {
        $(#[$of_struct])*
        #[derive(Clone, Copy, Debug, Serialize, Deserialize)]
        #[serde(default = "not_measured")]
        pub struct $Metrics {
            $($(#[$of_field])* #[serde(skip_serializing_if = "was_not_measured")] pub $name: f64,)+
        }

        impl $Metrics {
            /// All measures, in the order of the fields.
            pub const MEASURES: &'static [Measure] = &[$(Measure {
                name: stringify!($name),
                title: $title,
                is_of_light: $is_of_light,
                unit: $unit,
                value: |metrics| metrics.$name,
            }),+];

            /// Their names.
            pub const NAMES: &'static [&'static str] = &[$(stringify!($name)),+];

            /// Those of equal pictures.
            pub const EQUAL: Self = Self { $($name: $equal),+ };
        }

        fn was_not_measured(value: &f64) -> bool {
            value.is_nan()
        }

        /// What a document does not have.
        fn not_measured() -> $Metrics {
            $Metrics { $($name: f64::NAN),+ }
        }
    };
}

measures! {
    /// One number of each kind. Under serde an infinite PSNR is null, and what is NaN, because a document of before the
    /// measure does not have it, has no key.
    pub struct Metrics {
        /// Root of the mean squared difference over all pixels and channels, in units of radiance; 0 for equal
        /// pictures.
        rmse { title: "RMSE", is_of_light: true, unit: |_| String::new(), equal: 0.0 }

        /// Mean over all pixels and channels of (a - b)^2 / (b^2 + 0.01), b the reference; 0 for equal pictures.
        relmse { title: "relMSE", is_of_light: true, unit: |_| String::new(), equal: 0.0 }

        /// Peak signal-to-noise ratio in decibels; infinite where the 8-bit pictures are equal.
        #[serde(deserialize_with = "or_infinity")]
        psnr { title: "PSNR", is_of_light: false, unit: |_| "dB".to_owned(), equal: f64::INFINITY }

        /// Structural similarity of the luma, -1 to 1; 1 for equal pictures.
        ssim { title: "SSIM", is_of_light: false, unit: |_| String::new(), equal: 1.0 }

        /// Mean of FLIP's map at 67 pixels a degree, 0 to 1; 0 for equal pictures.
        flip { title: "FLIP", is_of_light: false, unit: |_| String::new(), equal: 0.0 }

        /// Mean of HDR-FLIP's map, 0 to 1: the worst of the exposures that the reference asks for, pixel by pixel.
        hdr_flip { title: "HDR-FLIP", is_of_light: true, unit: |_| String::new(), equal: 0.0 }

        /// Percent of the pixels whose HDR-FLIP is above a threshold, 0 to 100. Dubla et al. 2009 count pixels that
        /// differ visibly in this way (table 3), with HDR-VDP and its probabilities of detection, which this is not.
        over_threshold {
            title: "pixels over a threshold",
            is_of_light: true,
            unit: |threshold| format!("% of pixels above {threshold}"),
            equal: 0.0,
        }
    }
}

impl Metrics {
    /// Names of the measures of light.
    pub fn of_light() -> Vec<&'static str> {
        let of_light = Self::MEASURES.iter().filter(|measure| measure.is_of_light);
        of_light.map(|measure| measure.name).collect()
    }

    /// The numbers with their measures.
    pub fn each(&self) -> impl Iterator<Item = (&'static Measure, f64)> {
        Self::MEASURES.iter().map(|measure| (measure, (measure.value)(self)))
    }
}

/// What a row does not have is the same in both.
impl PartialEq for Metrics {
    fn eq(&self, other: &Self) -> bool {
        self.each().zip(other.each()).all(|((_, a), (_, b))| a == b || (a.is_nan() && b.is_nan()))
    }
}

/// A number, or infinity where JSON, which has none, says null.
pub fn or_infinity<'de, D: Deserializer<'de>>(deserializer: D) -> std::result::Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::INFINITY))
}
