//! The settings that only this technique reads.

use super::choices::{Effect, PixelPlaces};
use super::members::Drawing;
use super::slices::{PictureDepth, Summation};
use crate::sampling::sampler::Sampler;
use crate::settings::{
    APERTURE, Changes, EMISSIVE, FOCUS, Kind, LIGHT_RADIUS, SHUTTER, Setting, Unread, VOLUME, Values, volume_name,
};

pub const SETTINGS: &[Setting] = &[
    Setting {
        key: "effect",
        kind: Kind::Words(Effect::WORDS),
        default: "aa",
        paper: "Keller 2001, 3",
        help: "What samples are spread over, one or more with commas between: aa, places in their pixels (without it all \
               lie in the middles); motion, the time of --shutter; defocus, the lens of --aperture; soft-shadow, the \
               surfaces of lights (--light-radius, --emissive), by --direct-shadow ray or map; volume, the space between two of \
               the --planes that slice --volume",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "basis",
        kind: Kind::Text("NxM|frame"),
        default: "2x2",
        unit: "px",
        paper: "Keller 2001, 2.1",
        help: "Width and height of the basis pattern that repeats over the frame, 1 or more with up to two decimal places \
               (2.5x1.75: pixels then hold different numbers of samples); 1x1 is the accumulation buffer, the same \
               samples in every pixel, and frame the other end, none of which repeats",
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "samples",
        kind: Kind::Number { min: 0.01, max: 256.0 },
        default: "4",
        paper: "Keller 2001, 2.1",
        help: "Samples a pixel in the mean: a basis has as many as its pixels times that, rounded, each of which is a \
               member, drawn as a small picture of its own",
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "sampler",
        kind: Kind::Choice(Sampler::WORDS),
        default: "relaxed",
        paper: "Keller 2001, 2.2",
        help: "How the samples of a basis are spread: relaxed, blue noise that tiles (the paper's); sobol, one scrambled \
               sequence; r2, the generalised golden ratio's; jittered, one in each of equal cells; random; and for whole \
               pixels ign, turned by interleaved gradient noise; void-and-cluster, by blue noise masks; blue-errors, \
               Sobol's with errors that differ between neighbours",
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "members",
        kind: Kind::Choice(Drawing::WORDS),
        default: "layers",
        paper: "Keller 2001, 3.1",
        help: "How members are drawn, the same samples: layers, each as a small picture whose samples are scattered to their \
               pixels; stipple, each as a small picture that textures a polygon over the frame behind a stipple pattern (the \
               paper's); tuples, each over the whole frame with the pixels of others masked (whole sides of the basis); \
               sample-locations, several at once as samples of the device's, masked likewise (--effect aa, on devices with \
               VK_EXT_sample_locations: the paper's proposal for hardware)",
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "places",
        kind: Kind::Choice(PixelPlaces::WORDS),
        auto: true,
        default: "auto",
        paper: "Keller 2001, 3.1",
        help: "Where in their pixels samples may lie: free, anywhere; sixteenths, at the nearest sixteenth of a pixel, as \
               hardware has them (whole sides of the basis); auto: sixteenths with --members sample-locations, else free",
        unread: |values| unless(values, Effect::Aa, "--effect aa", "all samples lie in the middles of their pixels"),
        ..Setting::changing(Changes::Samples)
    },
    Setting { unread: |values| unless(values, Effect::Volume, "--effect volume", "volumes are not drawn"), ..VOLUME },
    Setting {
        key: "planes",
        kind: Kind::Integer { min: 1, max: 4096 },
        default: "60",
        paper: "Keller 2001, 3.3",
        help: "Planes of each member that slice --volume, between its nearest and its farthest place before the camera",
        ..OF_SLICES
    },
    Setting {
        key: "depth",
        kind: Kind::Choice(PictureDepth::WORDS),
        default: "float",
        unit: "bits a channel",
        paper: "Keller 2001, 3.3",
        help: "What planes add up in: 8 (the paper's frame buffer, which rounds light, 0 to 1, to 255 steps at every \
               plane), half (floats of 16 bits, as the device rounds them) or float (of 32)",
        ..OF_SLICES
    },
    Setting {
        key: "summation",
        kind: Kind::Choice(Summation::WORDS),
        default: "plain",
        paper: "Keller 2001, 3.3",
        help: "How planes add up: plain, each over all that lie behind it; hierarchical, in groups of about the root of \
               their number, which are laid over one another",
        ..OF_SLICES
    },
    Setting {
        help: "Diameter of the camera's thin lens, which blurs what is out of focus; --effect defocus wants one",
        unread: |values| unless(values, Effect::Defocus, "--effect aa,defocus", "nothing is spread over the lens"),
        ..APERTURE
    },
    Setting { unread: |values| Unread::without(values, APERTURE.key, "through a pinhole all is sharp"), ..FOCUS },
    Setting {
        unread: |values| unless(values, Effect::Motion, "--effect aa,motion", "all samples are of one moment"),
        ..SHUTTER
    },
    Setting {
        unread: |values| unless(values, Effect::SoftShadow, "--effect aa,soft-shadow", "lights are points"),
        ..LIGHT_RADIUS
    },
    Setting {
        help: "Whether emissive surfaces light others, as many hard lights with soft shadows (--effect soft-shadow); \
               auto: where the scene has no punctual light",
        unread: |values| {
            unless(values, Effect::SoftShadow, "--effect aa,soft-shadow", "emissive surfaces light nothing")
                .or_else(|| Unread::unless(values, "direct-shadow", &["ray", "map"], "lamps cast no shadows"))
        },
        ..EMISSIVE
    },
];

/// What rows of the slices have in common.
const OF_SLICES: Setting = Setting {
    unread: |values| {
        let without_volume = || Unread::at(values, VOLUME.key, "--volume head", "there is none to slice");
        unless(values, Effect::Volume, "--effect volume", "no volume is sliced")
            .or_else(|| volume_name(values).is_none().then(without_volume))
    },
    ..Setting::changing(Changes::Picture)
};

/// Why a setting is not read where `effect` is not among `--effect`.
fn unless(values: &Values, effect: Effect, instead: &'static str, why: &'static str) -> Option<Unread> {
    (!effect.is_chosen(values)).then(|| Unread::at(values, "effect", instead, why))
}
