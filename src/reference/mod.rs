//! References: the picture that others are judged against, from a file, or path-traced once and kept.
//!
//! `auto` means the picture that `path_traced` makes of the same scene, camera, size and lights, of the transport that
//! the judged technique claims to compute (`Technique::reference_settings`): what is left is the technique's own error.

pub mod cache;
pub mod made;
pub mod recipe;

use crate::error::{Error, Result};
use crate::metrics::gate::{self, Gate};
use crate::metrics::{self, Metrics};
use crate::picture::{Picture, image_file};
use crate::report::errors::{Errors, ReferenceIdentity};
use crate::session::Session;
use crate::settings::Values;
use crate::techniques::{self, Technique};
use crate::units::Extent;
use cache::Cache;
use made::Watch;
use recipe::Recipe;
use std::cell::RefCell;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// What makes the references of `auto`.
pub const TRUTH: &str = "path_traced";
/// Samples a pixel of `auto` where nothing else is asked for.
pub const DEFAULT_SPP: u64 = 256;

/// Where a reference comes from.
enum Source {
    File { path: PathBuf, picture: Rc<Picture>, hash: String },
    Auto { technique: &'static dyn Technique, spp: u64, known: RefCell<HashMap<String, Rc<Picture>>> },
}

/// A reference as it was asked for, and what is to be done with it.
pub struct ReferenceRequest {
    source: Source,
    /// Threshold of `Metrics::over_threshold`.
    threshold: f64,
    gates: Vec<Gate>,
    watch: Box<dyn Watch>,
}

/// What judging a picture leaves.
pub struct ReferenceResult {
    /// The report's `errors`.
    pub errors: Errors,
    /// Whether the gates hold.
    pub gates: Result<()>,
}

impl ReferenceRequest {
    /// `text`: a picture's file, or `auto` with `spp` samples a pixel. `watch` is notified while a reference is made.
    ///
    /// Errors: the file cannot be read (exit code 2), or holds NaN or infinity (1).
    pub fn new(text: &str, spp: u64, threshold: f64, gates: Vec<Gate>, watch: Box<dyn Watch>) -> Result<Self> {
        let source = if text == "auto" {
            let technique = techniques::find(TRUTH)?;
            Source::Auto { technique, spp, known: RefCell::default() }
        } else {
            let within = |error: Error| error.within("--reference");
            let picture = image_file::read(Path::new(text)).map_err(within)?;
            let hash = picture.hash().map_err(|error| error.within(text)).map_err(within)?;
            Source::File { path: text.into(), picture: picture.into(), hash }
        };
        Ok(Self { source, threshold, gates, watch })
    }

    /// Whether pictures of this size can be judged.
    ///
    /// Errors: the reference is a file of another size (exit code 2).
    pub fn check(&self, extent: Extent) -> Result<()> {
        match &self.source {
            Source::File { path, picture, .. } if picture.extent != extent => Err(Error::request(format!(
                "--reference {}: it is {}, the picture {extent}: only pictures of one size compare",
                path.display(),
                picture.extent
            ))
            .note(format!("--size {} fits it", picture.extent))),
            _ => Ok(()),
        }
    }

    /// Whether pictures of several moments can be judged.
    ///
    /// Errors: the reference is a file (exit code 2).
    pub fn check_sequence(&self) -> Result<()> {
        match &self.source {
            Source::File { path, .. } => {
                Err(Error::request(format!("--reference {}: it shows one moment, --frames many", path.display()))
                    .note("--reference auto makes one for each frame"))
            }
            Source::Auto { .. } => Ok(()),
        }
    }

    /// What says that two errors are against the same: the reference and the threshold.
    pub fn identity(&self) -> ReferenceIdentity {
        let threshold = self.threshold;
        match &self.source {
            Source::File { path, hash, .. } => {
                let (name, hash) = (path.display().to_string(), Some(hash.clone()));
                ReferenceIdentity { name, hash, technique: None, spp: None, threshold }
            }
            Source::Auto { technique, spp, .. } => {
                let (technique, spp) = (Some(technique.name().to_owned()), Some(*spp));
                ReferenceIdentity { name: "auto".to_owned(), hash: None, technique, spp, threshold }
            }
        }
    }

    /// The flags that ask for it again, gates left out.
    pub fn arguments(&self) -> Vec<String> {
        let reference = match &self.source {
            Source::File { path, .. } => vec!["--reference".to_owned(), path.display().to_string()],
            Source::Auto { spp, .. } => {
                ["--reference", "auto", "--reference-spp", &spp.to_string()].map(str::to_owned).to_vec()
            }
        };
        reference.into_iter().chain(["--threshold".to_owned(), self.threshold.to_string()]).collect()
    }

    /// Judges the picture that `technique` made of what `session` shows, with these settings.
    ///
    /// Errors: another size, or the technique's transport has no reference (exit code 2); the picture holds NaN or
    /// infinity (1); where a reference is made, the device, memory (4), or Ctrl-C (130).
    pub fn judge(
        &self,
        picture: &Picture,
        technique: &dyn Technique,
        values: &Values,
        session: &Session,
    ) -> Result<ReferenceResult> {
        self.check(picture.extent)?;
        let (mut reference_key, mut reference_settings) = (None, None);
        let reference = match &self.source {
            Source::File { picture, .. } => picture.clone(),
            Source::Auto { technique: truth, spp, known } => {
                let recipe = Recipe::judging(*truth, technique, values, session, *spp)
                    .map_err(|error| error.within("--reference auto"))?;
                reference_key = Some(recipe.key().to_owned());
                reference_settings = Some(recipe.settings());
                let kept = known.borrow().get(recipe.key()).cloned();
                match kept {
                    Some(picture) => picture,
                    None => {
                        let cache = Cache::of_user()?;
                        let made = made::reference_picture(&recipe, session, &cache, self.watch.as_ref())?;
                        let picture = Rc::new(made.picture);
                        known.borrow_mut().insert(recipe.key().to_owned(), picture.clone());
                        picture
                    }
                }
            }
        };
        let metrics = metrics::compare(picture, &reference, self.threshold)?.metrics;
        let cut = if self.is_cut() { Metrics::of_light() } else { Vec::new() };
        let errors = Errors {
            reference: self.identity().name,
            reference_key,
            reference_settings,
            metrics,
            threshold: self.threshold,
            cut: cut.into_iter().map(str::to_owned).collect(),
            gates: self.gates.iter().map(|gate| gate.verdict(&metrics)).collect(),
        };
        Ok(ReferenceResult { errors, gates: gate::judge(&self.gates, &metrics, "against the reference") })
    }

    /// The reference of one of many pictures that `technique` made, as of `judge`: kept in the user's folder alone, because
    /// memory does not hold those of a sequence.
    ///
    /// Errors: as `judge`.
    pub fn of_frame(&self, technique: &dyn Technique, values: &Values, session: &Session) -> Result<Picture> {
        match &self.source {
            Source::File { picture, .. } => Ok(picture.as_ref().clone()),
            Source::Auto { technique: truth, spp, .. } => {
                let recipe = Recipe::judging(*truth, technique, values, session, *spp)
                    .map_err(|error| error.within("--reference auto"))?;
                Ok(made::reference_picture(&recipe, session, &Cache::of_user()?, self.watch.as_ref())?.picture)
            }
        }
    }

    fn is_cut(&self) -> bool {
        matches!(&self.source, Source::File { path, .. } if image_file::is_cut(path))
    }
}
