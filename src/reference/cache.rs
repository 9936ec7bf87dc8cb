//! Where references are kept: an EXR each, under its key, written whole or not at all.
//!
//! Nothing that is found is believed: a file counts when it holds the key and the hash of its own pixels. Two processes may
//! make the same reference at once; each renames a whole file into place, and the last one stays.

use super::recipe::Recipe;
use crate::error::{Error, Result};
use crate::picture::image_file::WriteOptions;
use crate::picture::{Picture, image_file};
use crate::user_folder;
use std::path::{Path, PathBuf};

const KEY: &str = "quincunx.reference_key";
const HASH: &str = "quincunx.image_hash";
const RECIPE: &str = "quincunx.recipe";

/// A folder of references; it need not exist.
pub struct Cache {
    folder: PathBuf,
}

/// What is kept under a key.
pub enum CacheOutcome {
    Nothing,
    Whole(Picture),
    /// A file that is not what it should be, and why. It has been moved out of the way where that was possible.
    Broken(String),
}

impl Cache {
    /// In `folder`.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into() }
    }

    /// The user's: `references` in QUINCUNX_CACHE, or in quincunx in XDG_CACHE_HOME, or in ~/.cache/quincunx.
    ///
    /// Errors: none of these is set (exit code 2).
    pub fn of_user() -> Result<Self> {
        let folder = user_folder::cache().ok_or_else(|| {
            Error::request("--reference auto: there is no folder to keep references in, because HOME is not set")
                .note("set QUINCUNX_CACHE to one")
        })?;
        Ok(Self::new(folder.join("references")))
    }

    /// The file of a recipe.
    pub fn path(&self, recipe: &Recipe) -> PathBuf {
        self.folder.join(format!("{}.exr", recipe.key()))
    }

    /// What is kept of a recipe. A broken file is renamed to `KEY.broken.exr`.
    pub fn find(&self, recipe: &Recipe) -> CacheOutcome {
        let path = self.path(recipe);
        if !path.exists() {
            return CacheOutcome::Nothing;
        }
        match read(&path, recipe) {
            Ok(picture) => CacheOutcome::Whole(picture),
            Err(error) => {
                let aside = path.with_extension("broken.exr");
                let fate = match std::fs::rename(&path, &aside) {
                    Ok(()) => format!("it is {} now", aside.display()),
                    Err(error) => format!("it cannot be renamed: {error}"),
                };
                CacheOutcome::Broken(format!("{}; {fate}", error.message()))
            }
        }
    }

    /// Keeps a picture.
    ///
    /// Errors: it cannot be written (exit code 2), or holds NaN or infinity (1).
    pub fn keep(&self, recipe: &Recipe, picture: &Picture) -> Result<PathBuf> {
        let path = self.path(recipe);
        let hash = picture.hash()?;
        std::fs::create_dir_all(&self.folder)
            .map_err(|error| Error::request(format!("cannot make {}: {error}", self.folder.display())))?;
        let attributes = [(KEY, recipe.key().to_owned()), (HASH, hash), (RECIPE, recipe.identity().to_string())];
        let attributes = attributes.map(|(name, text)| (name.to_owned(), text)).to_vec();
        image_file::write(&path, picture, &WriteOptions { attributes, ..WriteOptions::default() })?;
        Ok(path)
    }
}

/// Errors: it is not the whole picture of the recipe (exit code 2; 1 where it holds NaN or infinity).
fn read(path: &Path, recipe: &Recipe) -> Result<Picture> {
    let (picture, texts) = image_file::read_exr_with_texts(path)?;
    let wrong = |what: &str| Error::request(format!("{}: {what}", path.display()));
    if texts.get(KEY).map(String::as_str) != Some(recipe.key()) {
        return Err(wrong("it is kept under another key than it holds"));
    }
    if picture.extent != recipe.extent() {
        return Err(wrong(&format!("it is {}, and should be {}", picture.extent, recipe.extent())));
    }
    let hash = picture.hash().map_err(|error| error.within(path.display()))?;
    if texts.get(HASH) != Some(&hash) {
        return Err(wrong("its pixels are not those that were written"));
    }
    Ok(picture)
}
