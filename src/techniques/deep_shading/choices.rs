//! What the settings come to.

use super::baseline::Shading;
use super::middle::Middle;
use super::space::ShadingSpace;
use super::tuples::Table;
use super::{NAME, shade::Road};
use crate::error::{Error, Result};
use crate::gpu::Caps;
use crate::lens::Lens;
use crate::lights::LightSet;
use crate::passes::direct::DirectSettings;
use crate::passes::shadow_maps::MapLayout;
use crate::resident::GeometryChoice;
use crate::settings::Values;
use crate::techniques::Inputs;
use crate::units::Extent;

pub struct Choices {
    pub shading: Shading,
    pub direct: DirectSettings,
    pub table: Table,
    /// Sets of samples that the picture is the mean of.
    pub run_count: u32,
    pub space: ShadingSpace,
    /// None: a pinhole.
    pub lens: Option<Lens>,
    /// The scene is another one when the shutter closes.
    pub is_moving: bool,
    /// Samples are tested by a shader instead of the rasteriser.
    pub is_stochastic: bool,
    pub has_lists: bool,
    pub tolerates_duplicates: bool,
    pub is_compacted: bool,
    pub has_zmax: bool,
    pub has_addresses: bool,
    pub is_counted: bool,
    pub road: Road,
    pub geometry: GeometryChoice,
    /// The scene where it is shaded; None: nothing moves.
    pub middle: Option<Middle>,
    /// With `--direct-shadow map`.
    pub maps: Option<MapLayout>,
}

/// `--conservative`, `auto` resolved.
pub fn road(values: &Values, caps: &Caps) -> Road {
    match values.text("conservative") {
        "hardware" => Road::Hardware,
        "geometry" => Road::Geometry,
        "vertex" => Road::Vertex,
        _ if caps.features.conservative_rasterization => Road::Hardware,
        _ if caps.features.geometry_shader => Road::Geometry,
        _ => Road::Vertex,
    }
}

impl Choices {
    /// Errors: `--tuples` is no multiple of `--spp`; shading space is too large; settings that `--shading` does not read (exit
    /// code 2).
    pub fn new(inputs: &Inputs<'_>) -> Result<Self> {
        let values = inputs.values;
        let samples = values.integer("spp") as u32;
        let shading = Shading::new(values, inputs.caps, samples).map_err(|error| error.within(NAME))?;
        let tuples = values.integer_or_auto("tuples").map_or(4 * samples, |tuples| tuples as u32);
        if !tuples.is_multiple_of(samples) {
            return Err(Error::request(format!("--tuples {tuples}: it must be a multiple of --spp {samples}"))
                .within(NAME)
                .note(format!("--tuples {} works", tuples.next_multiple_of(samples))));
        }
        let has_lists = shading == Shading::Deep && values.text("lists") != "none";
        let is_compacted = has_lists && values.is_on("compaction");
        let lens = if values.number("aperture") > 0.0 {
            Lens::new(values, inputs.view, inputs.scene, inputs.bvh.whole(inputs.scene)?)
        } else {
            None
        };
        let middle = Middle::new(inputs)?;
        let (scene, lights) =
            middle.as_ref().map_or((inputs.scene, inputs.lights), |middle| (&middle.scene, &middle.lights));
        let maps = MapLayout::new(values, lights, scene, inputs.stats, inputs.caps, inputs.requirements);
        Ok(Self {
            shading,
            maps: maps.map_err(|error| error.within(NAME))?,
            direct: DirectSettings::new(values, inputs.lights, inputs.scene),
            table: Table::new(samples, tuples),
            run_count: values.integer("accumulate") as u32,
            space: ShadingSpace::new(values, inputs.view.extent).map_err(|error| error.within(NAME))?,
            lens,
            is_moving: middle.is_some(),
            is_stochastic: matches!(shading, Shading::Msaa { .. }) || values.text("visibility") == "stochastic",
            middle,
            has_lists,
            tolerates_duplicates: values.text("duplicates") == "tolerated",
            is_compacted,
            has_zmax: has_lists && values.is_on("zmax"),
            has_addresses: has_lists && values.is_on("address-buffer"),
            is_counted: values.is_on("instrument"),
            road: road(values, inputs.caps),
            geometry: GeometryChoice::from_setting(values.text("geometry")),
        })
    }

    /// The lights that shade: those in the middle of the exposure.
    pub fn lights<'a>(&'a self, inputs: &Inputs<'a>) -> &'a LightSet {
        self.middle.as_ref().map_or(inputs.lights, |middle| &middle.lights)
    }

    /// Something is seen from elsewhere than shading space shows it from.
    pub fn is_blurred(&self) -> bool {
        self.lens.is_some() || self.is_moving
    }

    /// Samples are shaded where they are seen: all of them, or those that blur brings in from outside shading space.
    pub fn has_brute(&self) -> bool {
        !self.has_lists || self.is_blurred()
    }

    /// The name of that pass.
    pub fn brute_pass(&self) -> &'static str {
        if self.has_lists { "strays" } else { "brute" }
    }

    /// Samples of one set, padding included.
    pub fn samples_of(&self, frame: Extent) -> u64 {
        self.table.layer(frame).pixel_count() * u64::from(self.table.tuple_count())
    }

    /// Constants that several shaders have.
    pub fn constants(&self) -> Vec<(&'static str, u32)> {
        let mut constants = self.direct.light_constants().to_vec();
        constants.extend(self.maps.iter().flat_map(MapLayout::constants));
        constants.extend([
            ("IS_MOVING", u32::from(self.is_moving)),
            ("HAS_LENS", u32::from(self.lens.is_some())),
            ("TOLERATES_DUPLICATES", u32::from(self.tolerates_duplicates)),
            ("IS_COMPACTED", u32::from(self.is_compacted)),
            ("IS_COUNTED", u32::from(self.is_counted)),
            ("PASS_SAMPLES", self.shading.pass_samples()),
        ]);
        constants
    }
}
