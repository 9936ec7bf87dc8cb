//! What the shadow maps of virtual lights draw: the faces that the picture can ask, and what may cast shadows in them.

use super::held::VplMaps;
use super::reach::Reach;
use super::unrolled;
use crate::error::{Error, Result};
use crate::frame::View;
use crate::gpu::shader::structs::{VplBlock, VplMapBlock};
use crate::gpu::{Access, Buffer, Gpu, upload};
use crate::resident::coarse::CoarseMeshes;
use crate::resident::{Casters, ClusterBoxes, SceneGpu};
use crate::scene::{Bounds, Scene};
use crate::settings::GeometryChoice;
use glam::Vec3;
use std::sync::Arc;

/// Draws of all maps together, at most: each is recorded.
const MOST_DRAWS: usize = 1 << 22;

/// Surfaces are off their boxes by this part of the scene's diagonal, or of the greatest coordinate, whichever is more: halves have
/// eleven bits.
const SLACK: [f32; 2] = [1e-4, 1.0 / 1024.0];

/// A face that is drawn.
pub struct FaceDraws {
    pub index: u32,
    pub casters: Casters,
}

/// All of some lights' maps.
pub struct MapDraws {
    /// The faces of each light's map that the picture can ask.
    pub faces: Vec<Vec<FaceDraws>>,
    /// Each light's faces' matrices, and what the finding shader reads of each light.
    clips: Vec<[[f32; 4]; 4]>,
    blocks: Vec<VplMapBlock>,
}

impl MapDraws {
    /// Errors: more draws than can be recorded (exit code 4).
    pub fn of(
        maps: &VplMaps,
        scene: &Scene,
        view: &View,
        resident: &SceneGpu,
        coarse: &CoarseMeshes,
        vpls: &[VplBlock],
    ) -> Result<Self> {
        let atlas = maps.atlas;
        let bounds = box_of(scene);
        let (mut clips, mut faces, mut draw_count) = (Vec::new(), Vec::new(), 0);
        let boxes = ClusterBoxes::new(scene, resident, coarse, view);
        let extreme = bounds.min.abs().max(bounds.max.abs()).max_element();
        let slack_m = (SLACK[0] * bounds.diagonal()).max(SLACK[1] * extreme);
        for vpl in vpls {
            let all = atlas.faces(vpl, &bounds);
            clips.extend(all.iter().map(|face| face.clip_from_world.to_cols_array_2d()));
            let drawn: Vec<FaceDraws> = (0..)
                .zip(&all)
                .filter_map(|(index, face)| {
                    if maps.casters == GeometryChoice::All {
                        return Some(FaceDraws { index, casters: boxes.list(|_| true, |_| 0.0) });
                    }
                    let reach = Reach::of(vpl, face);
                    let is_asked = is_bright(vpl) && boxes.seen().iter().any(|seen| reach.may_hold(seen, slack_m));
                    let texel_m = |bounds: &Bounds| reach.least_texel_m(bounds, atlas.size_px);
                    let casters = || {
                        boxes.list(|bounds| reach.may_hold(bounds, slack_m), |bounds| maps.detail_px * texel_m(bounds))
                    };
                    is_asked.then(|| FaceDraws { index, casters: casters() })
                })
                .collect();
            draw_count += drawn.iter().map(|face| face.casters.draw_count()).sum::<usize>();
            if draw_count > MOST_DRAWS {
                let done = faces.len() + 1;
                return Err(Error::memory(format!(
                    "--vpl-shadow map: the maps of the first {done} virtual lights of {} take {draw_count} draws, and at most \
                     {MOST_DRAWS} are recorded",
                    vpls.len()
                ))
                .note("fewer --vpls, or --vpl-shadow ray, which draws nothing"));
            }
            faces.push(drawn);
        }
        let blocks = vpls.iter().map(|vpl| unrolled::block(vpl, &bounds)).collect();
        Ok(Self { faces, clips, blocks })
    }

    /// Errors: memory for the staging buffer (exit code 4).
    pub fn upload(&self, gpu: &Arc<Gpu>, views: &Buffer, blocks: &Buffer) -> Result<()> {
        upload::buffer(gpu, views, bytemuck::cast_slice(&self.clips), Access::GraphicsRead)?;
        upload::buffer(gpu, blocks, bytemuck::cast_slice(&self.blocks), Access::ComputeRead)
    }
}

/// A light that walks have not found is dark.
fn is_bright(vpl: &VplBlock) -> bool {
    vpl.intensity[..3].iter().any(|channel| *channel > 0.0)
}

/// What casts shadows; a point where nothing does.
fn box_of(scene: &Scene) -> Bounds {
    match scene.bounds() {
        bounds if bounds.is_empty() => Bounds { min: Vec3::ZERO, max: Vec3::ZERO },
        bounds => bounds,
    }
}
