//! The choices that the settings make.

use super::guard_band;
use super::mid_exposure::MidExposure;
use super::space::ShadingSpace;
use super::tuples::TupleTable;
use crate::error::Result;
use crate::gpu::shader::Shader;
use crate::gpu::shader::structs::DeepBlock;
use crate::lens::Lens;
use crate::lights::LightSet;
use crate::passes::direct::DirectSettings;
use crate::passes::shadow_maps::MapLayout;
use crate::passes::texels::Texels;
use crate::settings::{GeometryChoice, Values};
use crate::techniques::Inputs;
use crate::techniques::deep_shading::contradictions::{
    require_both, require_corners, require_direct, require_drawn, require_spids, require_straight,
};
use crate::techniques::deep_shading::modes::barycentrics::Barycentrics;
use crate::techniques::deep_shading::modes::conservative::Conservative;
use crate::techniques::deep_shading::modes::coverage_test::CoverageTest;
use crate::techniques::deep_shading::modes::layer_from::LayerFrom;
use crate::techniques::deep_shading::modes::lists::{Duplicates, ListAccess, Lists, ShadedTriangles};
use crate::techniques::deep_shading::modes::pixel_samples::PixelSamples;
use crate::techniques::deep_shading::modes::polygon_from::PolygonFrom;
use crate::techniques::deep_shading::modes::sample_tests::is_looped;
use crate::techniques::deep_shading::modes::shade_by::ShadeBy;
use crate::techniques::deep_shading::modes::shading::Shading;
use crate::techniques::deep_shading::modes::shading_kind::ShadingKind;
use crate::techniques::deep_shading::modes::shading_rate;
use crate::techniques::deep_shading::modes::vertices::Vertices;
use crate::techniques::deep_shading::modes::visibility::Visibility;
use crate::techniques::deep_shading::resources;
use crate::techniques::deep_shading::resources::{
    BEGIN_BYTES, COLOR_BYTES, LINEAR_COUNT, NAME, NEAREST_BYTES, NODE_BYTES, ROW_ID_BYTES,
};
use crate::techniques::deep_shading::sample_count;
use crate::units::Extent;

/// How lists are made and read. Without lists all are false but `tolerates_duplicates`.
#[derive(Clone, Copy)]
pub struct ListChoices {
    /// The host inserts into them, and samples have no SPIDs.
    pub is_direct: bool,
    /// A compute shader shades what they have, entry by entry.
    pub has_entries: bool,
    pub tolerates_duplicates: bool,
    pub is_compacted: bool,
    pub has_zmax: bool,
    pub has_addresses: bool,
    /// Shading space is drawn with what stands in lists.
    pub has_marks: bool,
}

/// How triangles are drawn, for samples and into shading space.
pub struct RasterChoices {
    pub vertices: Vertices,
    pub layer_from: LayerFrom,
    pub polygon_from: PolygonFrom,
    pub conservative: Conservative,
    /// Where fragments that shade have their weights from.
    pub barycentrics: Barycentrics,
    /// Stochastic rasterisation tests all samples of a pixel at once.
    pub is_looped: bool,
    /// By what it tests them.
    coverage_test: CoverageTest,
    /// Layers that are drawn together reach beyond the frame.
    pub has_padding: bool,
    /// Sub-pixel precision to which the rasteriser snaps corners, in bits.
    sub_pixel_bits: u32,
}

/// What is blurred.
pub struct BlurChoices {
    /// None: a pinhole, where the camera is.
    pub lens: Option<Lens>,
    /// The scene where it is shaded; None: nothing moves.
    pub mid_exposure: Option<MidExposure>,
    /// The scene is another one when the shutter closes.
    pub is_moving: bool,
    /// Something is blurred, and its colours are filtered.
    pub is_reconstructed: bool,
}

pub struct Choices {
    pub shading: Shading,
    pub direct: DirectSettings,
    pub visibility: Visibility,
    pub raster: RasterChoices,
    pub table: TupleTable,
    pub pixel_samples: PixelSamples,
    /// Sets of samples that the picture is the mean of.
    pub run_count: u32,
    pub space: ShadingSpace,
    pub blur: BlurChoices,
    pub has_lists: bool,
    pub lists: ListChoices,
    /// Entries of the cache of `--shading indirect-gbuffer`.
    pub cache_entries: u64,
    pub is_counted: bool,
    /// Shaders reach buffers with an entry a sample, or more, by their addresses.
    pub is_by_address: bool,
    pub geometry: GeometryChoice,
    /// Entries that a thread shades one after the other.
    pub texels: u32,
    /// Lights are left out that reach none of them.
    culls_lights: bool,
    /// Textures are read at several places for a pixel that sees them at a slant.
    reads_along: bool,
    /// With `--shading-rate blur`: pixels of shading space across a blur, at least.
    pub blur_pixels: Option<f32>,
    /// With `--direct-shadow map`.
    pub maps: Option<MapLayout>,
}

impl Choices {
    /// Errors: `--tuples` is no multiple of `--spp`; shading space is too large; settings that `--shading` does not read (exit
    /// code 2).
    pub fn new(inputs: &Inputs<'_>) -> Result<Self> {
        let values = inputs.values;
        let shade_by = ShadeBy::of(values);
        let has_lists = shade_by.is_some();
        let is_direct = has_lists && values.is("lists", Lists::Direct);
        require_direct(values)?;
        require_straight(values)?;
        require_corners(values)?;
        require_spids(values)?;
        require_both(values)?;
        require_drawn(values)?;
        let is_compacted = has_lists && values.is_on("compaction");
        let is_by_fragment = shade_by == Some(ShadeBy::Fragment);
        let lens = if values.number("aperture").max(values.number("stereo")) > 0.0 {
            Lens::new(values, inputs.view, inputs.scene, inputs.bvh.whole(inputs.scene)?)
        } else {
            None
        };
        let mid_exposure = MidExposure::new(inputs)?;
        let (scene, lights) =
            mid_exposure.as_ref().map_or((inputs.scene, inputs.lights), |middle| (&middle.scene, &middle.lights));
        let maps = MapLayout::new(values, lights, scene, inputs.stats, inputs.caps, inputs.requirements);
        let is_blurred = lens.is_some_and(|lens| lens.radius > 0.0) || mid_exposure.is_some();
        let eyes = lens.map_or(1, |lens| lens.places().len() as u32);
        let samples = sample_count::samples(values, is_blurred, inputs.view.extent.pixel_count() * u64::from(eyes));
        let table = TupleTable { eyes, ..TupleTable::from_settings(values, samples, is_blurred)? };
        let shading = Shading::new(values, inputs.caps, samples).map_err(|error| error.within(NAME))?;
        let visibility = shading.visibility(values, inputs.caps)?;
        let pixel_samples = PixelSamples::of(values, visibility)?;
        let guard_px = guard_band::width_px(values, inputs, lens, mid_exposure.as_ref());
        let space = ShadingSpace::new(values, guard_px, &inputs.caps.limits, inputs.view.extent)
            .map_err(|error| error.within(NAME))?;
        let samples_of_set = table.sample_count(inputs.view.extent);
        let cache_entries = values.unless_auto("shading-cache", Values::integer);
        let is_of_space = matches!(shading, Shading::Deep | Shading::IndirectGbuffer);
        let direct = DirectSettings::new(values, inputs.lights, inputs.scene);
        let texels = match shading {
            Shading::Deep => Texels::new(values, inputs.caps).of_column(direct.load(inputs.lights.lights.len())),
            _ => 1,
        };
        let mut choices = Self {
            shading,
            texels,
            culls_lights: values.is_on("cull-lights") && inputs.lights.lights.iter().any(|light| light.range.is_some()),
            maps: maps.map_err(|error| error.within(NAME))?,
            direct,
            blur_pixels: shading_rate::blur_pixels(values).filter(|_| is_of_space && is_blurred),
            reads_along: inputs.scene.texturing.reads_along(),
            visibility,
            raster: RasterChoices {
                // Baselines draw each corner with its weights.
                vertices: match is_of_space && visibility.draws_corners() {
                    true => Vertices::of(values, inputs.caps),
                    false => Vertices::Fetched,
                },
                layer_from: LayerFrom::of(values, inputs.caps),
                polygon_from: PolygonFrom::of(values, inputs.caps),
                conservative: Conservative::of(values, inputs.caps),
                barycentrics: values.choice("barycentrics"),
                is_looped: is_of_space && is_looped(values, inputs.caps, visibility, samples_of_set * NEAREST_BYTES),
                coverage_test: values.choice("coverage-test"),
                has_padding: visibility.is_layered() && !table.divides(inputs.view.extent),
                sub_pixel_bits: inputs.caps.limits.sub_pixel_bits,
            },
            table,
            pixel_samples,
            run_count: values.integer("accumulate") as u32,
            space,
            blur: BlurChoices {
                is_moving: mid_exposure.is_some(),
                is_reconstructed: is_blurred && is_reconstructed(values, eyes),
                lens,
                mid_exposure,
            },
            has_lists,
            lists: ListChoices {
                is_direct,
                has_entries: has_lists && !is_by_fragment,
                tolerates_duplicates: values.is("duplicates", Duplicates::Tolerated),
                is_compacted,
                has_zmax: is_by_fragment && values.is_on("zmax"),
                has_addresses: has_lists && values.is_on("address-buffer"),
                has_marks: is_by_fragment && values.is("shaded-triangles", ShadedTriangles::Listed),
            },
            cache_entries: cache_entries.unwrap_or(samples_of_set),
            is_counted: values.unless_auto("instrument", Values::is_on).unwrap_or(true),
            is_by_address: false,
            geometry: values.choice("geometry"),
        };
        choices.is_by_address = is_by_address(&choices, inputs);
        Ok(choices)
    }

    /// The shaders' block: shading space, cameras, lens and samples.
    pub fn deep_block(&self, inputs: &Inputs<'_>) -> DeepBlock {
        let close = self.blur.mid_exposure.as_ref().map(|middle| &middle.closing.view);
        self.space.block(inputs.view, close, self.blur.lens, &self.table)
    }

    /// The lights that shade: those in the middle of the exposure.
    pub fn lights<'a>(&'a self, inputs: &Inputs<'a>) -> &'a LightSet {
        self.blur.mid_exposure.as_ref().map_or(inputs.lights, |middle| &middle.lights)
    }

    /// Where the lenses of the eyes are on the unit disk.
    pub fn eyes(&self) -> Vec<f32> {
        self.blur.lens.map_or_else(|| vec![0.0], |lens| lens.places())
    }

    /// Both eyes are seen by at once.
    pub fn has_right_eye(&self) -> bool {
        self.table.eyes > 1
    }

    /// Samples have a depth image: what is nearest is found by depth tests.
    pub fn has_depth(&self) -> bool {
        self.visibility != Visibility::Ray && !self.raster.is_looped
    }

    /// Fragments shade what lists have.
    pub fn is_by_fragment(&self) -> bool {
        self.has_lists && !self.lists.has_entries
    }

    /// The name of the pass that shades entries: all of them, or those of strays alone, which blur brings in from outside shading
    /// space, and rounding where triangles are huge, edge-on or cut by the near plane.
    pub fn entries_pass(&self) -> &'static str {
        if self.is_by_fragment() { "strays" } else { "shade" }
    }

    /// By how much what must hold a triangle is drawn too large, pixels: `snap_px` of snap.glsl.
    pub fn snap_px(&self) -> f32 {
        4.0 / (1u32 << self.sub_pixel_bits()) as f32
    }

    /// SUB_PIXEL_BITS: the steps of a pixel that the rasteriser snaps corners to, as a power of two.
    fn sub_pixel_bits(&self) -> u32 {
        self.raster.sub_pixel_bits.min(16)
    }

    /// Samples of one set, padding included.
    pub fn samples_of(&self, frame: Extent) -> u64 {
        self.table.sample_count(frame)
    }

    /// The value of the axis COUNT of shaders whose fragments write counters and nothing else.
    pub fn count_axis(&self) -> &'static str {
        if self.is_counted { "on" } else { "off" }
    }

    /// Constants that several shaders have.
    pub fn constants(&self) -> Vec<(&'static str, u32)> {
        let mut constants = self.direct.light_constants().to_vec();
        constants.extend(self.maps.iter().flat_map(MapLayout::constants));
        constants.extend([
            ("IS_MOVING", u32::from(self.blur.is_moving)),
            ("HAS_SCALES", u32::from(self.blur_pixels.is_some())),
            ("HAS_LENS", u32::from(self.blur.lens.is_some_and(|lens| lens.reach() > 0.0))),
            ("TOLERATES_DUPLICATES", u32::from(self.lists.tolerates_duplicates)),
            ("IS_COMPACTED", u32::from(self.lists.is_compacted)),
            ("HAS_ZMAX", u32::from(self.lists.has_zmax)),
            ("HAS_LIST_ENTRIES", u32::from(self.lists.has_entries)),
            ("IS_COUNTED", u32::from(self.is_counted)),
            ("TEXELS", self.texels),
            ("READS_ALONG", u32::from(self.reads_along)),
            ("CULLS_LIGHTS", u32::from(self.culls_lights)),
            ("HAS_PADDING", u32::from(self.raster.has_padding)),
            ("SUB_PIXEL_BITS", self.sub_pixel_bits()),
            ("BY_ADDRESS", u32::from(self.is_by_address)),
            ("CACHE_ENTRIES", self.cache_entries as u32),
            ("MISSING_FAILS", u32::from(!(self.is_by_fragment() && self.raster.conservative == Conservative::Plain))),
            ("HAS_OWN_SAMPLES", u32::from(self.pixel_samples == PixelSamples::Own)),
            ("HAS_REDUCED_TEST", u32::from(self.raster.coverage_test == CoverageTest::Reduced)),
            ("PASS_SAMPLES", self.shading.pass_samples()),
            ("TEXTURE_SIDE_BITS", self.shading.texture_side_bits()),
        ]);
        constants
    }
}

/// The technique's constants that one of these shaders has.
pub fn constants_of(choices: &Choices, shaders: &[Option<&Shader>]) -> Vec<(&'static str, u32)> {
    crate::gpu::shader::constants_of(&choices.constants(), shaders)
}

/// Whether colours are filtered where something is blurred: `--reconstruct`, `auto` resolved.
///
/// Few samples show as a pattern and many as copies of what is sharp; many sets of them come to the mean itself. Who says how many
/// samples there are may want to see them as they are.
fn is_reconstructed(values: &Values, eyes: u32) -> bool {
    let helps = || {
        values.unless_auto("spp", Values::integer).is_none()
            && eyes == 1
            && values.integer("accumulate") == 1
            && values.is("shading", ShadingKind::Deep)
            && !values.is("lists", Lists::Direct)
    };
    values.unless_auto("reconstruct", Values::is_on).unwrap_or_else(helps)
}

/// Entries of the longest buffer that has as many a pixel of shading space.
pub fn space_entries(choices: &Choices) -> u64 {
    let a_pixel = match (choices.has_lists, choices.lists.is_compacted) {
        (false, _) => 0,
        (true, false) => 1,
        (true, true) => LINEAR_COUNT,
    };
    choices.space.extent.pixel_count() * a_pixel
}

/// Bytes of a sample in the longest buffer with an entry for each sample; 0 where `--shading` has no such buffer.
pub fn sample_bytes(choices: &Choices) -> u64 {
    match choices.shading {
        Shading::Deep => NODE_BYTES.max(COLOR_BYTES).max(resources::SAMPLE_BYTES),
        Shading::IndirectGbuffer => resources::ENTRY_BYTES,
        Shading::Ssaa | Shading::Msaa { .. } | Shading::TextureSpace(_) => 0,
    }
}

/// The longest buffer.
pub fn longest_bytes(choices: &Choices, frame: Extent) -> u64 {
    let others = match choices.shading {
        Shading::Deep => space_entries(choices) * BEGIN_BYTES.max(ROW_ID_BYTES),
        Shading::IndirectGbuffer => choices.cache_entries * resources::CACHE_BYTES,
        Shading::Ssaa | Shading::Msaa { .. } | Shading::TextureSpace(_) => 0,
    };
    let means = if choices.blur.is_reconstructed { frame.pixel_count() * resources::MEANS_BYTES } else { 0 };
    others.max(means).max(choices.samples_of(frame) * sample_bytes(choices))
}

/// `--list-access`, `auto` resolved: whether addresses are taken.
pub fn is_by_address(choices: &Choices, inputs: &Inputs<'_>) -> bool {
    let is_long = || longest_bytes(choices, inputs.view.extent) > inputs.caps.limits.max_storage_buffer_range_bytes;
    let asked = inputs.values.unless_auto("list-access", Values::choice);
    asked.map_or_else(is_long, |access: ListAccess| access == ListAccess::Addresses)
}

/// How buffers are reached, in the report's words.
pub fn list_access_name(is_by_address: bool) -> &'static str {
    if is_by_address { ListAccess::Addresses.name() } else { ListAccess::Descriptors.name() }
}
