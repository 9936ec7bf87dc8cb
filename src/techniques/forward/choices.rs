//! What forward shading's settings come to, for one scene and one device.

use super::resources;
use crate::choice::choices;
use crate::error::{Error, Result};
use crate::gpu::shader::structs::LightBlock;
use crate::gpu::shader::techniques::forward::material::UNIFORM_LIGHT_COUNT;
use crate::lights::object_lists::ObjectLists;
use crate::passes::direct::{self, DirectSettings};
use crate::passes::resolve;
use crate::passes::shadow_maps::MapLayout;
use crate::resident::Coverage;
use crate::settings::ListChoice;
use crate::settings::Values;
use crate::techniques::Inputs;
use crate::techniques::forward::resources::NAME;
use crate::units::Bytes;

choices! {
    /// The buffer from which solid surfaces read the lights (`--light-buffer`).
    pub enum LightBuffer {
        "uniform" => Uniform,
        "storage" => Storage,
    }
}

/// The choices that the settings make.
pub struct Choices {
    pub(super) direct: DirectSettings,
    lists: ListChoice,
    /// Lights in a uniform buffer.
    pub(super) is_uniform: bool,
    pub(super) has_prepass: bool,
    /// Samples a pixel.
    pub(super) samples: u32,
    /// Runs of a picture along each side of a pixel.
    pub(super) runs_per_side: u32,
    /// With `--direct-shadow map`, where there are lights.
    pub(super) maps: Option<MapLayout>,
}

impl Choices {
    /// Errors: more lights than a uniform buffer holds (exit code 2); shadow maps that do not fit (`MapLayout::new`).
    pub(super) fn new(inputs: &Inputs<'_>) -> Result<Self> {
        let values = inputs.values;
        let (count, range) = (inputs.lights.lights.len(), inputs.caps.limits.max_uniform_buffer_range_bytes);
        let asked = values.unless_auto("light-buffer", Values::choice);
        let fits = count <= UNIFORM_LIGHT_COUNT as usize && resources::UNIFORM_BYTES <= range;
        if asked == Some(LightBuffer::Uniform) && !fits {
            let (most, device) = (UNIFORM_LIGHT_COUNT, &inputs.caps.identity.name);
            let why = format!(
                "--light-buffer uniform: {count} lights: it holds {most}, where a device binds {} ({device} binds {})",
                Bytes(resources::UNIFORM_BYTES),
                Bytes(range)
            );
            return Err(Error::request(why).within(NAME).note("--light-buffer storage holds all of them"));
        }
        Ok(Self {
            is_uniform: fits && asked != Some(LightBuffer::Storage),
            direct: DirectSettings::new(values, inputs.lights, inputs.scene),
            lists: values.choice("light-lists"),
            has_prepass: values.is_on("depth-prepass"),
            samples: resolve::samples(values),
            runs_per_side: values.integer("supersample") as u32,
            maps: MapLayout::new(values, inputs.lights, inputs.scene, inputs.stats, inputs.caps, inputs.requirements)
                .map_err(|error| error.within(NAME))?,
        })
    }

    /// The lights as shaders read them, and the lists of all objects.
    pub(super) fn lists(&self, inputs: &Inputs<'_>) -> Result<(Vec<LightBlock>, ObjectLists)> {
        let lights = direct::light_blocks(inputs.lights, inputs.values);
        let most_bytes = inputs.caps.limits.max_storage_buffer_range_bytes;
        let lists = ObjectLists::new(inputs.scene, &lights, self.lists, most_bytes)?;
        Ok((lights, lists))
    }

    /// The constants of all shaders that light.
    pub(super) fn light_constants(&self) -> Vec<(&'static str, u32)> {
        let maps = self.maps.iter().flat_map(MapLayout::constants);
        self.direct.light_constants().into_iter().chain(maps).collect()
    }

    pub(super) fn coverage(&self) -> Coverage {
        if self.samples * self.runs_per_side > 1 { Coverage::Anywhere } else { Coverage::Middle }
    }
}
