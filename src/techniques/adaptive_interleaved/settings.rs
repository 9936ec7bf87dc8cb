//! The settings of adaptive interleaved sampling.

use crate::choice::choices;
use crate::sampling::sampler::Sampler;
use crate::settings::{
    Changes, EMISSIVE, GEOMETRY, Kind, LIGHT_RADIUS, MEDIUM, NORMAL_THRESHOLD, POSITION, POSITION_THRESHOLD, Setting,
    TEXELS, Unread, VPL_CLAMP, Values, WORKGROUP,
};

choices! {
    /// A component of the light (`--components`).
    pub enum Component {
        /// Indirect diffuse light.
        "id" => Id,
        /// Soft shadows: light straight from area lights and punctual ones.
        "ss" => Ss,
        /// Airlight: what a medium scatters once.
        "pm" => Pm,
        /// Ambient occlusion: light from all around that no surface stops.
        "ao" => Ao,
    }
}

choices! {
    /// Which tiles refine, and how far (`--mode`).
    pub enum Mode {
        /// Those that the guidance names (AIS).
        "adaptive" => Adaptive,
        /// All, to the most (A-MAX).
        "max" => Max,
        /// None: interleaved sampling alone (IGI).
        "igi" => Igi,
    }
}

choices! {
    /// What of several lights guides soft shadows (`--ss-guidance`).
    pub enum Guidance {
        /// The lights that tell a tile's pixels apart.
        "each" => Each,
        /// The mean over all of them.
        "mean" => Mean,
    }
}

choices! {
    /// How the refinement finds its tiles (`--refine`).
    pub enum Refine {
        /// A list of them is made on the device, and a dispatch goes over it.
        "indirect" => Indirect,
        /// One pass, in which each tile goes on as long as it must.
        "fused" => Fused,
    }
}

choices! {
    /// Which texels threads that lie together have (`--ray-order`).
    pub enum RayOrder {
        /// Those of a tile, each with its own samples.
        "tile" => Tile,
        /// Those of one place in neighbouring tiles, which have the same samples.
        "slot" => Slot,
    }
}

choices! {
    /// What beside a tile says how far it is refined (`--guidance-of`).
    pub enum GuidanceOf {
        /// Nothing: the paper's.
        "tile" => Tile,
        /// The eight tiles around it.
        "neighbours" => Neighbours,
        /// What other components ask for over the same pixels.
        "components" => Components,
    }
}

choices! {
    /// Which virtual lights a pixel looks at (`--id-choice`).
    pub enum LightChoice {
        /// Those of its own subset.
        "even" => Even,
        /// As many of all of them, by what each would give if nothing hid it.
        "contribution" => Contribution,
    }
}

choices! {
    /// What estimates the components (`--trace`).
    pub enum Trace {
        /// Compute shaders.
        "device" => Device,
        /// Threads of the host.
        "host" => Host,
    }
}

/// Largest side of a tile, px: 64 of its pixels are a workgroup.
pub const MOST_TILE_PX: u32 = 8;

/// Its rows of the table.
pub const SETTINGS: &[Setting] = &[
    Setting {
        key: "components",
        kind: Kind::Words(Component::WORDS),
        auto: true,
        default: "auto",
        paper: "Dubla 2009, 3",
        help: "Light that is estimated, each with its own samples, guidance and filter: indirect diffuse light from \
               virtual point lights (id), soft shadows of area lights and hard ones of punctual lights (ss), light that \
               --medium scatters once, into the ray that is seen (pm), --ambient that no surface stops (ao); auto: id, \
               ss where anything shines, and pm where --medium scatters it. Without pm a medium dims alone, and without ao \
               nothing stops --ambient",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "mode",
        kind: Kind::Choice(Mode::WORDS),
        default: "adaptive",
        paper: "Dubla 2009, 4.2",
        help: "Tiles to refine: those in which the initial pass found a need (adaptive), all of them to the most \
               iterations (max), or none (igi, interleaved sampling as Wald 2002 has it)",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "tile",
        symbol: "N x M",
        kind: Kind::Pair { min: 1, max: MOST_TILE_PX },
        default: "3x3",
        unit: "px",
        paper: "Dubla 2009, 4.2",
        help: "Size of a tile: its pixels have samples of their own, decide together whether they need more, and are \
               the box of the filter",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "base",
        kind: Kind::Integer { min: 1, max: 64 },
        default: "1",
        paper: "Dubla 2009, 4.2",
        help: "Iterations of the initial pass, of each component",
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "id-max",
        kind: Kind::Integer { min: 1, max: 64 },
        default: "9",
        paper: "Dubla 2009, 4.2 (IDmaxSamples)",
        help: "Most iterations of indirect light, the initial pass's included: subsets of the virtual point lights \
               that a pixel is lit by; at most the pixels of --tile, with as many every light is counted",
        unread: |values| without(values, Component::Id),
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "id-scale",
        kind: Kind::Integer { min: 1, max: 4 },
        auto: true,
        default: "auto",
        paper: "Dubla 2009, 4.1",
        help: "Indirect light is estimated at each pixel (1), or at each second, third or fourth in both directions and \
               upsampled, guided by normals and positions; auto: 2, a quarter of the pixels, and 1 with --mode igi, as \
               the paper compares them",
        unread: |values| without(values, Component::Id),
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "ss-max",
        kind: Kind::Integer { min: 1, max: 64 },
        default: "9",
        paper: "Dubla 2009, 4.2 (SSmaxSamples)",
        help: "Most iterations of soft shadows, the initial pass's included: points of each area light that a pixel \
               sends shadow rays to",
        unread: |values| without(values, Component::Ss),
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "sampler",
        kind: Kind::Choice(Sampler::WORDS),
        default: "sobol",
        paper: "Keller 2001, 2.2",
        help: "How points of area lights and directions of --components ao are spread over the pixels of a tile and their \
               iterations: sobol, one scrambled sequence, a stretch of it an iteration; or all iterations' alike by relaxed, \
               numbers that differ where pixels are near; r2, the generalised golden ratio's; jittered, one in each of equal cells; \
               random; ign, turned by interleaved gradient noise; void-and-cluster, by blue noise masks; blue-errors, Sobol's \
               with errors that differ between neighbours",
        unread: |values| without_all(values, &[Component::Ss, Component::Pm, Component::Ao]),
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "until-error",
        kind: Kind::Number { min: 0.0, max: 1.0 },
        default: "0",
        help: "Relative standard error of a tile's mean at which it is refined no more, as far as its own pixels tell in \
               the initial pass; 0: tiles are refined by what their rays met, as in the paper",
        unread: |values| Unread::unless(values, "mode", &[Mode::Adaptive], "no tile is asked"),
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "guidance-of",
        kind: Kind::Choice(GuidanceOf::WORDS),
        default: "tile",
        paper: "Dubla 2009, 4.1",
        help: "Whose need refines a tile: its own (tile, the paper's); the most that it and the eight tiles around it have \
               (neighbours); or that it and the tiles of other components over the same pixels have (components)",
        unread: |values| {
            Unread::unless(values, "mode", &[Mode::Adaptive], "no tile is guided")
                .or_else(|| Unread::unless(values, "refine", &[Refine::Indirect], "a tile knows no other"))
                .or_else(|| Unread::unless(values, "trace", &[Trace::Device], "a tile knows no other"))
        },
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "ss-guidance",
        kind: Kind::Choice(Guidance::WORDS),
        default: "each",
        paper: "Dubla 2009, 3.3, Listing 3",
        help: "Tiles that soft shadows refine: those in the penumbra of any light, by the part of these lights that is \
               hidden (each); or those in which some of all lights are hidden and others not (mean, the paper's, which \
               is the same under one light). More than 31 lights share what tells them apart",
        unread: |values| {
            without(values, Component::Ss)
                .or_else(|| Unread::unless(values, "mode", &[Mode::Adaptive], "no tile is guided"))
        },
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "ss-lights",
        kind: Kind::Integer { min: 1, max: 1024 },
        default: "16",
        help: "Most area lights that each have points of their own: connected emissive surfaces, the most powerful \
               first; all that are left are one more light",
        unread: |values| without_all(values, &[Component::Ss, Component::Pm]),
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "pm-max",
        kind: Kind::Integer { min: 1, max: 64 },
        default: "9",
        paper: "Dubla 2009, 4.2 (PMmaxSamples)",
        help: "Most marches of a pixel through the medium, the initial pass's included, each with places of its own",
        unread: |values| without(values, Component::Pm),
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "pm-steps",
        kind: Kind::Integer { min: 1, max: 1024 },
        default: "16",
        paper: "Dubla 2009, 3.4",
        help: "Steps of a march as long as the diagonal of the medium's box: one place in each is looked at, and the \
               pixels of a tile divide a step among them",
        unread: |values| without(values, Component::Pm),
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "pm-distance",
        kind: Kind::Number { min: 0.0, max: 1e6 },
        default: "1",
        unit: "m",
        paper: "Dubla 2009, 4.2 and Listing 4, line 9",
        help: "Distance from a light, less what a metre of the medium stops, within which a place is in its halo: tiles \
               whose pixels have unlike parts in one are refined",
        unread: |values| {
            without(values, Component::Pm)
                .or_else(|| Unread::unless(values, "mode", &[Mode::Adaptive], "no tile is guided"))
        },
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "ao-max",
        kind: Kind::Integer { min: 1, max: 64 },
        default: "9",
        help: "Most iterations of ambient occlusion, the initial pass's included: rays of a pixel, each over the whole \
               hemisphere",
        unread: |values| Unread::unlisted(values, "components", Component::Ao.name(), "it is not estimated"),
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "vpls",
        kind: Kind::Integer { min: 1, max: 65_536 },
        default: "256",
        paper: "Dubla 2009, 4.2",
        help: "Number of virtual point lights, made by Instant Radiosity; each pixel of a tile begins with its share",
        unread: |values| without(values, Component::Id),
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "vpl-bounces",
        kind: Kind::Integer { min: 1, max: 16 },
        default: "1",
        help: "Most surfaces that one light walk lands on",
        unread: |values| without(values, Component::Id),
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "id-choice",
        kind: Kind::Choice(LightChoice::WORDS),
        default: "even",
        help: "Virtual point lights that a pixel looks at in an iteration: its own subset of them (even, the paper's); or \
               as many of all of them, drawn by what each would give it if nothing hid it (contribution)",
        unread: |values| without(values, Component::Id),
        ..Setting::changing(Changes::Samples)
    },
    Setting { unread: |values| without(values, Component::Id), ..VPL_CLAMP },
    EMISSIVE,
    LIGHT_RADIUS,
    MEDIUM,
    Setting {
        key: "refine",
        kind: Kind::Choice(Refine::WORDS),
        default: "indirect",
        help: "How tiles that refine come to their threads: listed on the device, those with most iterations first, \
               and dispatched from there (indirect); or in the initial pass itself, each tile going on as long as it \
               must (fused); the same picture",
        unread: |values| {
            Unread::unless(values, "trace", &[Trace::Device], "the host's threads take tiles as they come")
        },
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "ray-order",
        kind: Kind::Choice(RayOrder::WORDS),
        default: "slot",
        paper: "Segovia 2006, 3",
        help: "Which texels threads that lie together have: those of a tile, each of which looks at other lights (tile); \
               or those of one place in neighbouring tiles, whose rays go to the same lights from near places (slot); the \
               same picture",
        unread: |values| {
            Unread::unless(values, "refine", &[Refine::Indirect], "a tile's threads decide together")
                .or_else(|| Unread::unless(values, "trace", &[Trace::Device], "a thread of the host has whole tiles"))
        },
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "trace",
        kind: Kind::Choice(Trace::WORDS),
        default: "device",
        paper: "Dubla 2009, 4.1",
        help: "What estimates the components, in each frame: the device (device), or the host's threads, a tile each, which \
               find by rays what each pixel sees, too (host, as the paper has it); the same samples, and the same picture \
               but for rounding and where textures are read from coarser levels",
        ..Setting::changing(Changes::Picture)
    },
    NORMAL_THRESHOLD,
    POSITION_THRESHOLD,
    POSITION,
    GEOMETRY,
    TEXELS,
    WORKGROUP,
];

/// Those of `--components`; None: `auto`.
pub fn listed(values: &Values) -> Option<Vec<Component>> {
    values.unless_auto("components", Values::listed)
}

/// Some where none of them is estimated.
fn without_all(values: &Values, components: &[Component]) -> Option<Unread> {
    components.iter().map(|component| without(values, *component)).reduce(Option::and).flatten()
}

fn without(values: &Values, component: Component) -> Option<Unread> {
    listed(values)?;
    Unread::unlisted(values, "components", component.name(), "it is not estimated")
}
