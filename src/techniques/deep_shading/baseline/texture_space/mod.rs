//! Baseline `--shading texture-space`: Andersson, Hasselgren, Toth and Akenine-Moller 2014, "Adaptive Texture Space Shading for
//! Stochastic Rendering", as far as Clarberg and Munkberg 2014 say what it does (sections 2 and 6, figure 9). Of each draw call a
//! sparse hierarchy of shading values is drawn into a texture by conservative rasterisation, which then is the draw's colour
//! where tuples see it; the next draw call begins with an empty one. Draws share a pool of such textures, one after the
//! other. reads   the scene, its lights, the tuples
//! writes  texture_space.textures.N, .owners.N, .touched.N   buffers of the pool (pool.rs)
//!         texture_space.atlas, texture_space.charts         buffers, 8 B a vertex and 4 B a triangle, made once
//!         baseline.colors, baseline.depth                   as supersampling has them
//!
//! Our reading, where what we know of the paper leaves a choice
//! - a triangle is shaded at one level, at which texels are as large as pixels of canonical shading space (`--shading-scale`), and
//!   read there bilinearly: no level is interpolated
//! - a texel is shaded once, though triangles share it: owners claim it first. It is shaded at its middle, or at the place of its
//!   owner that is nearest to that
//! - nothing is shaded of triangles that no sample can see by their place or side; what other draws hide is shaded, as the paper says
//! - neighbours in the atlas that are none on the surface keep out of each other's look-ups (lookup.glsl); samples that have
//!   nothing else are counted (`samples_of_other_charts`)
//!
//! Equal to `--shading ssaa` where triangles of a draw have one colour.

pub mod apply;
pub mod atlases;
pub mod claim;
pub mod hull;
pub mod pool;
pub mod shade;

use super::super::choices::Choices;
use super::super::visibility::sample::{PipelineSets, TupleDraws};
use crate::error::Result;
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu, upload};
use crate::plan::{Plan, Resources};
use crate::resident::{DrawList, SceneGpu};
use crate::techniques::Inputs;
use crate::techniques::deep_shading::modes::pool_size::PoolSize;
use crate::techniques::deep_shading::pass_inputs::DrawInputs;
use crate::techniques::deep_shading::resources::full;
use ash::vk;
use atlases::Atlases;
use hull::Hulls;
use pool::Pool;
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

const ATLAS: &str = "texture_space.atlas";
const CHARTS: &str = "texture_space.charts";

/// Buffers beside those of the frame's samples. `is_counted`: `PoolSize::plan`.
pub fn plan(plan: &mut Plan, size: PoolSize, is_counted: bool, inputs: &Inputs<'_>) {
    size.plan(plan, is_counted);
    plan.buffer("scene.geometry", full(ATLAS), inputs.stats.vertex_count * 8);
    plan.buffer("scene.geometry", full(CHARTS), inputs.stats.index_count / 3 * 4);
}

/// Draws by themselves, in the order in which `list` begins with each.
fn draws_of(list: &DrawList) -> Vec<DrawList> {
    let mut draws: Vec<DrawList> = Vec::new();
    let mut places: HashMap<u32, usize> = HashMap::new();
    let solid = list.opaque.iter().map(|call| (call, false));
    for (call, is_tested) in solid.chain(list.mask.iter().map(|call| (call, true))) {
        let place = *places.entry(call.draw).or_insert_with(|| {
            draws.push(DrawList::default());
            draws.len() - 1
        });
        let own = if is_tested { &mut draws[place].mask } else { &mut draws[place].opaque };
        own.push(*call);
    }
    draws
}

/// Bindings of draws with one texture.
struct SlotSets {
    claim: Option<vk::DescriptorSet>,
    shade: Option<vk::DescriptorSet>,
    apply: PipelineSets,
}

pub struct TextureSpace {
    pool: Pool,
    claim: Hulls,
    shade: Hulls,
    atlas: Buffer,
    charts: Buffer,
}

impl TextureSpace {
    /// Fills the planned buffers of the atlas.
    ///
    /// Errors: memory for the uploads (exit code 4).
    pub fn new(
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        scene: &SceneGpu,
        choices: &Choices,
        size: PoolSize,
        atlases: &Atlases,
    ) -> Result<Self> {
        let mut filled = |name: &str, bytes: &[u8]| -> Result<Buffer> {
            let buffer = resources.buffer(&full(name));
            upload::buffer(gpu, &buffer, bytes, Access::GraphicsRead)?;
            Ok(buffer)
        };
        Ok(Self {
            atlas: filled(ATLAS, bytemuck::cast_slice(&atlases.coordinates))?,
            charts: filled(CHARTS, bytemuck::cast_slice(&atlases.charts))?,
            pool: Pool::new(resources, size),
            claim: Hulls::new(gpu, scene, choices, size.side_px, claim::FRAGMENT)?,
            shade: Hulls::new(gpu, scene, choices, size.side_px, shade::fragment(scene, choices))?,
        })
    }

    /// All draws, as many at a time as there are textures: claimed, shaded, and then drawn by `draw`, which gets them
    /// with the sets that `tuple_draws` binds for each and whether they are the first.
    ///
    /// Errors: the driver has no more room for sets (exit code 4).
    pub fn record(
        &self,
        cmd: &mut Commands,
        inputs: DrawInputs<'_>,
        tuple_draws: &TupleDraws,
        mut draw: impl FnMut(&mut Commands, &[(&DrawList, &PipelineSets)], bool),
    ) -> Result<()> {
        let mut sets = Vec::new();
        for texture in self.pool.bound() {
            let own = [("Atlas", Bound::Buffer(&self.atlas)), ("Charts", Bound::Buffer(&self.charts))];
            let bound: Vec<_> = inputs.bound.iter().copied().chain(own).chain(texture).collect();
            sets.push(SlotSets {
                claim: self.claim.set(cmd, &bound)?,
                shade: self.shade.set(cmd, &bound)?,
                apply: tuple_draws.sets(cmd, &bound)?,
            });
        }
        let [claims, shades] = [|set: &SlotSets| set.claim, |set: &SlotSets| set.shade]
            .map(|of: fn(&SlotSets) -> Option<vk::DescriptorSet>| sets.iter().map(of).collect::<Vec<_>>());
        let draws = draws_of(inputs.list);
        // Where nothing is drawn layers are still to be cleared.
        let chunk_count = draws.len().div_ceil(self.pool.len()).max(1);
        for chunk_index in 0..chunk_count {
            let is_first = chunk_index == 0;
            let chunk = draws.chunks(self.pool.len()).nth(chunk_index).unwrap_or_default();
            self.pool.begin(cmd, chunk.len(), is_first);
            self.claim.draw(cmd, inputs, chunk, &claims);
            self.pool.claimed(cmd, is_first);
            self.shade.draw(cmd, inputs, chunk, &shades);
            self.pool.shaded(cmd);
            let lists: Vec<_> = chunk.iter().zip(sets.iter().map(|set| &set.apply)).collect();
            draw(cmd, &lists, is_first);
        }
        Ok(())
    }

    /// Bytes of the pool that a frame of `list` touches (`Pool::touched_bytes`).
    ///
    /// Errors: memory for reading the counts back (exit code 4).
    pub fn touched_bytes(&self, gpu: &Arc<Gpu>, list: &DrawList) -> Result<BTreeMap<String, u64>> {
        self.pool.touched_bytes(gpu, draws_of(list).len())
    }

    /// Bytes of texels' owners that claims write.
    pub fn owner_bytes(&self, inputs: DrawInputs<'_>) -> u64 {
        draws_of(inputs.list).len() as u64 * self.pool.owner_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::resident::{DrawCall, Geometry};
    use crate::scene::procedural;

    #[test]
    fn draws_keep_the_order_in_which_the_list_begins_with_them() {
        let scene = procedural::build("lamps:objects=3", 1).unwrap().unwrap();
        let calls = Geometry::of(&scene).calls(&scene);
        let [a, b, c] = [0, 1, 2].map(|index| calls[index]);
        let later = |call: DrawCall| DrawCall { first_index: call.first_index + 3, ..call };
        let list = DrawList { opaque: vec![b, a, later(b)], mask: vec![c, later(c)], ..DrawList::default() };
        let draws = draws_of(&list);
        let firsts = |calls: &[DrawCall]| calls.iter().map(|call| (call.draw, call.first_index)).collect::<Vec<_>>();
        let expected = [vec![b, later(b)], vec![a], vec![c, later(c)]];
        for (draw, expected) in draws.iter().zip(&expected) {
            let (own, other) =
                if expected[0].draw == c.draw { (&draw.mask, &draw.opaque) } else { (&draw.opaque, &draw.mask) };
            assert_eq!((firsts(own), other.len()), (firsts(expected), 0));
        }
        assert_eq!(draws.len(), 3);
    }
}
