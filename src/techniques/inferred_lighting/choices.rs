//! The choices that the settings make, before there is a device: sizes, methods, the constants of the shaders.

use super::encoding::Packing;
use super::layer_names;
use super::light::Volumes;
use super::light::store::{Store, Sums};
use crate::caps::Ability;
use crate::choice::choices;
use crate::error::{Error, Result};
use crate::lights::shadow_casters;
use crate::passes::direct::ShadingSettings;
use crate::passes::resolve;
use crate::sampling::pattern::Pattern;
use crate::settings::Values;
use crate::settings::{Brdf, INSTRUMENT, PositionStorage};
use crate::techniques::Inputs;
use crate::techniques::inferred_lighting::assignment::{self, Assignment};
use crate::units::Extent;
use ash::vk;
use std::collections::BTreeMap;

/// The light buffer's default size, as a part of the frame's: 800x450 of 1280x720 (section 3, figure 3).
const LIGHT_SCALE: f64 = 0.625;

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
    /// The L-buffer is blended in half floats.
    pub in_halves: bool,
    pub filter: LightFilter,
    /// The sampler blends four texels of one surface.
    sampler_blends: bool,
    normal_threshold: f32,
    pub store: Store,
    /// Light at which losses of the L-buffer are reported.
    pub light_range: f32,
    pub packing: Packing,
    pub depth_threshold: f32,
    pub tests_alpha: bool,
    pub stipple: Pattern,
    /// Samples a pixel of the material pass.
    pub samples: u32,
    /// The material pass counts fragments that it finds no light for.
    pub is_counted: bool,
    /// The material pass shades what a pre-pass of its size sees.
    pub has_prepass: bool,
    pub assignment: Assignment,
    /// Layers that the user gives to draws, for `Assignment::Static`.
    pub named_layers: BTreeMap<u32, u32>,
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
        let stipple = assignment::stipple(values);
        let [stipple_side, _] = stipple.period_px();
        let cone_radius = match values.choice("alpha-filter") {
            AlphaFilter::Cone => values.number("cone-radius") as f32 * stipple_side as f32 * 0.5,
            AlphaFilter::Bilinear => 0.0,
        };
        let assignment = values.choice("assignment");
        let named = values.text("stipple-layers");
        let named_layers = match assignment {
            Assignment::Static => layer_names::layers(inputs.scene, named, &stipple)?,
            _ if named == layer_names::NONE => BTreeMap::new(),
            _ => {
                let (assignment, error) = (assignment.name(), "layers are given out otherwise");
                return Err(Error::request(format!("--stipple-layers with --assignment {assignment}: {error}"))
                    .note("--assignment static takes them"));
            }
        };
        let light_range = values.number("light-range") as f32;
        let (position, cull) = (PositionStorage::Depth, volumes == Volumes::Tiled);
        Ok(Self {
            shading: ShadingSettings::with(values, inputs.lights, inputs.scene, inputs.caps, position, cull),
            light_extent: light_extent(values.unless_auto("light-size", Values::extent), inputs.view.extent),
            has_extras: values.is_on("extras") && !values.is("brdf", Brdf::Lambert),
            has_motion: values.is_on("motion-vectors"),
            light_roughness: values.number("light-roughness") as f32,
            volumes,
            least_counted_texels: values.integer("stencil-least"),
            casting_lights: shadow_casters::strongest(&inputs.lights.lights, casting_count),
            in_halves,
            filter: values.choice("light-filter"),
            sampler_blends: values.is("light-fetch", LightFetch::Sampler),
            normal_threshold: values.number("normal-threshold") as f32,
            store: if sums == Sums::Fixed { Store::Fixed { range: light_range } } else { Store::Halves },
            light_range,
            packing: Packing::from_settings(values),
            depth_threshold: values.number("depth-threshold") as f32,
            tests_alpha: values.is("alpha", Alpha::Test),
            stipple,
            samples: resolve::samples(values),
            is_counted: values
                .unless_auto(INSTRUMENT.key, Values::is_on)
                .unwrap_or_else(|| Ability::FragmentAtomics.is_there(inputs.caps)),
            has_prepass: values.is_on("depth-prepass"),
            assignment,
            named_layers,
            cone_radius,
        })
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

    /// Constants of the light pass: those of lights that are not of materials, and ROUGHNESS without extras.
    pub fn light_constants(&self) -> Vec<(&'static str, u32)> {
        let mut constants = vec![("BRDF_KIND", self.shading.direct.brdf as u32), self.fixed_constant()];
        constants.push(self.shading.direct.kinds_constant());
        constants.extend(self.shading.direct.shadow_constants());
        if !self.has_extras && self.shading.direct.brdf != Brdf::Lambert {
            constants.push(("ROUGHNESS", self.light_roughness.to_bits()));
        }
        constants
    }

    /// The constant of the packing.
    pub fn fixed_constant(&self) -> (&'static str, u32) {
        ("FIXED_STEPS", self.packing.fixed_steps())
    }

    /// Constants of the material pass.
    pub fn material_constants(&self) -> [(&'static str, u32); 8] {
        [
            self.fixed_constant(),
            self.store.constant(),
            ("BRDF_KIND", self.shading.direct.brdf as u32),
            ("SURFACE_EXTRAS", u32::from(self.shading.direct.extras)),
            ("LIGHT_FILTER", self.filter as u32),
            ("SAMPLER_BLENDS", u32::from(self.sampler_blends)),
            ("NORMAL_THRESHOLD", self.normal_threshold.to_bits()),
            ("CONE_RADIUS", self.cone_radius.to_bits()),
        ]
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
