//! The choices that the settings make, and what is refused because it cannot be made.

use super::mapping::mapping;
use super::run_settings::run_count;
use super::split_method::{Copier, Copies, Form, MaskKind, ShadeBy, SplitMethod};
use super::sub_buffers::{Moved, Stage, Storage, texel_bytes};
use super::subsets::subsets;
use super::vpl_shadow::held::VplMaps;
use crate::bvh::Bvh;
use crate::caps::Caps;
use crate::choice::choices;
use crate::error::{Error, Result};
use crate::gpu::shader::structs::{BlendParams, MappingParams, SubsetBlock};
use crate::passes::blend;
use crate::passes::direct::ShadingSettings;
use crate::passes::filter::{Filter, Kernel, StopBits};
use crate::passes::gbuffer::SurfaceParts;
use crate::passes::workgroup;
use crate::sampling::pattern::Pattern;
use crate::settings::{Brdf, PositionStorage, Values, WORKGROUP};
use crate::techniques::interleaved_deferred::resources::NAME;
use crate::techniques::until_error::until_error;
use crate::techniques::{Inputs, NamedPattern};
use crate::units::Bytes;
use std::collections::BTreeMap;

choices! {
    /// How the scene's own lights are shaded (`--direct`).
    pub enum Direct {
        /// On every pixel.
        "full" => Full,
        /// In the subsets, as diffuse light.
        "interleaved" => Interleaved,
        "none" => None,
    }
}

choices! {
    /// Virtual point lights that shade BLEND surfaces (`--blend-lights`).
    pub enum BlendLights {
        "subset" => Subset,
        "all" => All,
    }
}

choices! {
    /// What stops virtual point lights (`--vpl-shadow`).
    pub enum VplShadow {
        /// Nothing: they reach through walls (SNSM).
        "none" => None,
        /// A ray from each surface to each of its lights.
        "ray" => Ray,
        /// A shadow map of each light (SSM).
        "map" => Map,
    }
}

choices! {
    /// At which discontinuity the filter stops (`--discontinuity`).
    pub enum StopAt {
        "directional" => Directional,
        "any" => Any,
    }
}

#[derive(Clone, Debug)]
pub struct Choices {
    pub shading: ShadingSettings,
    pub split: SplitMethod,
    /// 1x1 with `--split none`: one subset of all lights.
    pub mapping: MappingParams,
    pub shade_by: ShadeBy,
    pub filter: Filter,
    pub kernel: Kernel,
    /// The composite walks the columns of the filter; the rows too are walked elsewhere where `gather_filters`.
    pub fused: bool,
    /// The scene's own lights shaded per pixel in the composite.
    pub direct_full: bool,
    /// The scene's own lights joined to the subsets.
    pub direct_interleaved: bool,
    /// Blended surfaces have the virtual point lights of their pixel's subset, not all.
    pub blend_subsets: bool,
    /// The pattern that virtual point lights are dealt out over, n x m; 1x1 where every light is summed.
    pub light_pattern: Pattern,
    /// The pattern that the joined lights are dealt out over, i x j: it divides the split's. 1x1 where none are joined
    /// and where every light is summed: no pixel lacks any of them.
    pub direct_pattern: Pattern,
    /// Virtual point lights, of each run.
    pub vpl_count: u32,
    /// Runs with lights of their own, at most.
    pub run_count: u32,
    /// The estimated relative error at which they end before.
    pub until_error: Option<f64>,
    /// How surfaces scatter virtual lights, and punctual ones that are joined to the subsets.
    pub vpl_brdf: Brdf,
    /// What a split moves into sub-buffers: as much as shading reads, at least.
    pub moved: SurfaceParts,
    pub vpl_shadow: VplShadow,
    /// Shadow maps of virtual lights, where they have any; `PreparedInterleaved` knows what room they have.
    pub vpl_maps: Option<VplMaps>,
    /// The scene's own lights that this frame has.
    pub direct_count: u32,
}

/// Patterns that the settings choose.
pub const PATTERNS: &[NamedPattern] = &[
    NamedPattern {
        name: "grid",
        summary: "The interleaved pattern: each pixel is shaded with a subset of the virtual point lights",
        keys: &["pattern"],
        make: |values| Ok(Pattern::grid(values.pair("pattern"))),
    },
    NamedPattern {
        name: "direct-grid",
        summary: "The pattern of the scene's own lights with --direct interleaved, made by clustering sub-buffers",
        keys: &["pattern", "direct-pattern"],
        make: |values| Ok(Pattern::grid(direct_pattern(values, values.pair("pattern"))?)),
    },
];

/// Subsets that eight bits of stencil can distinguish.
const STENCIL_SUBSETS: u32 = 256;

impl Choices {
    /// Errors: settings that contradict each other, or that this device cannot do (exit code 2).
    pub fn new(inputs: &Inputs<'_>) -> Result<Self> {
        let Inputs { values, lights, scene, view, caps, .. } = inputs;
        let split = SplitMethod::new(values, caps)?;
        let pattern = if split == SplitMethod::None { [1, 1] } else { values.pair("pattern") };
        let has_blocks = split.copies().is_some_and(|copies| copies.has_blocks());
        let block = if has_blocks { rounded(values.sides("block"), pattern) } else { pattern };
        let mapping = mapping(view.extent, pattern, block);
        // Only a picture whose pixels have different lights has anything to filter.
        let interleaved = !split.sums_all() && mapping.subset_count() > 1;
        let filter = if interleaved { values.choice("filter") } else { Filter::None };
        let direct: Direct = values.choice("direct");
        let direct_pattern =
            if split.sums_all() || direct != Direct::Interleaved { [1, 1] } else { direct_pattern(values, pattern)? };
        let light_pattern = if split.sums_all() { [1, 1] } else { pattern };
        let shading = ShadingSettings::new(values, lights, scene, caps);
        let moved = moved(values, split, shading.direct.extras)?;
        let choices = Self {
            shading,
            split,
            mapping,
            shade_by: values.choice("shade-by"),
            filter,
            kernel: kernel(values)?,
            // Many runs are gathered before they are filtered.
            fused: filter == Filter::Gauss && values.is_on("fuse") && run_count(values) == 1,
            direct_full: direct == Direct::Full,
            direct_interleaved: direct == Direct::Interleaved,
            blend_subsets: values.is("blend-lights", BlendLights::Subset),
            light_pattern: Pattern::grid(light_pattern),
            direct_pattern: Pattern::grid(direct_pattern),
            vpl_count: values.integer("vpls") as u32,
            run_count: run_count(values),
            until_error: until_error(values),
            vpl_brdf: values.choice("vpl-brdf"),
            moved,
            vpl_shadow: values.choice("vpl-shadow"),
            vpl_maps: None,
            direct_count: if direct == Direct::None { 0 } else { lights.lights.len() as u32 },
        };
        choices.check_lights(values.text("pattern"))?;
        choices.check_device(values.text("pattern"), caps)?;
        Ok(choices)
    }

    /// Errors: fewer lights than subsets, so that a subset has neither a virtual nor a punctual one (exit code 2).
    ///
    /// A cluster without a punctual light is none: weights stay, and the mean over a pattern with them.
    fn check_lights(&self, pattern: &str) -> Result<()> {
        if self.subsets().iter().all(|subset| subset.vpl_count + subset.light_count > 0) {
            return Ok(());
        }
        let (count, subset_count) = (self.vpl_count + self.joined_count(), self.subset_count());
        let smaller = if self.joined_count() > 0 { "--pattern or --direct-pattern" } else { "--pattern" };
        Err(Error::request(format!(
            "{NAME}: {count} lights for the {subset_count} subsets of --pattern {pattern}: each subset needs one"
        ))
        .note(format!("--vpls {subset_count} or more, or a smaller {smaller}")))
    }

    /// Errors: a limit of the stencil or of the device (exit code 2).
    fn check_device(&self, pattern: &str, caps: &Caps) -> Result<()> {
        let (subset_count, limits) = (self.mapping.subset_count(), &caps.limits);
        if self.split == SplitMethod::Masked(MaskKind::Stencil) && subset_count > STENCIL_SUBSETS {
            return Err(Error::request(format!(
                "{NAME}: --split stencil with the {subset_count} subsets of --pattern {pattern}: \
                 eight bits of stencil tell {STENCIL_SUBSETS} apart"
            ))
            .note("a smaller --pattern, or --split depth"));
        }
        let Some(copies) = self.split.copies() else { return Ok(()) };
        let padded = self.mapping.padded();
        if copies.storage == Storage::Image && padded.width.max(padded.height) > limits.max_image_side_px {
            let limit = limits.max_image_side_px;
            return Err(Error::request(format!(
                "{NAME}: sub-buffers tiled in an image of {padded} pixels: this device allows {limit} a side"
            ))
            .note("a smaller --size, --pattern or --block; --storage buffer where --split supports it"));
        }
        if copies.storage == Storage::Layers && subset_count > limits.max_image_layers {
            let limit = limits.max_image_layers;
            return Err(Error::request(format!(
                "{NAME}: --split layered with the {subset_count} subsets of --pattern {pattern}: \
                 this device allows {limit} layers in an image"
            ))
            .note("a smaller --pattern, or --split one-pass"));
        }
        let (needed, limit) = (self.tile_bytes(), u64::from(limits.max_shared_memory_bytes));
        if copies.by == Copier::Tile && needed > limit {
            let [x, y] = self.block();
            return Err(Error::request(format!(
                "{NAME}: --split tile with blocks of {x}x{y} needs {} of workgroup memory: this device has {}",
                Bytes(needed),
                Bytes(limit)
            ))
            .note("a smaller --block, or --split two-pass"));
        }
        Ok(())
    }

    /// Workgroup memory that `--split tile` needs for a block.
    fn tile_bytes(&self) -> u64 {
        let [x, y] = self.block().map(u64::from);
        x * y * texel_bytes(self.moved, self.shading.position)
    }

    /// The block after rounding; the pattern itself where the split has none.
    fn block(&self) -> [u32; 2] {
        [self.mapping.block_x, self.mapping.block_y]
    }

    /// Values after `auto` and rounding, for the settings that the split reads.
    pub fn resolved(&self) -> BTreeMap<&'static str, String> {
        let [i, j] = self.direct_pattern.period_px();
        let mut resolved = BTreeMap::from([
            ("direct-pattern", format!("{i}x{j}")),
            ("cull-by", self.shading.cull_by.name().to_owned()),
            ("accumulate", self.run_count.to_string()),
            ("sigma", format!("{}", self.kernel.sigma)),
            ("texels", self.list_texels().to_string()),
            (WORKGROUP.key, workgroup::text(self.shading.workgroup)),
        ]);
        resolved.extend(self.vpl_maps.iter().flat_map(VplMaps::resolved));
        if let Some(copies) = self.split.copies() {
            let storage = if copies.storage == Storage::Buffer { "buffer" } else { "image" };
            resolved.insert("storage", storage.to_owned());
            resolved.insert("sub-buffer-color", self.moved.color_name().to_owned());
            if copies.has_blocks() {
                let [x, y] = self.block();
                resolved.insert("block", format!("{x}x{y}"));
            }
        }
        resolved
    }

    /// How blended surfaces meet the virtual point lights.
    pub fn blend_params(&self, least_squared: f32) -> BlendParams {
        let all = blend::all_lights(least_squared);
        if !self.blend_subsets || self.split.sums_all() {
            return all;
        }
        let [pattern_x, pattern_y] = [self.mapping.pattern_x, self.mapping.pattern_y];
        BlendParams { weight: self.subset_count() as f32, pattern_x, pattern_y, ..all }
    }

    /// Whether the gather walks the rows of the filter: where one compute shader pulls each pixel.
    pub fn gather_filters(&self) -> bool {
        let pulls = |copies: Copies| copies.by == Copier::OnePass && copies.form == Form::Pull;
        self.fused && self.split.copies().is_some_and(pulls)
    }

    /// Punctual lights that are joined to the subsets.
    pub fn joined_count(&self) -> u32 {
        if self.direct_interleaved { self.direct_count } else { 0 }
    }

    /// Pixels that meet virtual lights in a frame.
    pub fn shaded_pixel_count(&self) -> u64 {
        let mapping = &self.mapping;
        match self.split {
            SplitMethod::Subsample => mapping.sub_texel_count(),
            _ => u64::from(mapping.width_px) * u64::from(mapping.height_px),
        }
    }

    /// Light subsets: those of the pattern, n * m, or one.
    pub fn subset_count(&self) -> u32 {
        self.light_pattern.subset_count()
    }

    /// Subsets of the punctual lights among them: i * j.
    pub fn direct_subset_count(&self) -> u32 {
        self.direct_pattern.subset_count()
    }

    /// The constants of irradiance.glsl that every split sets.
    pub fn irradiance_constants(&self) -> Vec<(&'static str, u32)> {
        let [shadow, offset] = self.shading.direct.shadow_constants();
        let joined = ("HAS_JOINED", u32::from(self.joined_count() > 0));
        [shadow, offset, joined].into_iter().chain(self.shaded().constant()).collect()
    }

    /// Those of compute shaders that move pixels of the frame.
    pub fn split_constants(&self) -> Vec<(&'static str, u32)> {
        self.shading.workgroup_constants().into_iter().chain(self.moved.constant()).collect()
    }

    /// Those of blended surfaces.
    pub fn blend_constants(&self) -> Vec<(&'static str, u32)> {
        let vpl_brdf = ("VPL_BRDF", self.vpl_brdf as u32);
        self.shading.direct.light_constants().into_iter().chain([vpl_brdf]).collect()
    }

    /// What shading reads of a surface.
    pub fn shaded(&self) -> SurfaceParts {
        material_where(self.vpl_brdf != Brdf::Lambert, self.shading.direct.extras)
    }

    /// What a split that copies moves, and how it lies there.
    pub fn moved_by(&self, copies: Copies) -> Moved {
        Moved { parts: self.moved, storage: copies.storage, position: self.shading.position, writer: copies.stage() }
    }

    /// What the split, or the shading where nothing is split, reads of the frame, and by what.
    pub fn read_of_frame(&self) -> (SurfaceParts, Stage) {
        match self.split {
            SplitMethod::Copy(copies) => (self.moved, copies.stage()),
            SplitMethod::Masked(_) => (self.shaded(), Stage::Fragment),
            _ => (self.shaded(), Stage::Compute),
        }
    }

    /// Texels that a thread shades with one reading of its list of lights; 1 where each pixel finds its own.
    pub fn list_texels(&self) -> u32 {
        let is_drawn = self.split.copies().is_some() && self.shade_stage() == Stage::Fragment;
        if is_drawn || matches!(self.split, SplitMethod::Branch | SplitMethod::Masked(_)) {
            return 1;
        }
        let joined = self.joined_count().div_ceil(self.direct_subset_count());
        let load = self.shading.direct.load(joined as usize);
        let lanes = u64::from(self.shading.lane_count());
        self.shading.texels.of_list(load).min(self.mapping.most_list_texels(lanes))
    }

    /// The most virtual lights that a pixel has.
    pub fn most_vpls_a_subset(&self) -> u32 {
        self.vpl_count.div_ceil(self.subset_count())
    }

    /// What shades sub-buffers.
    pub fn shade_stage(&self) -> Stage {
        if self.shade_by == ShadeBy::Dispatch { Stage::Compute } else { Stage::Fragment }
    }

    /// The shaders' axes POSITION, VPL_SHADOW, where a pass has looked for what is hidden, and VPL_BRDF.
    pub fn shade_axes(&self) -> [&'static str; 3] {
        let shadow = match self.vpl_shadow {
            VplShadow::None => "none",
            VplShadow::Ray | VplShadow::Map => "tested",
        };
        [self.shading.position.name(), shadow, self.vpl_brdf.name()]
    }

    /// The same of what blends, which no G-buffer holds: it looks for itself, by rays, because no map waits for it.
    pub fn blend_axis(&self) -> &'static str {
        match self.vpl_shadow {
            VplShadow::None => "none",
            VplShadow::Ray | VplShadow::Map => "ray",
        }
    }

    /// The tree that rays walk; an empty one where nothing casts any.
    ///
    /// Errors: as `LazyBvh::over`.
    pub fn tree<'a>(&self, inputs: &Inputs<'a>) -> Result<&'a Bvh> {
        match self.vpl_shadow {
            VplShadow::None => self.shading.direct.tree(inputs.bvh, inputs.scene),
            VplShadow::Ray => inputs.bvh.over(inputs.scene),
            VplShadow::Map if inputs.stats.has_blend => inputs.bvh.over(inputs.scene),
            VplShadow::Map => self.shading.direct.tree(inputs.bvh, inputs.scene),
        }
    }

    /// Sub-buffers that share one subset of the punctual lights.
    pub fn cluster_size(&self) -> u32 {
        self.subset_count() / self.direct_subset_count()
    }

    /// Each subset's lights.
    pub fn subsets(&self) -> Vec<SubsetBlock> {
        subsets(&self.light_pattern, &self.direct_pattern, self.vpl_count, self.joined_count())
    }
}

/// Geometry, and the material too where it `is_read`.
fn material_where(is_read: bool, has_extras: bool) -> SurfaceParts {
    if is_read { SurfaceParts::Material { has_extras } } else { SurfaceParts::Geometry }
}

/// What a split moves.
///
/// Errors: `--sub-buffer-color off` where shading reads the colour (exit code 2).
fn moved(values: &Values, split: SplitMethod, has_extras: bool) -> Result<SurfaceParts> {
    let is_glossy = !values.is("vpl-brdf", Brdf::Lambert);
    let asked = values.unless_auto("sub-buffer-color", |values, key| values.is_on(key));
    if is_glossy && asked == Some(false) && split.copies().is_some() {
        return Err(Error::request(format!(
            "{NAME}: --sub-buffer-color off with --vpl-brdf ggx: a mirror part needs the colour of surfaces in sub-buffers"
        ))
        .note("--sub-buffer-color auto or on; a --split that copies nothing; or --vpl-brdf lambert"));
    }
    Ok(material_where(is_glossy || asked == Some(true), has_extras))
}

/// Limits of the splits on a device, by the limits that `Choices::new` and the plan refuse with.
pub fn bounds(caps: &Caps) -> Vec<(&'static str, String)> {
    let limits = &caps.limits;
    let texels = |bytes: u64, texel_bytes: u64| bytes / texel_bytes;
    let (unorm16, float) = (PositionStorage::Unorm16, PositionStorage::Float);
    let range = limits.max_storage_buffer_range_bytes;
    let shared = u64::from(limits.max_shared_memory_bytes);
    let tile = |position| texels(shared, texel_bytes(SurfaceParts::Geometry, position));
    let two = |unit: &str, most: [u64; 2]| format!("{} {unit}, {} with --position float", most[0], most[1]);
    vec![
        ("--storage buffer", two("pixels a frame", [unorm16, float].map(|position| texels(range, position.bytes())))),
        ("--storage image", format!("{} px a side", limits.max_image_side_px)),
        ("--split layered", format!("{} subsets", limits.max_image_layers)),
        ("--split tile", two("pixels a block", [unorm16, float].map(tile))),
    ]
}

/// `--direct-pattern` beside a split of `pattern`.
///
/// Errors: it does not divide the pattern, so that no clusters of sub-buffers make it (exit code 2).
fn direct_pattern(values: &Values, pattern: [u32; 2]) -> Result<[u32; 2]> {
    let direct = values.unless_auto("direct-pattern", Values::pair).unwrap_or(pattern);
    if [0, 1].into_iter().all(|axis| pattern[axis].is_multiple_of(direct[axis])) {
        return Ok(direct);
    }
    let divisors = |of: u32| {
        let all: Vec<String> = (1..=of).filter(|by| of.is_multiple_of(*by)).map(|by| by.to_string()).collect();
        all.join(", ")
    };
    let ([i, j], [n, m]) = (direct, pattern);
    Err(Error::request(format!(
        "{NAME}: --direct-pattern {i}x{j} with --pattern {n}x{m}: clusters of its sub-buffers make patterns that divide it \
         (Segovia 2006, 4.6)"
    ))
    .note(format!("IxJ with I of {} and J of {}; auto is {n}x{m}", divisors(n), divisors(m))))
}

/// A block must be whole patterns: rounded up to the next multiple in each direction.
fn rounded(block: [u32; 2], pattern: [u32; 2]) -> [u32; 2] {
    [0, 1].map(|axis| block[axis].next_multiple_of(pattern[axis]))
}

fn kernel(values: &Values) -> Result<Kernel> {
    let taps = values.integer("kernel") as u32;
    if taps.is_multiple_of(2) {
        return Err(Error::request(format!("{NAME}: --kernel {taps}: it must be odd, from 5 to 17"))
            .note("Segovia 2006, table 2 measures 7, 11 and 17"));
    }
    let sigma = match values.number("sigma") {
        0.0 => taps as f32 / 3.0,
        sigma => sigma as f32,
    };
    let stop_bits = match values.choice("discontinuity") {
        StopAt::Any => StopBits::ANY,
        StopAt::Directional => StopBits::DIRECTIONAL,
    };
    Ok(Kernel { taps, sigma, stop_bits, walk_end: values.choice("walk-end") })
}
