//! A glTF file once read, and the scene that it is at a moment.
//!
//! Meshes that nothing bends stand in every scene as they were read; each node that shows a bent one gets a mesh of its
//! own, after those. All of it on the host: a posed scene is a plain one.
//!
//! **What all moments share.** The meshes, their vertices, their triangles and the draws are the same in number and
//! order at any two moments, so that vertex `i` of mesh `m` of one moment is where that of the other went. For that a
//! draw that moves stays in the scene where its transform flattens it: it shrinks to nothing there. Only the corners of a
//! triangle stand in another order where joints mirror it. Cameras and lights stand in the order of their nodes, but one
//! that has no direction at a moment is left out there.

use std::path::{Path, PathBuf};

use gltf::Document;

use super::animations;
use super::bodies::{self, Bodies, Shapes};
use super::buffers::Buffers;
use super::document::Parsed;
use super::materials::{self, Materials};
use super::nodes::Hierarchy;
use super::source::Source;
use super::{cameras, deform, document, images, label, lights, marks, primitives};
use crate::error::{Error, Result};
use crate::progress::Stage;
use crate::scene::animation::AnimationChoice;
use crate::scene::gltf::motion::Channel;
use crate::scene::{Bounds, Camera, Facing, Light, Mesh, Scene};

/// Stands in the hash for how a file becomes a scene; a change that alters scenes alters this line.
const IMPORT_SETTINGS: &[u8] =
    b"quincunx glTF import 5: posed, COLOR_0, two UV sets, flat normals, MikkTSpace at rest, BLEND in connected parts";

/// Number of equal parts of the animations' duration at which the scene's bounds are taken.
const REACH_PARTS: u32 = 16;

/// A glTF file: what no moment changes, and what moves and bends.
#[derive(Debug)]
pub struct Model {
    path: PathBuf,
    document: Document,
    /// Hash of the bytes, the import settings, and the animations that play.
    hasher: blake3::Hasher,
    hierarchy: Hierarchy,
    channels: Vec<Channel>,
    bodies: Bodies,
    /// Without what bends, draws, lights and cameras.
    still: Scene,
}

/// What a moment adds to `Model::still`.
struct Moment {
    hash: String,
    shapes: Shapes,
    lights: Vec<Light>,
    cameras: Vec<Camera>,
    warnings: Vec<String>,
}

impl Model {
    /// Reads a .gltf or .glb file with its buffers and images.
    ///
    /// External files must lie in the file's folder or below it. Errors: a broken file, by file and element; no such
    /// animation (exit code 2).
    pub fn open(path: &Path, choice: &AnimationChoice) -> Result<Self> {
        Self::read(path, choice).map_err(|error| error.within(path.display()))
    }

    fn read(path: &Path, choice: &AnimationChoice) -> Result<Self> {
        let stage = Stage::begin("reading the file");
        let source = Source::open(path)?;
        let Parsed { document, mut warnings } = document::parse(source.json())?;

        let mut hasher = blake3::Hasher::new();
        hasher.update(source.bytes());
        let buffers = Buffers::read(&document, &source, &mut hasher)?;
        let Materials { mut materials, textures, image_indices } = materials::read(&document, &mut warnings)?;
        let images = images::read(&document, &image_indices, &source, &buffers, &mut hasher)?;
        hasher.update(IMPORT_SETTINGS);
        drop(stage);

        let _stage = Stage::begin("reading meshes");
        let hierarchy = Hierarchy::read(&document)?;
        let channels = animations::read(&document, &hierarchy, &buffers, choice, &mut warnings)?;
        if !channels.is_empty() {
            hasher.update(format!("{choice:?}").as_bytes());
        }
        deform::check_total(&document, &hierarchy, &buffers)?;
        let shown = bodies::shown(&document, &hierarchy)?;
        let pieces = primitives::read(&document, &shown, &buffers, &mut materials, &mut warnings)?;
        let (meshes, bodies) = Bodies::new(&document, &hierarchy, &channels, &buffers, pieces)?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let nodes = marks::nodes(&document)?;
        let still = Scene { name, nodes, meshes, materials, textures, images, warnings, ..Scene::default() };
        let mut model = Self { path: path.to_owned(), document, hasher, hierarchy, channels, bodies, still };
        if !model.channels.is_empty() {
            model.still.reach = Some(model.reach()?);
            model.still.facing = Some(model.facing()?);
        }
        Ok(model)
    }

    /// The scene at `time_s`, seconds, at least 0. Its hash covers the time where an animation plays.
    ///
    /// Errors: something leaves the range of 32-bit floats then (exit code 2).
    pub fn pose(&self, time_s: f64) -> Result<Scene> {
        Ok(self.moment(time_s)?.onto(self.still.clone()))
    }

    /// `pose` of a model that is not needed any more: pictures and meshes move into the scene instead of being copied.
    ///
    /// Errors: as `pose`.
    pub fn into_pose(self, time_s: f64) -> Result<Scene> {
        Ok(self.moment(time_s)?.onto(self.still))
    }

    fn moment(&self, time_s: f64) -> Result<Moment> {
        self.moment_within(time_s).map_err(|error| error.within(self.path.display()))
    }

    fn moment_within(&self, time_s: f64) -> Result<Moment> {
        let mut warnings = Vec::new();
        let placed = self.hierarchy.place(&self.document, &self.channels, time_s)?;
        let lights = lights::read(&self.document, &placed, &mut warnings)?;
        let cameras = cameras::read(&self.document, &placed, &mut warnings)?;
        let shapes = self.bodies.shapes(&self.document, &self.channels, &placed, time_s)?;
        if let Some(first) = shapes.flat.first() {
            warnings.push(format!(
                "{} drawn by a transform that flattens it to nothing or scales it beyond 32-bit floats: {}{}; \
                 left out",
                label::count(shapes.flat.len(), "mesh is", "meshes are"),
                label::node(&self.document, *first),
                if shapes.flat.len() > 1 { " and others" } else { "" },
            ));
        }
        require_near(&self.bounds(&shapes))?;
        let mut hasher = self.hasher.clone();
        if !self.channels.is_empty() {
            hasher.update(&time_s.to_le_bytes());
        }
        Ok(Moment { hash: hasher.finalize().to_hex().to_string(), shapes, lights, cameras, warnings })
    }

    fn bounds(&self, shapes: &Shapes) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        for draw in &shapes.draws {
            draw.extend(self.mesh(shapes, draw.mesh), &mut bounds);
        }
        bounds
    }

    /// The mesh of this index in the scene that has `shapes`.
    fn mesh<'a>(&'a self, shapes: &'a Shapes, index: usize) -> &'a Mesh {
        let still = &self.still.meshes;
        still.get(index).unwrap_or_else(|| &shapes.meshes[index - still.len()])
    }

    fn shapes_at(&self, time_s: f64) -> Result<Shapes> {
        let placed = self.hierarchy.place(&self.document, &self.channels, time_s)?;
        self.bodies.shapes(&self.document, &self.channels, &placed, time_s)
    }

    /// Which way front faces look when the animations begin.
    fn facing(&self) -> Result<Facing> {
        let shapes = self.shapes_at(0.0)?;
        let mut facing = Facing::default();
        for draw in &shapes.draws {
            let mesh = self.mesh(&shapes, draw.mesh);
            facing.include(draw, mesh, &self.still.materials[mesh.material]);
        }
        Ok(facing)
    }

    /// Where the scene reaches while its animations play.
    fn reach(&self) -> Result<Bounds> {
        let end_s = self.channels.iter().map(|channel| f64::from(channel.curve.end_s())).fold(0.0, f64::max);
        let mut reach = Bounds::EMPTY;
        for part in 0..=REACH_PARTS {
            let time_s = end_s * f64::from(part) / f64::from(REACH_PARTS);
            let bounds = self.bounds(&self.shapes_at(time_s)?);
            if !bounds.is_empty() {
                reach.include(bounds.min);
                reach.include(bounds.max);
            }
        }
        require_near(&reach)?;
        Ok(reach)
    }
}

/// Errors: the diagonal leaves the range of 32-bit floats (exit code 2).
fn require_near(bounds: &Bounds) -> Result<()> {
    if bounds.is_empty() || bounds.diagonal().is_finite() {
        return Ok(());
    }
    Err(Error::request(format!(
        "the scene reaches from {} to {}, too far for 32-bit floats; scale it down",
        bounds.min, bounds.max
    )))
}

impl Moment {
    fn onto(self, still: Scene) -> Scene {
        let mut scene = Scene { hash: self.hash, lights: self.lights, cameras: self.cameras, ..still };
        scene.meshes.extend(self.shapes.meshes);
        scene.draws = self.shapes.draws;
        scene.draw_nodes = self.shapes.draw_nodes;
        scene.warnings.extend(self.warnings);
        scene
    }
}
