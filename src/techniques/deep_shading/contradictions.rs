//! Settings that cannot be together.

use crate::error::{Error, Result};
use crate::settings::{StereoEyes, Values};
use crate::techniques::deep_shading::modes::barycentrics::Barycentrics;
use crate::techniques::deep_shading::modes::conservative::Conservative;
use crate::techniques::deep_shading::modes::lists::Lists;
use crate::techniques::deep_shading::modes::shade_by::ShadeBy;
use crate::techniques::deep_shading::modes::shading_kind::ShadingKind;
use crate::techniques::deep_shading::modes::shading_rate::ShadingRate;
use crate::techniques::deep_shading::modes::visibility::Visibility;
use crate::techniques::deep_shading::modes::warp::Warp;
use crate::techniques::deep_shading::resources::NAME;

/// Errors: both eyes, and what knows of one (exit code 2).
pub fn require_both(values: &Values) -> Result<()> {
    if values.number("stereo") == 0.0 || !values.is("stereo-eyes", StereoEyes::Both) {
        return Ok(());
    }
    let why = match values.choice("shading") {
        ShadingKind::Msaa => "--shading msaa: it draws a pixel's samples at once, which are one eye's",
        _ if asks_for_filter(values) => "--reconstruct on: it filters what one eye sees",
        _ => return Ok(()),
    };
    Err(Error::request(format!("--stereo {} with {why}", values.text("stereo")))
        .within(NAME)
        .note("--stereo-eyes left and --stereo-eyes right have the picture of one eye each"))
}

/// `--reconstruct on`; `auto` leaves out what cannot be.
fn asks_for_filter(values: &Values) -> bool {
    values.unless_auto("reconstruct", Values::is_on) == Some(true)
}

/// Errors: samples have no SPIDs, from which their blur is found (exit code 2).
pub fn require_spids(values: &Values) -> Result<()> {
    let refused = |setting: &str, instead: &str| {
        let kind = values.text(setting);
        let why =
            format!("--reconstruct on with --{setting} {kind}: samples have no SPIDs, which their blur is found from");
        Err(Error::request(why).within(NAME).note(format!("--{setting} {instead} keeps them")))
    };
    match (asks_for_filter(values), values.choice("shading"), values.choice("lists")) {
        (false, ..) => Ok(()),
        (true, ShadingKind::Deep, Lists::Direct) => refused("lists", "linked"),
        (true, ShadingKind::Deep, _) => Ok(()),
        (true, shading, _) => {
            let shading = shading.name();
            let why = format!("--reconstruct on with --shading {shading}: it filters what the lists' samples see");
            Err(Error::request(why).within(NAME).note("--shading deep has them"))
        }
    }
}

/// Errors: `--lists direct` without rays, or without the addresses that replace SPIDs (exit code 2).
pub fn require_direct(values: &Values) -> Result<()> {
    let refused =
        |why: &str, advice: &str| Err(Error::request(format!("--lists direct: {why}")).within(NAME).note(advice));
    if !values.is("lists", Lists::Direct) {
        return Ok(());
    }
    if !values.is("visibility", Visibility::Ray) {
        return refused("only rays find a sample's triangle at once", "--visibility ray has them");
    }
    if !values.is_on("address-buffer") {
        return refused("without SPIDs a sample needs its address", "--address-buffer on gives it one");
    }
    Ok(())
}

/// Errors: rays of the host, which find samples' pixels without the device's scales (exit code 2).
pub fn require_drawn(values: &Values) -> Result<()> {
    if !values.is("shading-rate", ShadingRate::Blur) || !values.is("visibility", Visibility::Ray) {
        return Ok(());
    }
    Err(Error::request("--shading-rate blur with --visibility ray: the host does not know how coarse triangles are")
        .within(NAME)
        .note("--visibility stochastic sees the same samples"))
}

/// Errors: weights of corners where hulls are drawn, which have others (exit code 2).
pub fn require_corners(values: &Values) -> Result<()> {
    let barycentrics: Barycentrics = values.choice("barycentrics");
    let drawn = values.unless_auto("conservative", Values::choice);
    let draws_corners = matches!(drawn, Some(Conservative::Hardware | Conservative::Plain));
    if barycentrics == Barycentrics::Computed || ShadeBy::of(values) != Some(ShadeBy::Fragment) || draws_corners {
        return Ok(());
    }
    let why = "hulls that are drawn around triangles do not have their corners";
    Err(Error::request(format!("--barycentrics {}: {why}", barycentrics.name()))
        .within(NAME)
        .note("--conservative hardware and none draw triangles as they are"))
}

/// Errors: the device draws triangles itself that shading space has bent (exit code 2).
pub fn require_straight(values: &Values) -> Result<()> {
    let asked = values.unless_auto("conservative", Values::choice);
    if let Some(conservative @ (Conservative::Hardware | Conservative::Plain)) = asked
        && values.is("shading-warp", Warp::Foveated)
    {
        let conservative = conservative.name();
        let why = "triangles are not straight in a foveated shading space";
        return Err(Error::request(format!("--conservative {conservative}: {why}"))
            .within(NAME)
            .note("--conservative geometry and vertex draw polygons that enclose them"));
    }
    Ok(())
}
