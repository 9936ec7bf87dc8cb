//! The settings of path tracing.

use crate::choice::choices;
use crate::resident::traced::TexelLevels;
use crate::settings::{
    APERTURE, BRDF, Changes, EMISSIVE, FOCUS, Kind, LIGHT_RADIUS, MEDIUM, SHUTTER, STEREO, STEREO_EYES, Setting,
    Unread, VOLUME, VPL_BRDF, VPL_CLAMP, WORKGROUP, volume_name,
};
use crate::shading::medium::Medium;
use crate::techniques::until_error::MOST_SAMPLES;

/// Paths a pixel where nothing says how many.
pub const DEFAULT_SAMPLES: u32 = 64;

choices! {
    /// Light that is counted (`--transport`).
    pub enum Transport {
        "direct" => Direct,
        "one-bounce" => OneBounce,
        "single-scatter" => SingleScatter,
        "full" => Full,
    }
}

choices! {
    /// Which surfaces light from all around finds, as rays do (`--ambient-visibility`).
    pub enum AmbientVisibility {
        "on" => On,
        "off" => Off,
        /// The surface that is seen alone.
        "seen" => Seen,
    }
}

choices! {
    /// Where a medium scatters light (`--airlight`).
    pub enum Airlight {
        /// Anywhere on a path, as often as the transport says.
        "path" => Path,
        /// On the ray that is seen, once.
        "seen" => Seen,
        /// Nowhere: it dims.
        "none" => None,
    }
}

choices! {
    /// What rays are traced through (`--rays`).
    pub enum RaySource {
        /// A tree built by this program and walked by the shader.
        "tree" => Tree,
        /// The driver's own acceleration structure.
        "query" => Query,
    }
}

choices! {
    /// Where in a pixel rays from the camera leave (`--pixel`).
    pub enum PixelPlace {
        "box" => Box,
        "middle" => Middle,
    }
}

/// Its rows of the table.
pub const SETTINGS: &[Setting] = &[
    Setting {
        key: "spp",
        kind: Kind::Integer { min: 1, max: MOST_SAMPLES as u64 },
        auto: true,
        default: "auto",
        help: "Paths a pixel, one each time the frame is run; with --until-error, the most; auto: 64, with \
               --until-error 65536",
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "until-error",
        kind: Kind::Number { min: 0.0, max: 1.0 },
        default: "0",
        help: "Estimated relative standard error of the pixels (root of the mean square) at which rendering stops, if \
               --spp is not reached before; 0: never, all of --spp is used",
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "pixel",
        kind: Kind::Choice(PixelPlace::WORDS),
        default: "box",
        help: "Where in a pixel rays from the camera leave: box, anywhere in it, so that edges are smooth; middle, in its \
               middle, so that they are as jagged as without anti-aliasing",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "transport",
        kind: Kind::Choice(Transport::WORDS),
        default: "full",
        help: "Light that is counted: what reaches the visible surfaces straight from lights (direct), or by one \
               surface more too (one-bounce); what is scattered once, by a surface or by --medium (single-scatter); or \
               what is scattered by either as often as --bounces says (full). The first two are dimmed by --medium, \
               and lose what it scatters",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "airlight",
        kind: Kind::Choice(Airlight::WORDS),
        default: "path",
        paper: "Dubla 2009, 3.4",
        help: "Light that --medium scatters: at any place of a path, as often as --transport says (path); or once, from \
               lights straight into the ray that is seen, with any --transport (seen); or none, so that it dims alone",
        unread: |values| {
            // What `auto` comes to is the scene's to say: see `Air::new`.
            let is_none = Medium::asked(values) == Some(None);
            is_none.then(|| Unread::at(values, "medium", "--medium 0.1,0,0", "nothing scatters on the way"))
        },
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "bounces",
        kind: Kind::Integer { min: 1, max: 64 },
        default: "16",
        help: "Most surfaces, or places of --medium, that scatter a path with --transport full; from the fourth on it \
               may end by chance, unbiased",
        unread: |values| {
            Unread::unless(values, "transport", &[Transport::Full], "it fixes how often light is scattered")
        },
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "direct-light",
        kind: Kind::Choice(&["on", "off"]),
        default: "on",
        help: "Whether light is counted that comes straight from lights, emissive surfaces or the surroundings to the \
               surface that is seen; off: only what other surfaces, or --medium, have scattered before",
        unread: |values| {
            Unread::with(values, "transport", &[Transport::Direct], "there is no other light")
                .filter(|_| !values.is("airlight", Airlight::Seen))
                .filter(|_| !values.is("ambient-visibility", AmbientVisibility::Seen))
        },
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "light-visibility",
        kind: Kind::Choice(&["on", "off"]),
        default: "on",
        help: "Whether the scene's own lights cast shadows; off: they shine through everything",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "vpl-visibility",
        kind: Kind::Choice(&["on", "off"]),
        default: "on",
        paper: "Segovia 2006, 6.2",
        help: "Whether light between surfaces is stopped by what stands between them; off: the light that infinitely \
               many virtual point lights without shadows would give, by --vpl-brdf and with --vpl-clamp, from a \
               separate light walk for each pixel",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "ambient-visibility",
        kind: Kind::Choice(AmbientVisibility::WORDS),
        default: "on",
        help: "Light surfaces from all around by --ambient and --background, as light that other surfaces stop and \
               scatter; off: as in all other techniques, each visible surface reflects all of --ambient, which goes no \
               further, and --background is seen but lights nothing; seen: as off, but other surfaces stop --ambient",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "punctual",
        kind: Kind::Choice(&["on", "off"]),
        default: "on",
        help: "Whether point, spot and directional lights shine; off: emissive triangles light the scene even where \
               --emissive is auto",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "rays",
        kind: Kind::Choice(RaySource::WORDS),
        default: "tree",
        help: "What rays are traced through: a tree built by this program and walked by the shader (tree); or the \
               driver's own acceleration structure, by ray queries, where the device has them (query). The same \
               picture, except for rays that graze an edge",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "texture-level",
        kind: Kind::Choice(TexelLevels::WORDS),
        default: "0",
        help: "Mip level of textures that rays read: 0, the finest, which the paths of a pixel average; or the one \
               whose texels are as wide as the ray's cone, which needs fewer paths, blurs surfaces seen at a slant \
               (less with --anisotropy), and takes a third more memory",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "volume-steps",
        kind: Kind::Number { min: 0.1, max: 64.0 },
        default: "4",
        paper: "Keller 2001, 3.3",
        help: "Steps of a ray for each voxel of --volume that it passes; the volume is seen by rays from the camera alone, \
               and casts no shadow",
        unread: |values| {
            volume_name(values).is_none().then(|| Unread::at(values, VOLUME.key, "--volume head", "there is no volume"))
        },
        ..Setting::changing(Changes::Picture)
    },
    VOLUME,
    APERTURE,
    FOCUS,
    STEREO,
    STEREO_EYES,
    SHUTTER,
    MEDIUM,
    LIGHT_RADIUS,
    EMISSIVE,
    VPL_CLAMP,
    Setting {
        unread: |values| {
            Unread::with(values, "vpl-visibility", &["on"], "light between surfaces is scattered by --brdf")
        },
        ..VPL_BRDF
    },
    BRDF,
    WORKGROUP,
];
