//! Which virtual point lights a pixel does not see (`--vpl-shadow`), found for all pixels before they are shaded: a bit for each
//! light of a pixel's subset, by shadow rays or by the lights' shadow maps. Segovia 2006, section 4.3 (SSM); the shading of every split
//! skips what is hidden.
//!
//! reads   the G-buffer, the lights      writes  vpl_shadow.hidden  buffer: a word, then for each pixel as many as its lights need
//!
//! Why this way: shading reads a word for 32 lights of many pixels, as fast as without shadows, in every split; what looks for a
//! light has few of them a thread, and its time stands beside the shading's. Maps need not all be held at once: each has its turn, is
//! asked, and is drawn over by another's.

mod maps;
mod rays;
mod reach;
pub mod unrolled;

use super::choices::{Choices, VplShadow};
use super::shade::{ShadeGpu, SubsetLights};
use super::split_method::SplitMethod;
use crate::caps::Limits;
use crate::error::{Error, Result};
use crate::gpu::shader::structs::HiddenParams;
use crate::gpu::shader::techniques::interleaved_deferred::vpl_shadow::hidden::{HIDDEN_HEAD, LIGHTS_A_WORD};
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu};
use crate::passes::direct::DirectGpu;
use crate::passes::gbuffer::{self, GBuffer};
use crate::plan::{Plan, Resources};
use crate::resident::SceneGpu;
use crate::scene::Scene;
use crate::settings::{GeometryChoice, Values};
use crate::techniques::Inputs;
use crate::techniques::interleaved_deferred::resources::NAME;
use maps::HiddenByMaps;
use rays::HiddenByRays;
use std::collections::BTreeMap;
use std::sync::Arc;
use unrolled::MapAtlas;

/// Full name of the buffer of bits.
pub const HIDDEN: &str = "interleaved_deferred.vpl_shadow.hidden";
/// Full names of the image of maps, of their faces' views, and of what the finding shader reads of each.
const MAPS: &str = "interleaved_deferred.vpl_shadow.maps";
const VIEWS: &str = "interleaved_deferred.vpl_shadow.views";
const VPL_MAPS: &str = "interleaved_deferred.vpl_shadow.lights";
/// Row of the memory table.
const GROUP: &str = "vpl_shadow";

/// Turns of a frame at most: each is two passes.
const MOST_TURNS: u32 = 100;
/// Bytes of maps that are held at once where nothing says how many: more buys no time.
const AUTO_BYTES: u64 = 64 << 20;

/// How virtual lights' shadow maps are made and asked.
#[derive(Clone, Copy, Debug)]
pub struct VplMaps {
    pub atlas: MapAtlas,
    slope_bias_px: f32,
    bias_m: f32,
    casters: GeometryChoice,
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
        let asked = values.unless_auto("vpl-shadow-maps", Values::integer).map(|count| count as u32);
        let map_count = asked.unwrap_or_else(|| {
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
            slope_bias_px: values.number("shadow-slope-bias") as f32,
            bias_m: values.length("shadow-bias", scene.lasting_bounds().diagonal().max(1e-6)),
            casters: values.choice("shadow-casters"),
        })
    }

    /// Resolved values.
    pub fn resolved(&self) -> [(&'static str, String); 2] {
        let MapAtlas { size_px, map_count, .. } = self.atlas;
        [("vpl-shadow-size", size_px.to_string()), ("vpl-shadow-maps", map_count.to_string())]
    }
}

/// Lights whose maps are held at once, `first` to `end` of the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Turn {
    index: u32,
    first: u32,
    end: u32,
}

/// All lights are one turn's where no map is held.
fn turns(maps: Option<&VplMaps>, vpl_count: u32) -> impl Iterator<Item = Turn> + use<> {
    let at_once = maps.map_or(vpl_count, |maps| maps.atlas.map_count);
    (0..vpl_count.div_ceil(at_once)).map(move |index| {
        let first = index * at_once;
        Turn { index, first, end: (first + at_once).min(vpl_count) }
    })
}

/// Name of a turn's pass: its number where there are several.
fn of_turn(pass: &str, turn: &Turn, turn_count: usize) -> String {
    if turn_count > 1 { format!("{NAME}.{pass}.{}", turn.index) } else { format!("{NAME}.{pass}") }
}

fn drawing_pass(turn: &Turn, turn_count: usize) -> String {
    of_turn("vpl_maps", turn, turn_count)
}

fn finding_pass(turn: &Turn, turn_count: usize) -> String {
    of_turn("vpl_shadow", turn, turn_count)
}

/// Words that a point has; 0 where nothing is looked for.
pub fn words_a_point(choices: &Choices) -> u32 {
    match choices.vpl_shadow {
        VplShadow::None => 0,
        VplShadow::Ray | VplShadow::Map => choices.most_vpls_a_subset().div_ceil(LIGHTS_A_WORD),
    }
}

/// Points whose lights are looked for, with the padding: pixels, or with `--split subsample` cells of the pattern.
fn point_count(choices: &Choices) -> u64 {
    choices.mapping.sub_texel_count() * u64::from(choices.subset_count())
}

/// Parameters of every pass that writes bits, of all lights.
fn params(choices: &Choices, least_squared: f32) -> HiddenParams {
    HiddenParams {
        mapping: choices.mapping,
        least_squared,
        words_a_point: words_a_point(choices),
        is_of_cells: u32::from(choices.split == SplitMethod::Subsample),
        subset_first: 0,
        word_first: 0,
        light_first: 0,
        light_end: choices.vpl_count,
        _unused: 0,
    }
}

/// Workgroups for all words of all points.
fn groups(choices: &Choices, params: &HiddenParams) -> [u32; 3] {
    let points = choices.mapping.sub_texel_count().div_ceil(u64::from(choices.shading.lane_count()));
    [points as u32, params.words_a_point, choices.subset_count()]
}

/// No light is hidden, before the first pass that finds some.
fn clear(cmd: &mut Commands, hidden: &Buffer) {
    cmd.barriers([hidden.discard(Access::TransferWrite)]);
    cmd.clear(hidden);
    cmd.barriers([hidden.from(Access::TransferWrite).to(Access::ComputeWrite)]);
}

/// Plans the bits and the passes that find them; nothing where nothing stops virtual lights.
pub fn plan(plan: &mut Plan, choices: &Choices) {
    let words = words_a_point(choices);
    if words == 0 {
        return;
    }
    let bytes = 4 * (u64::from(HIDDEN_HEAD) + point_count(choices) * u64::from(words));
    plan.buffer(GROUP, HIDDEN, bytes);
    let maps = choices.vpl_maps.as_ref();
    if let Some(maps) = maps {
        maps::plan(plan, maps, choices.vpl_count);
    }
    let turn_count = turns(maps, choices.vpl_count).count();
    for turn in turns(maps, choices.vpl_count) {
        if maps.is_some() {
            plan.pass(drawing_pass(&turn, turn_count), [(MAPS.to_owned(), Access::DepthWrite)]);
        }
        let cleared = (turn.index == 0).then(|| (HIDDEN.to_owned(), Access::TransferWrite));
        let asked = maps.map(|_| (MAPS.to_owned(), Access::ComputeSample));
        let written = (HIDDEN.to_owned(), Access::ComputeWrite);
        let surface = gbuffer::surface(NAME, choices.shading.position);
        plan.pass(finding_pass(&turn, turn_count), surface.into_iter().chain(asked).chain(cleared).chain([written]));
    }
}

/// The bits, as a pass touches them that shades by `access`.
pub fn read(choices: &Choices, access: Access) -> Option<(String, Access)> {
    (words_a_point(choices) > 0).then(|| (HIDDEN.to_owned(), access))
}

/// Which lights pixels may not see.
pub struct Sought<'a> {
    pub choices: &'a Choices,
    pub lights: &'a SubsetLights,
    /// Square of `--vpl-clamp`, square metres.
    pub least_squared: f32,
}

/// The passes that find them.
pub enum FindHidden {
    Rays(Box<HiddenByRays>),
    Maps(Box<HiddenByMaps>),
}

impl FindHidden {
    /// None where nothing stops virtual lights.
    ///
    /// Errors: the driver refuses, memory (exit code 4).
    pub fn new(
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        scene: &SceneGpu,
        resources: &mut Resources,
        sought: &Sought<'_>,
    ) -> Result<Option<Self>> {
        let Sought { choices, least_squared, .. } = *sought;
        Ok(match (choices.vpl_shadow, choices.vpl_maps) {
            (VplShadow::None, _) => None,
            (_, Some(maps)) => {
                Some(Self::Maps(Box::new(HiddenByMaps::new(gpu, inputs, scene, resources, maps, sought)?)))
            }
            (_, None) => Some(Self::Rays(Box::new(HiddenByRays::new(gpu, choices, least_squared)?))),
        })
    }

    /// Hands the G-buffer on as it leaves it.
    pub fn record<'a>(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        scene: &SceneGpu,
        lights: &ShadeGpu,
        direct: &DirectGpu,
        gbuffer: Edge<'a, GBuffer>,
    ) -> Result<Edge<'a, GBuffer>> {
        let hidden = lights.hidden.as_ref().expect("it is planned with the pass");
        match self {
            Self::Rays(rays) => rays.record(cmd, frame, lights, direct, gbuffer, hidden)?,
            Self::Maps(maps) => maps.record(cmd, frame, scene, lights, gbuffer, hidden)?,
        }
        Ok(gbuffer.after(Access::ComputeSample))
    }

    /// Numbers for the report's `counters`.
    pub fn counters(&self) -> BTreeMap<&'static str, f64> {
        match self {
            Self::Rays(_) => BTreeMap::new(),
            Self::Maps(maps) => maps.counters(),
        }
    }
}
