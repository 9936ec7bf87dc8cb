//! What a name or a path stands for, read once: a built-in scene or a file, posed at any time.

use crate::error::{Error, Result};
use crate::progress::Stage;
use crate::scene::{AnimationChoice, Scene, gltf, procedural};
use crate::volume::Volume;
use std::path::Path;
use std::sync::Arc;

/// The scene of a name or a path, read once, from which the scene at any time is made.
#[derive(Debug)]
pub enum Model {
    BuiltIn(Box<procedural::ProceduralScene>),
    File(Box<gltf::Model>),
    /// One of the two, with a volume in it.
    Holding(Box<Model>, Arc<Volume>),
}

/// The scene of a name or a path: a built-in scene, with parameters after a colon, or a .gltf or .glb file.
///
/// Errors: no such scene, impossible parameters, a broken file, no such animation (exit code 2).
pub fn open(spec: &str, seed: u64, choice: &AnimationChoice) -> Result<Model> {
    if let Some(made) = Stage::begin("making the scene").over(|| procedural::open(spec, seed)) {
        return Ok(Model::BuiltIn(Box::new(made?.playing(choice)?)));
    }
    Ok(Model::File(Box::new(gltf::Model::open(file(spec)?, choice)?)))
}

/// The same scene, and what its file holds beside it; None for built-in scenes.
///
/// Errors: those of `load`.
pub fn inspect(spec: &str, seed: u64) -> Result<(Scene, Option<gltf::Facts>)> {
    if let Some(scene) = procedural::build(spec, seed) {
        return Ok((scene?, None));
    }
    let (scene, facts) = gltf::inspect(file(spec)?)?;
    Ok((scene, Some(facts)))
}

/// The path of a scene file.
///
/// Errors: no known suffix (exit code 2).
pub fn file(spec: &str) -> Result<&Path> {
    let path = Path::new(spec);
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default().to_lowercase();
    if !["gltf", "glb"].contains(&extension.as_str()) {
        let names: Vec<&str> = procedural::ALL.iter().map(|built_in| built_in.name).collect();
        return Err(Error::request(format!("scene {spec}: neither a built-in scene nor a .gltf or .glb file"))
            .note(format!("built-in scenes: {}", names.join(", "))));
    }
    Ok(path)
}

/// The scene of `open` at 0 s, all its animations playing.
///
/// Errors: as `open`.
pub fn load(spec: &str, seed: u64) -> Result<Scene> {
    open(spec, seed, &AnimationChoice::All)?.into_pose(0.0)
}

impl Model {
    /// The scene at `time_s`, seconds, at least 0.
    ///
    /// Errors: something leaves the range of 32-bit floats then (exit code 2).
    pub fn pose(&self, time_s: f64) -> Result<Scene> {
        match self {
            Self::BuiltIn(made) => Ok(made.as_ref().clone().into_pose(time_s)),
            Self::File(model) => model.pose(time_s),
            Self::Holding(model, volume) => Ok(model.pose(time_s)?.holding(volume)),
        }
    }

    /// The scene while a shutter is open from the first of these moments to the second, seconds.
    ///
    /// Errors: as `pose`; what is drawn changes meanwhile, not only its place (exit code 2).
    pub fn exposed(&self, [open_s, close_s]: [f64; 2]) -> Result<Scene> {
        let scene = self.pose(open_s)?;
        if open_s < close_s { scene.closing_as(self.pose(close_s)?) } else { Ok(scene) }
    }

    /// `pose` of a model that is not needed any more, without copies.
    ///
    /// Errors: as `pose`.
    pub fn into_pose(self, time_s: f64) -> Result<Scene> {
        match self {
            Self::BuiltIn(made) => Ok(made.into_pose(time_s)),
            Self::File(model) => model.into_pose(time_s),
            Self::Holding(model, volume) => Ok(model.into_pose(time_s)?.holding(&volume)),
        }
    }
}
