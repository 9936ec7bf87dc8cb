//! The choices that the settings make, before there is a device: sizes, methods, the constants of the shaders.

use super::blend_names;
use super::encoding::{Packing, PackingFormat};
use super::light::Volumes;
use super::light::store::{Fresnel, Highlight, Store, Sums};
use super::stipple::{self, Rules};
use crate::caps::Ability;
use crate::choice::choices;
use crate::error::{Error, Result};
use crate::lights::shadow_casters;
use crate::passes::direct::ShadingSettings;
use crate::passes::samples::Samples;
use crate::sampling::pattern::Pattern;
use crate::settings::Values;
use crate::settings::{Brdf, INSTRUMENT, PositionStorage};
use crate::techniques::Inputs;
use crate::techniques::inferred_lighting::assignment::{self, Assignment, StippleSize};
use crate::techniques::inferred_lighting::light::LBuffer;
use crate::units::Extent;
use ash::vk;
use std::collections::{BTreeMap, BTreeSet};

/// The light buffer's default size, as a part of the frame's: 800x450 of 1280x720 (section 3, figure 3).
const LIGHT_SCALE: f64 = 0.625;
/// Part of the screen on which BLEND draws may share layers of a 2x2 stipple before --stipple auto takes 4x4. `fence` with 0.09
/// and 0.15 is better with 4x4 (FLIP 0.066 to 0.062, 0.058 to 0.039), with 0.02 the same; maps of games with up to 0.057 are
/// better with 2x2.
const MOST_SHARED_SCREEN: f64 = 0.07;

choices! {
    /// How texels of one surface are distinguished from those of another (`--light-filter`); the number is
    /// light_filter.glsl's FILTER_ value.
    pub enum LightFilter {
        "dsf" => Dsf = 1,
        "bilinear" => Bilinear = 0,
        "nearest" => Nearest = 2,
        "bilateral" => Bilateral = 3,
        "discontinuity" => Discontinuity = 4,
    }
}

choices! {
    /// How the four texels of a solid surface's pixel are read (`--light-fetch`).
    pub enum LightFetch {
        "texels" => Texels,
        "sampler" => Sampler,
    }
}

choices! {
    /// How BLEND surfaces are drawn (`--alpha`).
    pub enum Alpha {
        "blend" => Blend,
        "test" => Test,
    }
}

choices! {
    /// Weights of the samples nearest to a fragment of a BLEND surface (`--alpha-filter`).
    pub enum AlphaFilter {
        "cone" => Cone,
        "bilinear" => Bilinear,
    }
}

impl LightFilter {
    /// It compares normals instead of ids.
    pub fn reads_normals(self) -> bool {
        matches!(self, Self::Bilateral | Self::Discontinuity)
    }
}

/// The settings, checked against each other.
#[derive(Clone, Debug)]
pub struct Choices {
    pub shading: ShadingSettings,
    pub light_extent: Extent,
    pub has_extras: bool,
    /// The geometry pass writes motion vectors.
    pub has_motion: bool,
    light_roughness: f32,
    pub volumes: Volumes,
    /// Texels of a rectangle from which on --volumes auto counts a light.
    pub least_counted_texels: u64,
    /// Lights that cast shadow volumes, ascending.
    pub casting_lights: Vec<usize>,
    pub l_buffer: LBuffer,
    fresnel: Fresnel,
    pub filter: LightFilter,
    /// Rings of texels in which a surface looks for its own where the nearest four are not.
    rings: u32,
    normal_threshold: f32,
    /// Light at which losses of the L-buffer are reported.
    pub light_range: f32,
    pub packing: Packing,
    pub depth_threshold: f32,
    pub tests_alpha: bool,
    stipple_size: StippleSize,
    pub stipple: Pattern,
    /// In the material pass.
    pub samples: Samples,
    /// The material pass counts fragments that it finds no light for.
    pub is_counted: bool,
    /// The material pass shades what a pre-pass of its size sees.
    pub has_prepass: bool,
    assignment: Assignment,
    /// Layers that the user gives to draws, for `Assignment::Static`.
    named_layers: BTreeMap<u32, u32>,
    /// BLEND draws whose normals are blended into those of what they lie on.
    pub decals: BTreeSet<u32>,
    /// In texels; 0: bilinear.
    cone_radius: f32,
}

impl Choices {
    /// Errors: settings that contradict each other (exit code 2).
    pub fn new(inputs: &Inputs<'_>) -> Result<Self> {
        let values = inputs.values;
        let volumes = values.choice("volumes");
        let sums: Sums = values.choice("l-buffer");
        let in_halves = sums == Sums::Half;
        if in_halves && volumes == Volumes::Tiled {
            return Err(Error::request("--l-buffer half with --volumes tiled: sums of one dispatch are not blended")
                .note("--volumes scissor blends in half floats; --volumes tiled takes --l-buffer float"));
        }
        let casting_count = values.integer("shadow-volumes") as usize;
        if casting_count > 0 && volumes == Volumes::Tiled {
            let why = "shadows are counted in a stencil buffer, which one dispatch for all lights does not have";
            return Err(Error::request(format!("--shadow-volumes {casting_count} with --volumes tiled: {why}"))
                .note("--volumes scissor draws a light at a time, as quad, stencil, both and auto do"));
        }
        let tests_alpha = values.is("alpha", Alpha::Test);
        let assignment = values.choice("assignment");
        let asked = values.unless_auto("stipple", Values::choice);
        let largest = asked.unwrap_or(StippleSize::Four).stipple();
        let named = values.text("stipple-layers");
        let named_layers = match assignment {
            Assignment::Static => blend_names::layers(inputs.scene, named, &largest)?,
            _ if named == blend_names::NONE => BTreeMap::new(),
            _ => {
                let (assignment, error) = (assignment.name(), "layers are given out otherwise");
                return Err(Error::request(format!("--stipple-layers with --assignment {assignment}: {error}"))
                    .note("--assignment static takes them"));
            }
        };
        // Where alpha is tested, BLEND surfaces are solid.
        let decals = values.text("decals");
        let decals = blend_names::decals(inputs.scene, if tests_alpha { blend_names::NONE } else { decals })?;
        let packing: PackingFormat = values.choice("packing");
        if !decals.is_empty() && packing != PackingFormat::Fixed {
            let (packing, why) = (packing.name(), "normals in words of bits cannot be blended");
            return Err(Error::request(format!("--decals with --packing {packing}: {why}"))
                .note("--packing fixed has a channel for each number"));
        }
        let stipple_size = asked.unwrap_or_else(|| {
            let small = StippleSize::Two;
            let layer_count = assignment::layer_count(&small.stipple());
            let rules = Rules { assignment, named_layers: &named_layers, decals: &decals, layer_count };
            let has_room = || {
                let names_fit = named_layers.values().all(|layer| *layer <= layer_count);
                names_fit && stipple::shared(inputs.scene, inputs.view, rules).part_of_screen() <= MOST_SHARED_SCREEN
            };
            if tests_alpha || has_room() { small } else { StippleSize::Four }
        });
        let stipple = stipple_size.stipple();
        let [stipple_side, _] = stipple.period_px();
        let cone_radius = match values.choice("alpha-filter") {
            AlphaFilter::Cone => values.number("cone-radius") as f32 * stipple_side as f32 * 0.5,
            AlphaFilter::Bilinear => 0.0,
        };
        let light_range = values.number("light-range") as f32;
        let has_extras = values.is_on("extras") && !values.is("brdf", Brdf::Lambert);
        let is_sampled = values.is("light-fetch", LightFetch::Sampler);
        let (position, cull) = (PositionStorage::Depth, volumes == Volumes::Tiled);
        Ok(Self {
            shading: ShadingSettings::with(values, inputs.lights, inputs.scene, inputs.caps, position, cull),
            light_extent: light_extent(values.unless_auto("light-size", Values::extent), inputs.view.extent),
            has_extras,
            has_motion: values.is_on("motion-vectors"),
            light_roughness: values.number("light-roughness") as f32,
            volumes,
            least_counted_texels: values.integer("stencil-least"),
            casting_lights: shadow_casters::strongest(&inputs.lights.lights, casting_count),
            l_buffer: LBuffer { store: store(values, has_extras, light_range)?, volumes, in_halves, is_sampled },
            fresnel: values.choice("fresnel"),
            filter: values.choice("light-filter"),
            rings: values.integer("light-rings") as u32,
            normal_threshold: values.number("normal-threshold") as f32,
            light_range,
            packing: Packing::from_settings(values),
            depth_threshold: values.number("depth-threshold") as f32,
            tests_alpha,
            stipple_size,
            stipple,
            samples: Samples::new(values),
            is_counted: values
                .unless_auto(INSTRUMENT.key, Values::is_on)
                .unwrap_or_else(|| Ability::FragmentAtomics.is_there(inputs.caps)),
            has_prepass: values.is_on("depth-prepass"),
            assignment,
            named_layers,
            decals,
            cone_radius,
        })
    }

    /// The word of `--stipple` that is followed.
    pub fn stipple_name(&self) -> &'static str {
        self.stipple_size.name()
    }

    /// How BLEND draws get their layers.
    pub fn stipple_rules(&self) -> Rules<'_> {
        let layer_count = assignment::layer_count(&self.stipple);
        Rules { assignment: self.assignment, named_layers: &self.named_layers, decals: &self.decals, layer_count }
    }

    /// Texels of a side of the stipple.
    pub fn stipple_side(&self) -> u32 {
        self.stipple.period_px()[0]
    }

    /// Whether the light pass counts into a stencil.
    pub fn has_stencil(&self) -> bool {
        self.volumes.counts() || !self.casting_lights.is_empty()
    }

    /// Depth format of the geometry pass.
    pub fn depth_format(&self) -> vk::Format {
        if self.has_stencil() { vk::Format::D32_SFLOAT_S8_UINT } else { vk::Format::D32_SFLOAT }
    }

    /// Constants of the light pass's shaders.
    pub fn light_constants(&self) -> Vec<(&'static str, u32)> {
        let mut constants = vec![("BRDF_KIND", self.shading.direct.brdf as u32), self.fixed_constant()];
        constants.push(self.shading.direct.kinds_constant());
        constants.extend(self.shading.direct.shadow_constants());
        constants.extend(self.l_buffer.store.constants());
        constants.extend([("ROUGHNESS", self.light_roughness.to_bits()), ("FRESNEL_PER_LIGHT", self.fresnel as u32)]);
        constants
    }

    /// The constant of the packing.
    pub fn fixed_constant(&self) -> (&'static str, u32) {
        ("FIXED_STEPS", self.packing.fixed_steps())
    }

    /// The word of `--highlight` that is followed; `none` where nothing mirrors.
    pub fn highlight(&self) -> &'static str {
        match self.l_buffer.store {
            _ if self.shading.direct.brdf == Brdf::Lambert => "none",
            Store::Shared => Highlight::Rgb.name(),
            Store::Split => Highlight::Split.name(),
            Store::Halves | Store::Fixed { .. } => Highlight::Intensity.name(),
        }
    }

    /// Constants of the geometry pass.
    pub fn geometry_constants(&self) -> [(&'static str, u32); 3] {
        let store = self.l_buffer.store;
        let divides = store == Store::Shared || (store.has_channels() && self.fresnel == Fresnel::Light);
        [
            self.fixed_constant(),
            ("SURFACE_EXTRAS", u32::from(self.shading.direct.extras)),
            ("KEEPS_F0", u32::from(divides)),
        ]
    }

    /// Constants of the material pass.
    pub fn material_constants(&self) -> [(&'static str, u32); 11] {
        let [range, highlight] = self.l_buffer.store.constants();
        [
            self.fixed_constant(),
            range,
            highlight,
            ("FRESNEL_PER_LIGHT", self.fresnel as u32),
            ("BRDF_KIND", self.shading.direct.brdf as u32),
            ("SURFACE_EXTRAS", u32::from(self.shading.direct.extras)),
            ("LIGHT_FILTER", self.filter as u32),
            ("RINGS", self.rings),
            ("NORMAL_THRESHOLD", self.normal_threshold.to_bits()),
            ("CONE_RADIUS", self.cone_radius.to_bits()),
            self.samples.constant(),
        ]
    }
}

/// What the L-buffer keeps, by `--l-buffer` and `--highlight`.
///
/// Errors: a highlight that the L-buffer's format or the geometry pass has no room for (exit code 2).
fn store(values: &Values, has_extras: bool, light_range: f32) -> Result<Store> {
    let sums: Sums = values.choice("l-buffer");
    let channels = if sums == Sums::Fixed { Store::Fixed { range: light_range } } else { Store::Halves };
    if values.is("brdf", Brdf::Lambert) {
        return Ok(channels);
    }
    let is_sampled = values.is("light-fetch", LightFetch::Sampler);
    let four = match (sums, is_sampled) {
        (Sums::Fixed, _) => Some("--l-buffer fixed"),
        (_, true) => Some("--light-fetch sampler"),
        _ => None,
    };
    let asked: Option<Highlight> = values.unless_auto("highlight", Values::choice);
    match (asked, four) {
        (Some(asked @ (Highlight::Rgb | Highlight::Split)), Some(setting)) => {
            let error =
                format!("--highlight {} with {setting}: there are four channels, one for highlights", asked.name());
            Err(Error::request(error).note("--highlight intensity has one number"))
        }
        (Some(Highlight::Rgb), None) if !has_extras => Err(Error::request(
            "--highlight rgb with --extras off: the light pass does not know the F0 that it divides by",
        )
        .note("--highlight split works without it")),
        (Some(Highlight::Intensity), _) | (None, Some(_)) if !has_extras && values.is("fresnel", Fresnel::Light) => {
            let error = "--fresnel light with --extras off: the light pass does not know the F0 that it divides by";
            Err(Error::request(error)
                .note("--fresnel normal works without it, as in the paper; so does --highlight split"))
        }
        (Some(Highlight::Intensity), _) | (None, Some(_)) => Ok(channels),
        (Some(Highlight::Split), None) => Ok(Store::Split),
        (Some(Highlight::Rgb), None) => Ok(Store::Shared),
        (None, None) => Ok(if has_extras { Store::Shared } else { Store::Split }),
    }
}

/// `--light-size`; auto: a part of the frame.
fn light_extent(asked: Option<Extent>, frame: Extent) -> Extent {
    let scaled = |side: u32| ((f64::from(side) * LIGHT_SCALE).round() as u32).max(1);
    asked.unwrap_or_else(|| Extent::new(scaled(frame.width), scaled(frame.height)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_size_is_the_paper_s() {
        assert_eq!(light_extent(None, Extent::new(1280, 720)), Extent::new(800, 450));
        assert_eq!(light_extent(None, Extent::new(1, 3)), Extent::new(1, 2));
        assert_eq!(light_extent(Some(Extent::new(320, 200)), Extent::new(1, 3)), Extent::new(320, 200));
    }
}
