//! quincunx: a headless Vulkan renderer in which papers on interleaved, inferred and decoupled shading run side by side:
//! the same scene, the same lights, the same driver, the same ground truth.
//!
//! # Techniques
//!
//! - [`techniques::interleaved_deferred`]: Segovia et al. 2006, virtual point lights interleaved over a pattern
//! - [`techniques::inferred_lighting`]: Kircher and Lawrance 2009, lights at a fraction of the pixels
//! - [`techniques::deep_shading`]: Clarberg et al. 2014, samples of a lens and a shutter that share their triangles' shading
//! - [`techniques::adaptive_interleaved`]: Dubla et al. 2009, soft shadows and indirect light refined tile by tile
//! - [`techniques::interleaved_sampling`]: Keller and Heidrich 2001, pictures of regular grids that make one of irregular samples
//! - [`techniques::deferred`]: plain deferred shading of punctual lights, the baseline
//! - [`techniques::forward`]: forward shading with a list of lights for each object, the other baseline
//! - [`techniques::path_traced`]: the integral that the others approximate
//!
//! # A picture in ten lines
//!
//! ```no_run
//! use quincunx::job::Job;
//!
//! let technique = quincunx::techniques::find("interleaved_deferred")?;
//! let mut job = Job::new("cornell", technique);
//! job.set("size", "640x360")?;
//! job.set("pattern", "4x4")?;
//! job.output = Some("cornell.exr".into());
//! let outcome = job.run()?;
//! println!("{}", outcome.report.text());
//! # Ok::<(), quincunx::Error>(())
//! ```
//!
//! # The path of a run, and the modules along it
//!
//! Arguments become a [`job`], a job loads a [`scene`] (a [`sequence`] once for all frames, posed for each), a technique
//! makes a [`plan`] of it, a [`session`] makes the plan real, frames are recorded through [`gpu`] out of [`memory`], and
//! what comes out is a [`report`].
//!
//! | room | what lives there |
//! | --- | --- |
//! | [`cli`] | one file per verb: parse, run, print |
//! | [`settings`] | every number that a technique reads, as one table |
//! | [`scene`] | triangles, materials, lights, cameras; glTF and built-in scenes; no Vulkan |
//! | [`resident`] | the scene in device memory |
//! | [`bvh`], [`lights`], [`shading`], [`sampling`] | rays, virtual lights and culling, BRDFs and light units, sequences |
//! | [`passes`], [`techniques`] | what is drawn and computed, mirrored by glsl/ |
//! | [`caps`] | what devices can do, as plain data |
//! | [`picture`] | pictures on the host, tone mapping, files |
//! | [`gpu`], [`memory`] | a thin floor over ash; the only room that allocates |
//! | [`spirv`] | shaders that count what they touch: modules rewritten as data |
//! | [`selftest`] | every method that a device supports beside a plain twin, as one document |
//! | [`metrics`], [`mod@reference`], [`mod@bench`] | errors of pictures; against what; times of variants, in turn |
//! | [`tune`] | settings chosen by measuring them on the machine at hand |
//! | [`papers`] | what the papers publish, as data, and the commands that make it here |

pub mod bench;
pub mod bvh;
pub mod caps;
pub mod choice;
pub mod cli;
pub mod continuation;
pub mod error;
pub mod frame;
pub mod framing;
pub mod gpu;
pub mod interrupt;
pub mod job;
pub mod lens;
pub mod lights;
pub mod locality;
pub mod memory;
pub mod metrics;
pub mod page;
pub mod papers;
pub mod passes;
pub mod picture;
pub mod plan;
pub mod preset;
pub mod progress;
pub mod reference;
pub mod report;
pub mod resident;
pub mod sampling;
pub mod scene;
pub mod selftest;
pub mod sequence;
pub mod session;
pub mod settings;
pub mod shading;
pub mod spirv;
pub mod study;
pub mod svg;
pub mod techniques;
pub mod tune;
pub mod units;
pub mod user_folder;
pub mod volume;
pub mod whole_file;

pub use error::{Error, ErrorKind, Result};
