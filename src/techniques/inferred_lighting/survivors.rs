//! Which BLEND draws the geometry pass left texels of: the others are lit by whatever lies where theirs would be. Kircher
//! 2009, section 4.
//!
//! A texel of the DSF buffer holds 8 bits of an object's id, which is of one draw where boxes touch, and of several elsewhere:
//! among the draws of the texel's layer it is of the one in whose box its place lies. What it says of its place is rounded,
//! so the box is widened by that.

use super::encoding::Packing;
use super::stipple::StippledDraw;
use crate::frame::View;
use crate::sampling::pattern::Pattern;
use crate::scene::{Bounds, Scene, object_ids};
use crate::units::Extent;
use glam::{Mat4, Vec2, Vec3};
use std::collections::{BTreeMap, BTreeSet};

/// A BLEND draw that reaches into the screen.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    layer: u32,
    object_id: u8,
    /// World space.
    bounds: Bounds,
}

/// The BLEND draws on the screen, and what a texel's place is found by.
pub struct Survivors {
    candidates: Vec<Candidate>,
    world_from_clip: Mat4,
    eye_ws: Vec3,
    forward_ws: Vec3,
    stipple: Pattern,
    packing: Packing,
    depth_range_m: [f32; 2],
}

/// What a frame left of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StippleCounts {
    /// Layers of which some draw has a texel.
    pub layers: usize,
    /// Draws that have a texel.
    pub draws: usize,
    /// Draws on the screen that have none.
    pub unlit_draws: usize,
}

impl Survivors {
    /// `depth_range_m`: linear depth of the first step, and of all of them.
    pub fn new(
        scene: &Scene,
        view: &View,
        stippled: &[StippledDraw],
        stipple: Pattern,
        packing: Packing,
        depth_range_m: [f32; 2],
    ) -> Self {
        let on_screen: Vec<&StippledDraw> = stippled.iter().filter(|stippled| stippled.is_on_screen).collect();
        // A scene without them need not be searched.
        let ids = if on_screen.is_empty() { Vec::new() } else { object_ids::of(scene) };
        let candidate = |stippled: &StippledDraw| {
            let draw = &scene.draws[stippled.call.draw as usize];
            let bounds = draw.bounds(&scene.meshes[draw.mesh]);
            Candidate { layer: stippled.layer, object_id: ids[stippled.call.draw as usize], bounds }
        };
        Self {
            candidates: on_screen.into_iter().map(candidate).collect(),
            world_from_clip: view.clip_from_world().inverse(),
            eye_ws: view.eye(),
            forward_ws: -view.camera.world_from_view.z_axis.truncate(),
            stipple,
            packing,
            depth_range_m,
        }
    }

    /// Counts by the DSF `words` of a light buffer of `extent`, row-major.
    pub fn count(&self, words: impl Iterator<Item = u32>, extent: Extent) -> StippleCounts {
        let mut of_layer: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (index, candidate) in self.candidates.iter().enumerate() {
            of_layer.entry(candidate.layer).or_default().push(index);
        }
        let mut lit = BTreeSet::new();
        for (index, word) in words.enumerate() {
            let (x, y) = (index as u32 % extent.width, index as u32 / extent.width);
            let rivals = self.stipple.subset_of([x, y]).and_then(|layer| of_layer.get(&layer));
            let Some(rivals) = rivals else { continue };
            let Some(depth_m) = self.packing.depth_m(word, self.depth_range_m) else { continue };
            let mut same = rivals.iter().filter(|rival| self.may_be(word, &self.candidates[**rival])).peekable();
            if same.peek().is_some() {
                let (place, slack_m) = self.place(x, y, extent, depth_m);
                let away = |rival: &usize| distance(&self.candidates[*rival].bounds, place);
                let nearest = same.min_by(|a, b| away(a).total_cmp(&away(b)));
                lit.extend(nearest.filter(|rival| away(rival) <= slack_m));
            }
        }
        let layers: BTreeSet<u32> = lit.iter().map(|index: &usize| self.candidates[*index].layer).collect();
        StippleCounts { layers: layers.len(), draws: lit.len(), unlit_draws: self.candidates.len() - lit.len() }
    }

    /// Whether the word has an id of the draw.
    fn may_be(&self, word: u32, candidate: &Candidate) -> bool {
        let first = u32::from(candidate.object_id) << 8;
        let codes = self.packing.id_code(first)..=self.packing.id_code(first | 0xff);
        codes.contains(&(word >> 16))
    }

    /// Where in the world a texel's middle is at `depth_m`, and by how many metres that may be off.
    fn place(&self, x: u32, y: u32, extent: Extent, depth_m: f32) -> (Vec3, f32) {
        let middle = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / Vec2::new(extent.width as f32, extent.height as f32);
        let ndc = 2.0 * middle - 1.0;
        // The depth's own scale is no matter: any two places of the ray do.
        let [near, far] = [1.0, 0.5].map(|z| self.world_from_clip.project_point3(ndc.extend(z)));
        let along = far - near;
        let place = near + along * ((depth_m - (near - self.eye_ws).dot(self.forward_ws)) / along.dot(self.forward_ws));
        let slant = along.length() / along.dot(self.forward_ws).abs();
        // Half a step of depth, twice for safety, and what 32 bits leave of a place so far away.
        let step_m = self.packing.depth_step_m(self.depth_range_m);
        (place, slant * step_m + 1e-4 * depth_m.abs().max(place.length()))
    }
}

/// From a place to a box, metres; 0 inside.
fn distance(bounds: &Bounds, place: Vec3) -> f32 {
    (place - place.clamp(bounds.min, bounds.max)).length()
}
