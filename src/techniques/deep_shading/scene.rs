//! What the technique's shaders read of the scene: the resident buffers, where it is when the shutter closes, its lights in the
//! middle, the cameras and the tuples.

use super::choices::Choices;
use crate::error::Result;
use crate::gpu::{Access, AccessSet, Bound, Buffer, Commands, Edge, Gpu, upload};
use crate::passes::direct::{self, DirectGpu};
use crate::passes::shadow_maps::ShadowMaps;
use crate::plan::Resources;
use crate::resident::{Pose, SceneGpu, draw_blocks, geometry};
use crate::scene::Scene;
use crate::techniques::Inputs;
use crate::techniques::deep_shading::eyes::seen_from;
use crate::techniques::deep_shading::resources::{NAME, full};
use std::sync::Arc;

/// Buffers beside the resident ones.
pub struct DeepScene {
    direct: DirectGpu,
    tuples: Buffer,
    space: Buffer,
    middle: Buffer,
    close_positions: Buffer,
    close_attributes: Buffer,
    close_draws: Buffer,
    maps: Option<ShadowMaps>,
    /// The scene in the middle of the exposure, where shadow maps are drawn and something moves.
    casters: Option<SceneGpu>,
}

/// A moment of the scene as buffers hold it; empty where there is no such moment.
#[derive(Default)]
struct MomentBytes {
    positions: Vec<u8>,
    attributes: Vec<u8>,
    draws: Vec<u8>,
}

impl MomentBytes {
    fn of(scene: &Scene) -> Self {
        Self {
            positions: bytemuck::cast_slice(&geometry::positions(scene)).to_vec(),
            attributes: bytemuck::cast_slice(&geometry::attributes(scene)).to_vec(),
            draws: bytemuck::cast_slice(&draw_blocks(scene)).to_vec(),
        }
    }
}

impl DeepScene {
    /// Fills the planned buffers.
    ///
    /// Errors: as of the scene's cameras and lights; memory for the uploads (exit code 4).
    pub fn new(
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        resources: &mut Resources,
        choices: &Choices,
        scene: &SceneGpu,
    ) -> Result<Self> {
        let moved = choices.blur.mid_exposure.as_ref();
        let lights = direct::light_blocks(choices.lights(inputs), inputs.values);
        let bounds = inputs.scene.bounds();
        let background = inputs.values.color("background");
        let open = inputs.view.block(&bounds, background, inputs.lights.ambient, lights.len() as u32, 0);
        let middle = moved.map_or(open, |moved| moved.frame(inputs, &open));
        let middle = seen_from(middle, choices.blur.lens);
        let tree = choices.direct.tree(inputs.bvh, inputs.scene)?;
        let direct = DirectGpu::new(gpu, resources, NAME, &lights, false, tree)?;
        let seed = inputs.values.integer("seed") as u32;
        let eyes = choices.eyes();
        let tuples: Vec<_> =
            (0..choices.run_count).flat_map(|run| choices.table.tuples(inputs.view.extent, seed, run, &eyes)).collect();
        let space = choices.deep_block(inputs);
        let close = inputs.scene.closing.as_deref().map(MomentBytes::of).unwrap_or_default();
        let maps = choices.maps.as_ref().map(|layout| {
            let posed = moved.map_or(inputs.scene, |moved| &moved.scene);
            ShadowMaps::new(gpu, resources, NAME, layout, posed, scene)
        });
        let maps = maps.transpose()?;
        let mut sent = |what: &str, bytes: &[u8], accesses: AccessSet| -> Result<Buffer> {
            let buffer = resources.buffer(&full(what));
            upload::buffer(gpu, &buffer, bytes, accesses)?;
            Ok(buffer)
        };
        let casters = match moved.filter(|_| maps.is_some()) {
            None => None,
            Some(moved) => {
                let MomentBytes { positions, draws, .. } = MomentBytes::of(&moved.scene);
                let positions = Arc::new(sent("middle.positions", &positions, Access::VertexRead.into())?);
                let draws = Arc::new(sent("middle.draws", &draws, Access::GraphicsRead.into())?);
                Some(scene.posed(Pose { positions, draws, attributes: scene.pose.attributes.clone() }))
            }
        };
        let mut filled = |what: &str, bytes: &[u8]| sent(what, bytes, Access::ComputeRead | Access::GraphicsRead);
        Ok(Self {
            tuples: filled("tuples", bytemuck::cast_slice(&tuples))?,
            space: filled("space", bytemuck::bytes_of(&space))?,
            middle: filled("middle", bytemuck::bytes_of(&middle))?,
            close_positions: filled("close.positions", &close.positions)?,
            close_attributes: filled("close.attributes", &close.attributes)?,
            close_draws: filled("close.draws", &close.draws)?,
            maps,
            casters,
            direct,
        })
    }

    /// Draws the shadow maps, where lights have some that every frame draws.
    pub fn record_maps(&self, cmd: &mut Commands, scene: &SceneGpu) -> Result<()> {
        self.maps.as_ref().map_or(Ok(()), |maps| maps.record(cmd, NAME, self.casters_of(scene)))
    }

    /// Draws those that are drawn once: the pass, and how long it took, nanoseconds.
    ///
    /// Errors: the device is lost or out of memory (exit code 4).
    pub fn draw_maps_once(&self, gpu: &Arc<Gpu>, scene: &SceneGpu) -> Result<Option<(String, u64)>> {
        self.maps.as_ref().map_or(Ok(None), |maps| maps.draw_once(gpu, NAME, self.casters_of(scene)))
    }

    fn casters_of<'a>(&'a self, scene: &'a SceneGpu) -> &'a SceneGpu {
        self.casters.as_ref().unwrap_or(scene)
    }

    /// The shadow maps, and the access that touched them last.
    pub fn maps_from(&self, access: Access) -> Option<Edge<'_, ShadowMaps>> {
        self.maps.as_ref().map(|maps| maps.from(access))
    }

    /// Everything that a shader of the technique may read of it, by name.
    pub fn bound<'a>(&'a self, frame: &'a Buffer, scene: &'a SceneGpu) -> Vec<(&'static str, Bound<'a>)> {
        let mut bound = vec![
            ("Frame", Bound::Buffer(frame)),
            ("Middle", Bound::Buffer(&self.middle)),
            ("Draws", Bound::Buffer(&scene.pose.draws)),
            ("Deep", Bound::Buffer(&self.space)),
            ("Tuples", Bound::Buffer(&self.tuples)),
            ("Indices", Bound::Buffer(&scene.indices)),
            ("Positions", Bound::Buffer(&scene.pose.positions)),
            ("Attributes", Bound::Buffer(&scene.pose.attributes)),
            ("ClosePositions", Bound::Buffer(&self.close_positions)),
            ("CloseAttributes", Bound::Buffer(&self.close_attributes)),
            ("CloseDraws", Bound::Buffer(&self.close_draws)),
        ];
        bound.extend(self.direct.bound());
        bound.extend(self.maps.iter().flat_map(ShadowMaps::bound));
        if let Some(extended) = &scene.extended {
            bound.push(("ExtendedAttributes", Bound::Buffer(&extended.attributes)));
            bound.push(("Placements", Bound::Buffer(&extended.placements)));
        }
        bound
    }
}
