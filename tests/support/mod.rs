//! What several test files share.

pub mod benched;
pub mod boxes;
pub mod choices;
pub mod counted;
pub mod difference;
pub mod failing;
pub mod gltf_file;
pub mod measured;
pub mod moving;
pub mod pretending;
pub mod program;
pub mod seen;
pub mod shading_space;
pub mod square;
pub mod touched;
pub mod watched;

use quincunx::caps::{Ability, Caps, known};
use quincunx::gpu::{DeviceRequest, Gpu};
use std::io::Write;
use std::path::PathBuf;

/// The driver whose pictures are goldens and whose rules are the default of `memory --plan`.
pub const PINNED: &str = "Mesa 22.3.6";

/// The folder of the shared scenes, which QUINCUNX_SCENES names; None, with a line that says so, where it is not set.
///
/// Panics where CI is `true`: a skip in CI is a failure.
pub fn shared_scenes() -> Option<PathBuf> {
    let folder = std::env::var_os("QUINCUNX_SCENES").map(PathBuf::from);
    if folder.is_none() {
        skip("QUINCUNX_SCENES is not set");
    }
    folder
}

/// A browser of Chromium's kind; None where there is none.
pub fn browser() -> Option<PathBuf> {
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let names = ["chromium", "chromium-browser", "google-chrome"];
    std::env::split_paths(&folders)
        .flat_map(|folder| names.map(|name| folder.join(name)))
        .find(|program| program.is_file())
}

/// Says that a test, or the rest of one, does not run here: on standard output, which runners show of failed tests only,
/// and as a line of the file that QUINCUNX_SKIPS names.
///
/// Panics where CI is `true`: a skip in CI is a failure.
pub fn skip(why: &str) {
    let line = name_skip(why);
    assert!(std::env::var("CI").as_deref() != Ok("true"), "in CI, {line}");
}

/// What `skip` says, without a failure in CI: of what CI does not have.
pub fn name_skip(why: &str) -> String {
    let thread = std::thread::current();
    let line = format!("skipped: {}: {why}\n", thread.name().unwrap_or("a test"));
    print!("{line}");
    if let Some(file) = std::env::var_os("QUINCUNX_SKIPS") {
        let mut file = std::fs::OpenOptions::new().append(true).create(true).open(file).unwrap();
        // One write: tests run side by side.
        file.write_all(line.as_bytes()).unwrap();
    }
    line
}

/// The caps of the device that tests run on.
pub fn driver() -> Caps {
    Gpu::open(&DeviceRequest::default()).unwrap().caps.clone()
}

/// The known driver that runs, by name; None, and said, where another one does.
pub fn known_driver() -> Option<&'static str> {
    let live = driver().identity;
    let is_live = |name: &&str| {
        let known = known::caps(name).unwrap().identity;
        (known.driver, known.driver_info) == (live.driver.clone(), live.driver_info.clone())
    };
    let name = known::names().find(is_live);
    if name.is_none() {
        skip(&format!("{} has no rules in assets/caps", live.driver_text()));
    }
    name
}

/// How many times as coarse as to a 256th of a pixel the driver places vertices, eight at most: bounds of what depends on it are
/// as many times as wide.
pub fn placing_steps(caps: &Caps) -> f64 {
    f64::from(1u32 << 8u32.saturating_sub(caps.limits.sub_pixel_bits).min(3))
}

/// What a test needs of the driver that it runs on.
#[derive(Clone, Copy, Debug)]
pub enum Feature {
    /// The driver that goldens are blessed on.
    Pinned,
    /// Points of a surface as exact as closed forms are: vertices are placed to a 256th of a pixel.
    ExactPositions,
    /// Rays through structures of the driver's own.
    RayQuery,
    GeometryShader,
    /// Shaders keep the greatest of 64 bits.
    WideAtomics,
    /// The device counts what stages do.
    PipelineStatistics,
    /// The device counts the samples of a draw.
    PreciseOcclusion,
    /// Fragment shaders run once a sample.
    SampleShading,
    /// Pairs of 16-bit fractions are blended.
    BlendFixedPairs,
    /// A sample's place in its pixel is the program's to say.
    SampleLocations,
    /// Fragment shaders are told where on its triangle a fragment is.
    FragmentBarycentrics,
}

impl Feature {
    fn is_there(self, caps: &Caps) -> bool {
        match self {
            Self::Pinned => caps.identity.driver_info.contains(PINNED),
            Self::ExactPositions => caps.limits.sub_pixel_bits >= 8,
            Self::RayQuery => caps.features.ray_query,
            Self::GeometryShader => caps.features.geometry_shader,
            Self::WideAtomics => caps.features.shader_int64_atomics,
            Self::PipelineStatistics => caps.features.pipeline_statistics,
            Self::PreciseOcclusion => caps.features.occlusion_query_precise,
            Self::SampleShading => caps.features.sample_rate_shading,
            Self::BlendFixedPairs => caps.formats.fixed_pair_blend,
            Self::SampleLocations => Ability::SampleLocations.is_there(caps),
            Self::FragmentBarycentrics => Ability::FragmentBarycentrics.is_there(caps),
        }
    }

    /// Whether the driver that CI runs on has it: where not, CI skips the test as others do.
    fn is_of_pinned(self) -> bool {
        match self {
            Self::Pinned
            | Self::ExactPositions
            | Self::GeometryShader
            | Self::WideAtomics
            | Self::PipelineStatistics
            | Self::PreciseOcclusion
            | Self::SampleShading
            | Self::BlendFixedPairs => true,
            Self::RayQuery | Self::SampleLocations | Self::FragmentBarycentrics => false,
        }
    }

    /// In words that follow "has no".
    fn lack(self, caps: &Caps) -> String {
        match self {
            Self::Pinned => format!("goldens, which are blessed on {PINNED}"),
            Self::ExactPositions => {
                format!("vertices placed to a 256th of a pixel: {} bits, 8 are needed", caps.limits.sub_pixel_bits)
            }
            Self::RayQuery => "VK_KHR_ray_query with VK_KHR_acceleration_structure".to_owned(),
            Self::GeometryShader => "geometryShader".to_owned(),
            Self::WideAtomics => "shaderBufferInt64Atomics with shaderInt64".to_owned(),
            Self::PipelineStatistics => "pipelineStatisticsQuery".to_owned(),
            Self::PreciseOcclusion => "occlusionQueryPrecise".to_owned(),
            Self::SampleShading => "sampleRateShading".to_owned(),
            Self::BlendFixedPairs => "R16G16_UNORM as blended colour attachment".to_owned(),
            Self::SampleLocations => Ability::SampleLocations.name().to_owned(),
            Self::FragmentBarycentrics => Ability::FragmentBarycentrics.name().to_owned(),
        }
    }
}

/// Whether the driver has what a test needs; where not, the test is skipped by name, with the reason.
///
/// Panics where CI is `true` and the pinned driver has it.
#[must_use]
pub fn has(caps: &Caps, feature: Feature) -> bool {
    let is_there = feature.is_there(caps);
    if !is_there {
        let why = format!("{} has no {}", caps.identity.driver_text(), feature.lack(caps));
        if feature.is_of_pinned() {
            skip(&why);
        } else {
            name_skip(&why);
        }
    }
    is_there
}
