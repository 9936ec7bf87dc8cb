//! Shadow maps that are held at once, and the turns that lights take; the names of what all this is kept in.

use super::unrolled::{MapAtlas, MapIndex, MapShape};
use crate::caps::Limits;
use crate::error::{Error, Result};
use crate::resident::coarse;
use crate::scene::Scene;
use crate::settings::{GeometryChoice, Values};
use crate::techniques::interleaved_deferred::resources::NAME;

/// Full name of the buffer of bits.
pub const HIDDEN: &str = "interleaved_deferred.vpl_shadow.hidden";
/// Full names of the image of maps, of their faces' views, and of what the finding shader reads of each.
pub(super) const MAPS: &str = "interleaved_deferred.vpl_shadow.maps";
pub(super) const VIEWS: &str = "interleaved_deferred.vpl_shadow.views";
pub(super) const VPL_MAPS: &str = "interleaved_deferred.vpl_shadow.lights";
/// Full name of the list of coarser triangles' indices.
pub(super) const INDICES: &str = "interleaved_deferred.vpl_shadow.indices";
/// Row of the memory table.
pub(super) const GROUP: &str = "vpl_shadow";

/// Turns of a frame at most: each is two passes.
const MOST_TURNS: u32 = 100;
/// Bytes of maps that are held at once where nothing says how many: more buys no time.
const AUTO_BYTES: u64 = 64 << 20;

/// How virtual lights' shadow maps are made and asked.
#[derive(Clone, Copy, Debug)]
pub struct VplMaps {
    pub atlas: MapAtlas,
    pub(super) index: MapIndex,
    pub(super) slope_bias_px: f32,
    pub(super) bias_m: f32,
    pub(super) casters: GeometryChoice,
    /// Texels that a surface in a map may be off by.
    pub(super) detail_px: f32,
    /// Indices that coarser triangles have room for; 0 where everything is drawn as it is.
    coarse_index_count: u64,
}

impl VplMaps {
    /// What `values` ask for. `room_bytes`: what memory has beside all else.
    ///
    /// Errors: so few maps at once that they take more turns than a frame has passes for (exit code 2, or 4 where memory says how
    /// many).
    pub fn new(values: &Values, scene: &Scene, limits: &Limits, room_bytes: u64) -> Result<Self> {
        let (shape, size_px) = (values.choice("vpl-shadow-shape"), values.integer("vpl-shadow-size") as u32);
        let size_px = size_px.next_multiple_of(2);
        let vpl_count = values.integer("vpls") as u32;
        let most = MapAtlas::most(shape, size_px, limits.max_image_side_px, limits.max_image_layers).min(vpl_count);
        let of = |map_count| MapAtlas::new(shape, size_px, map_count, limits.max_image_side_px);
        // Layers have no index.
        let index = if shape == MapShape::Layers { MapIndex::Arithmetic } else { values.choice("vpl-shadow-index") };
        let casters: GeometryChoice = values.choice("shadow-casters");
        let detail_px = values.number("vpl-shadow-detail") as f32;
        let is_coarse = casters == GeometryChoice::Culled && detail_px > 0.0;
        let coarse_index_count = if is_coarse { coarse::most_indices(scene) } else { 0 };
        let asked = values.unless_auto("vpl-shadow-maps", Values::integer).map(|count| count as u32);
        let map_count = asked.unwrap_or_else(|| {
            let index_bytes = if index == MapIndex::CubeMap { of(1).index_description().bytes() } else { 0 };
            let room_bytes = room_bytes.saturating_sub(index_bytes + coarse_bytes(coarse_index_count));
            let bytes = AUTO_BYTES.min(room_bytes).min(limits.max_allocation_bytes);
            (bytes / of(1).description().bytes()).clamp(1, u64::from(most)) as u32
        });
        let map_count = map_count.min(most);
        let turn_count = vpl_count.div_ceil(map_count);
        if turn_count > MOST_TURNS {
            let what = format!(
                "--vpl-shadow map: {vpl_count} virtual lights, {map_count} maps of {size_px} texels at once: that takes {turn_count} \
                 turns, and a frame has at most {MOST_TURNS}"
            );
            let error = if asked.is_some() { Error::request(what) } else { Error::memory(what) };
            return Err(
                error.note("fewer --vpls, a smaller --vpl-shadow-size, more --vpl-shadow-maps or --vpl-shadow ray")
            );
        }
        Ok(Self {
            atlas: of(map_count),
            index,
            detail_px,
            coarse_index_count,
            slope_bias_px: values.number("shadow-slope-bias") as f32,
            bias_m: values.length("shadow-bias", scene.lasting_bounds().diagonal().max(1e-6)),
            casters,
        })
    }

    /// Bytes of the index list of coarser triangles, where there may be any.
    pub(super) fn coarse_bytes(&self) -> Option<u64> {
        (self.coarse_index_count > 0).then(|| coarse_bytes(self.coarse_index_count))
    }

    /// The axis MAPS of maps.comp.
    pub(super) fn axis(&self) -> &'static str {
        match self.index {
            MapIndex::Arithmetic => self.atlas.shape.name(),
            MapIndex::CubeMap => "indexed",
        }
    }

    /// Resolved values.
    pub fn resolved(&self) -> [(&'static str, String); 2] {
        let MapAtlas { size_px, map_count, .. } = self.atlas;
        [("vpl-shadow-size", size_px.to_string()), ("vpl-shadow-maps", map_count.to_string())]
    }
}

fn coarse_bytes(index_count: u64) -> u64 {
    index_count * size_of::<u32>() as u64
}

/// Lights whose maps are held at once, `first` to `end` of the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Turn {
    pub index: u32,
    /// Turns of the frame.
    pub count: u32,
    pub first: u32,
    pub end: u32,
}

/// All lights are one turn's where no map is held.
pub(super) fn turns(maps: Option<&VplMaps>, vpl_count: u32) -> impl Iterator<Item = Turn> + use<> {
    let at_once = maps.map_or(vpl_count, |maps| maps.atlas.map_count);
    let count = vpl_count.div_ceil(at_once);
    (0..count).map(move |index| {
        let first = index * at_once;
        Turn { index, count, first, end: (first + at_once).min(vpl_count) }
    })
}

/// Name of a turn's pass: its number where there are several.
fn of_turn(pass: &str, turn: &Turn) -> String {
    if turn.count > 1 { format!("{NAME}.{pass}.{}", turn.index) } else { format!("{NAME}.{pass}") }
}

pub(super) fn drawing_pass(turn: &Turn) -> String {
    of_turn("vpl_maps", turn)
}

pub(super) fn finding_pass(turn: &Turn) -> String {
    of_turn("vpl_shadow", turn)
}
