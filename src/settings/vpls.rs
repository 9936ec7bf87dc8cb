//! The rows of what virtual point lights do to a surface, which several techniques read.

use super::{Brdf, Changes, Kind, Setting};

/// How near virtual point lights count.
pub const VPL_CLAMP: Setting = Setting {
    key: "vpl-clamp",
    kind: Kind::Length,
    default: "2%",
    unit: "m",
    help: "Least distance at which a virtual point light is evaluated; surfaces nearer than this get no more light",
    ..Setting::changing(Changes::Picture)
};

/// How surfaces scatter the light of virtual point lights towards the eye.
pub const VPL_BRDF: Setting = Setting {
    key: "vpl-brdf",
    kind: Kind::Choice(&[Brdf::Lambert.name(), Brdf::Ggx.name()]),
    default: "lambert",
    paper: "Segovia 2006, 4.3",
    help: "Reflectance model of surfaces under virtual point lights: diffuse (lambert), or with a mirror part too (ggx), which \
           shows the single lights as spots where surfaces are smooth",
    ..Setting::changing(Changes::Picture)
};
