//! What full shading of punctual lights needs on the device: the list of lights, the tree for shadow rays, the
//! constants of composite.glsl. Deferred shading and the composite hold one each.

use crate::bvh::flat::flattened;
use crate::bvh::{Bvh, LazyBvh};
use crate::caps::{Ability, Caps, Need};
use crate::error::Result;
use crate::gpu::shader::shading::light::LIGHT_PATCH;
use crate::gpu::shader::structs::{BvhNodeBlock, BvhTriangleBlock, LightBlock};
use crate::gpu::{Access, Barrier, Bound, Buffer, Edge, Gpu, upload};
use crate::lights::LightSet;
use crate::passes::cull;
use crate::passes::texels::{LightLoad, Texels};
use crate::passes::workgroup::workgroup;
use crate::plan::{Plan, Resources};
use crate::scene::{Material, Scene};
use crate::settings::{Brdf, CullBy, CullChoice, DirectShadow, PositionStorage, Values};
use crate::shading::light;
use crate::units::Extent;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What `--direct-shadow` comes to under `lights`: `none` where no light is one that would cast.
fn shadow(values: &Values, lights: &LightSet) -> DirectShadow {
    match values.choice("direct-shadow") {
        DirectShadow::Sun if lights.sun_count() == 0 => DirectShadow::None,
        _ if lights.lights.is_empty() => DirectShadow::None,
        asked => asked,
    }
}

/// What shadow rays of every light need that start at positions from depth (`--position depth`). Where corners snap to
/// 1/16 pixel, a small picture's depths are farther below their surfaces than rays start above them, and the lit surface
/// shadows itself: of `cornell` at 61x37 a tenth of the light was missing on such a driver.
pub fn depth_rays(values: &Values) -> Option<Need> {
    values.is("position", PositionStorage::Depth).then(|| Need {
        of: "--position depth with shadow rays".to_owned(),
        ability: Ability::FineCorners,
        instead: "--position float, half and unorm16 hold positions as they are",
    })
}

/// The same of a technique that has `--direct-shadow`.
pub fn needs(values: &Values) -> Option<Need> {
    depth_rays(values).filter(|_| values.is("direct-shadow", DirectShadow::Ray))
}

/// What the settings say of direct light, wherever it is shaded.
#[derive(Clone, Debug)]
pub struct DirectSettings {
    pub brdf: Brdf,
    pub shadow: DirectShadow,
    /// Directional lights of the scene.
    sun_count: u64,
    /// Metres that a shadow ray starts off its surface.
    pub ray_offset: f32,
    /// Whether a drawn material has `Material::has_extras`.
    pub extras: bool,
    /// A bit for each kind of light that is there (`light::kinds`).
    kinds: u32,
}

/// Shadow rays start this part of the scene's diagonal off their surface: more than positions of 16 bits are off by.
const RAY_OFFSET: f32 = 1e-4;

impl DirectSettings {
    /// Reads `--brdf` and `--direct-shadow`.
    pub fn new(values: &Values, lights: &LightSet, scene: &Scene) -> Self {
        Self::with(values.choice("brdf"), shadow(values, lights), lights, scene)
    }

    /// The same of a technique whose settings leave neither open.
    pub fn with(brdf: Brdf, shadow: DirectShadow, lights: &LightSet, scene: &Scene) -> Self {
        Self {
            brdf,
            shadow,
            sun_count: lights.sun_count() as u64,
            ray_offset: RAY_OFFSET * scene.lasting_bounds().diagonal().max(1e-6),
            extras: scene.drawn_materials().any(Material::has_extras),
            kinds: light::kinds(&lights.lights),
        }
    }

    /// Some lights are patches of larger ones (LIGHT_PATCH of light.glsl).
    pub fn add_patches(&mut self) {
        self.kinds |= 1 << LIGHT_PATCH;
    }

    /// What `light_count` of the punctual lights ask of a pixel.
    pub fn load(&self, light_count: usize) -> LightLoad {
        let light_count = light_count as u64;
        let casting_count = match self.shadow {
            DirectShadow::None | DirectShadow::Map => 0,
            DirectShadow::Sun => self.sun_count.min(light_count),
            DirectShadow::Ray => light_count,
        };
        LightLoad { light_count, casting_count }
    }

    /// DIRECT_SHADOW and RAY_OFFSET.
    pub fn shadow_constants(&self) -> [(&'static str, u32); 2] {
        [("DIRECT_SHADOW", self.shadow as u32), self.offset_constant()]
    }

    /// RAY_OFFSET.
    pub fn offset_constant(&self) -> (&'static str, u32) {
        ("RAY_OFFSET", self.ray_offset.to_bits())
    }

    /// LIGHT_KINDS.
    pub fn kinds_constant(&self) -> (&'static str, u32) {
        ("LIGHT_KINDS", self.kinds)
    }

    /// BRDF_KIND, SURFACE_EXTRAS, LIGHT_KINDS and those of shadows.
    pub fn light_constants(&self) -> [(&'static str, u32); 5] {
        let [shadow, offset] = self.shadow_constants();
        let extras = ("SURFACE_EXTRAS", u32::from(self.extras));
        [("BRDF_KIND", self.brdf as u32), extras, self.kinds_constant(), shadow, offset]
    }

    /// The tree that shadow rays walk: the scene's, or the empty one where no ray is cast.
    pub fn tree<'a>(&self, bvh: &'a LazyBvh, scene: &Scene) -> Result<&'a Bvh> {
        match self.shadow {
            DirectShadow::None | DirectShadow::Map => Ok(bvh.empty()),
            DirectShadow::Sun | DirectShadow::Ray => bvh.over(scene),
        }
    }
}

/// What the settings say of shading with a G-buffer (`settings::SHADING`).
#[derive(Clone, Debug)]
pub struct ShadingSettings {
    pub direct: DirectSettings,
    pub position: PositionStorage,
    pub cull: bool,
    pub cull_by: CullBy,
    pub workgroup: [u32; 2],
    /// Pixels that a thread works on.
    pub texels: Texels,
}

impl ShadingSettings {
    pub fn new(values: &Values, lights: &LightSet, scene: &Scene, caps: &Caps) -> Self {
        let is_tiled = values.is("cull", CullChoice::Tiled);
        Self::with(values, lights, scene, caps, values.choice("position"), is_tiled)
    }

    /// The same, of a technique whose settings say otherwise where positions are and whether there are lists for tiles.
    pub fn with(
        values: &Values,
        lights: &LightSet,
        scene: &Scene,
        caps: &Caps,
        position: PositionStorage,
        cull: bool,
    ) -> Self {
        Self {
            direct: DirectSettings::new(values, lights, scene),
            position,
            cull,
            cull_by: CullBy::new(values, caps),
            workgroup: workgroup(values, caps),
            texels: Texels::new(values, caps),
        }
    }

    /// WORKGROUP_X and WORKGROUP_Y.
    pub fn workgroup_constants(&self) -> [(&'static str, u32); 2] {
        [("WORKGROUP_X", self.workgroup[0]), ("WORKGROUP_Y", self.workgroup[1])]
    }

    /// Threads of a workgroup.
    pub fn lane_count(&self) -> u32 {
        self.workgroup[0] * self.workgroup[1]
    }

    /// Whether lists of lights for tiles are made.
    pub fn culls(&self, light_count: usize) -> bool {
        self.cull && light_count > 0
    }
}

/// Plans the list of lights and the tree, as resources of `technique`.
pub fn plan(plan: &mut Plan, technique: &str, light_count: usize, tree: &Bvh) {
    let bytes = |count: usize, size: usize| count as u64 * size as u64;
    plan.buffer("lights", format!("{technique}.lights"), bytes(light_count, size_of::<LightBlock>()));
    plan.buffer("bvh", format!("{technique}.bvh.nodes"), bytes(tree.nodes.len(), size_of::<BvhNodeBlock>()));
    plan.buffer(
        "bvh",
        format!("{technique}.bvh.triangles"),
        bytes(tree.triangles.len(), size_of::<BvhTriangleBlock>()),
    );
}

/// The same with the masks of `--cull tiled`, where `settings` have it.
pub fn plan_with_masks(
    plan: &mut Plan,
    technique: &str,
    light_count: usize,
    settings: &ShadingSettings,
    tree: &Bvh,
    extent: Extent,
) {
    self::plan(plan, technique, light_count, tree);
    if settings.culls(light_count) {
        cull::plan(plan, technique, extent, light_count as u32);
        // Counted after the frame.
        plan.read_back(&cull::masks(technique, Access::ComputeRead).0);
    }
}

/// The planned buffers, filled.
pub struct DirectGpu {
    pub lights: Buffer,
    pub light_count: u32,
    /// Whether shadow rays walk the tree.
    pub casts_rays: bool,
    pub bvh_nodes: Buffer,
    pub bvh_triangles: Buffer,
    /// With `--cull tiled`, where there are lights.
    pub masks: Option<Buffer>,
}

impl Edge<'_, DirectGpu> {
    /// Masks of `--cull tiled` become readable as `access` says; None without them.
    pub fn masks_to(self, access: Access) -> Option<Barrier> {
        self.resource.masks.as_ref().map(|masks| masks.from(self.from).to(access))
    }
}

impl DirectGpu {
    /// Names the access that touched the masks last; all else is kept as it was uploaded.
    pub fn from(&self, access: Access) -> Edge<'_, Self> {
        Edge { resource: self, from: access.into() }
    }

    /// Uploads `lights` and the tree. `has_masks`: the plan has those of `--cull tiled`.
    pub fn new(
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        technique: &str,
        lights: &[LightBlock],
        has_masks: bool,
        tree: &Bvh,
    ) -> Result<Self> {
        let mut filled = |what: &str, bytes: &[u8]| {
            let buffer = resources.buffer(&format!("{technique}.{what}"));
            // Compute shaders and blended surfaces both read it.
            upload::buffer(gpu, &buffer, bytes, Access::ComputeRead | Access::GraphicsRead)?;
            Ok(buffer)
        };
        Ok(Self {
            lights: filled("lights", bytemuck::cast_slice(lights))?,
            light_count: lights.len() as u32,
            casts_rays: !tree.triangles.is_empty(),
            bvh_nodes: filled("bvh.nodes", bytemuck::cast_slice(&flattened(&tree.nodes)))?,
            bvh_triangles: filled("bvh.triangles", bytemuck::cast_slice(&tree.triangles))?,
            masks: has_masks.then(|| resources.buffer(&format!("{technique}.cull.masks"))),
        })
    }

    /// Bytes that so many threads read of the lights, each of all of them; None where their tiles or the tree decide.
    pub fn read_bytes(&self, threads: u64) -> Option<u64> {
        let is_known = self.masks.is_none() && !self.casts_rays;
        is_known.then(|| threads * u64::from(self.light_count) * size_of::<LightBlock>() as u64)
    }

    /// Other lights, as many as before, for what is recorded next.
    ///
    /// Errors: memory for the upload (exit code 4), here and in `move_triangles`.
    pub fn replace_lights(&self, gpu: &Arc<Gpu>, lights: &[LightBlock]) -> Result<()> {
        upload::buffer(gpu, &self.lights, bytemuck::cast_slice(lights), Access::ComputeRead | Access::GraphicsRead)
    }

    /// The triangles of the tree where they have moved within its boxes.
    pub fn move_triangles(&self, gpu: &Arc<Gpu>, triangles: &[BvhTriangleBlock]) -> Result<()> {
        let readers = Access::ComputeRead | Access::GraphicsRead;
        upload::buffer(gpu, &self.bvh_triangles, bytemuck::cast_slice(triangles), readers)
    }

    /// Counters of the last frame: pixels times punctual lights that were evaluated, and that culling left out.
    ///
    /// Errors: memory for the copy of the masks (exit code 4).
    pub fn counters(&self, gpu: &Arc<Gpu>, extent: Extent) -> Result<BTreeMap<&'static str, f64>> {
        let [evaluated, left_out] = match &self.masks {
            Some(masks) => cull::evaluations(gpu, masks, extent, self.light_count)?,
            None => [extent.pixel_count() * u64::from(self.light_count), 0],
        };
        Ok(BTreeMap::from([("light_evaluations", evaluated as f64), ("light_evaluations_culled", left_out as f64)]))
    }

    /// What composite.glsl binds of it.
    pub fn bound(&self) -> Vec<(&'static str, Bound<'_>)> {
        let mut bound = vec![
            ("Lights", Bound::Buffer(&self.lights)),
            ("BvhNodes", Bound::Buffer(&self.bvh_nodes)),
            ("BvhTriangles", Bound::Buffer(&self.bvh_triangles)),
        ];
        if let Some(masks) = &self.masks {
            bound.push(("LightMasks", Bound::Buffer(masks)));
        }
        bound
    }
}

/// The lights as shaders read them, each with its index.
pub fn light_blocks(lights: &LightSet, values: &Values) -> Vec<LightBlock> {
    let cutoff = values.number("light-cutoff") as f32;
    let block = |(index, one)| LightBlock { index, ..light::block(one, cutoff) };
    (0u32..).zip(&lights.lights).map(block).collect()
}
