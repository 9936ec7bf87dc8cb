//! What the settings of forward shading come to, for one scene and one device.

use crate::caps::Caps;
use crate::error::{Error, Result};
use crate::gpu::shader::passes::forward::material::UNIFORM_LIGHT_COUNT;
use crate::gpu::shader::structs::LightBlock;
use crate::lights::LightSet;
use crate::lights::object_lists::ObjectLists;
use crate::passes::blend;
use crate::passes::direct::{self, DirectSettings};
use crate::passes::samples::Samples;
use crate::passes::shadow_maps::MapLayout;
use crate::plan::Requirements;
use crate::resident::SceneStats;
use crate::scene::Scene;
use crate::settings::{LightBuffer, ListChoice, Values};
use crate::units::Bytes;
use std::collections::BTreeMap;
use std::time::Instant;

/// Bytes of the lights that the material pass reads as uniforms.
pub const UNIFORM_BYTES: u64 = UNIFORM_LIGHT_COUNT as u64 * size_of::<LightBlock>() as u64;

/// The choices that the settings make.
pub struct ForwardChoices {
    pub direct: DirectSettings,
    lists: ListChoice,
    /// Lights in a uniform buffer.
    pub is_uniform: bool,
    pub has_prepass: bool,
    pub samples: Samples,
    /// With `--direct-shadow map`, where there are lights.
    pub maps: Option<MapLayout>,
}

impl ForwardChoices {
    /// `samples`: of each pixel that is drawn. `technique`: whose settings these are.
    ///
    /// Errors: more lights than a uniform buffer holds (exit code 2); shadow maps that do not fit (`MapLayout::new`).
    pub fn new(
        technique: &str,
        values: &Values,
        (scene, stats, lights): (&Scene, &SceneStats, &LightSet),
        (caps, requirements): (&Caps, Requirements<'_>),
        samples: Samples,
    ) -> Result<Self> {
        let (count, range) = (lights.lights.len(), caps.limits.max_uniform_buffer_range_bytes);
        let asked = values.unless_auto("light-buffer", Values::choice);
        let fits = count <= UNIFORM_LIGHT_COUNT as usize && UNIFORM_BYTES <= range;
        if asked == Some(LightBuffer::Uniform) && !fits {
            let (most, device) = (UNIFORM_LIGHT_COUNT, &caps.identity.name);
            let why = format!(
                "--light-buffer uniform: {count} lights: it holds {most}, where a device binds {} ({device} binds {})",
                Bytes(UNIFORM_BYTES),
                Bytes(range)
            );
            return Err(Error::request(why).within(technique).note("--light-buffer storage holds all of them"));
        }
        Ok(Self {
            is_uniform: fits && asked != Some(LightBuffer::Storage),
            direct: DirectSettings::new(values, lights, scene),
            lists: values.choice("light-lists"),
            has_prepass: values.is_on("depth-prepass"),
            samples,
            maps: MapLayout::new(values, lights, scene, stats, caps, requirements)
                .map_err(|error| error.within(technique))?,
        })
    }

    /// For runs in which things, or lights, are elsewhere: each object has all lights, each map all casters.
    pub fn hold_at_any_moment(&mut self) {
        self.lists = ListChoice::None;
        self.maps.iter_mut().for_each(MapLayout::hold_all_casters);
    }

    /// The lights and the lists of all objects.
    ///
    /// Errors: as `ObjectLists::new`.
    pub fn listed(&self, values: &Values, scene: &Scene, lights: &LightSet, caps: &Caps) -> Result<ListedLights> {
        let began = Instant::now();
        let lights = direct::light_blocks(lights, values);
        let most_bytes = caps.limits.max_storage_buffer_range_bytes;
        let lists = ObjectLists::new(scene, &lights, self.lists, most_bytes)?;
        Ok(ListedLights { lights, lists, took_ns: began.elapsed().as_nanos() as u64 })
    }

    /// The constants of all shaders that light.
    pub(super) fn light_constants(&self) -> Vec<(&'static str, u32)> {
        let maps = self.maps.iter().flat_map(MapLayout::constants);
        self.direct.light_constants().into_iter().chain(maps).collect()
    }

    /// What `auto` comes to.
    pub fn resolved(&self) -> BTreeMap<&'static str, String> {
        let buffer = if self.is_uniform { "uniform" } else { "storage" };
        let maps = self.maps.as_ref().map(MapLayout::resolved);
        [("light-buffer", buffer.to_owned())].into_iter().chain(maps).collect()
    }
}

/// The punctual lights, and which of them each object has.
pub struct ListedLights {
    /// As shaders read them.
    pub lights: Vec<LightBlock>,
    pub lists: ObjectLists,
    /// Nanoseconds that listing them took on the host.
    took_ns: u64,
}

impl ListedLights {
    /// The host's pass, with its time in nanoseconds.
    pub fn pass(&self, technique: &str) -> (String, u64) {
        (format!("{technique}.lights"), self.took_ns)
    }

    /// What the host knows of them, for the report's `counters`.
    pub fn counters(&self) -> BTreeMap<&'static str, f64> {
        let [mean, most] = self.lists.lights_per_object();
        let mut counters = BTreeMap::from([
            ("lights", self.lights.len() as f64),
            ("lights_per_object", mean),
            ("lights_per_object_most", most),
            ("objects", self.lists.objects.len() as f64),
        ]);
        counters.extend(blend::counters(&self.lists));
        counters
    }
}
