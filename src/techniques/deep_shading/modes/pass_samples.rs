//! Samples a pixel that are drawn at once (`--pass-samples`).

use crate::caps::{Ability, Caps, Need};
use crate::error::{Error, Result};
use crate::settings::Values;
use crate::techniques::deep_shading::modes::shading_kind::ShadingKind;

/// More than one sample a pixel, most first.
pub const MULTIPLE: [(u32, Ability); 2] = [(8, Ability::EightSamples), (4, Ability::FourSamples)];

/// Samples a pixel of a pass (`--pass-samples`); auto: as many as the device has and `spp` is a multiple of.
///
/// Errors: `spp` is no multiple of them (exit code 2).
pub fn pass_samples(values: &Values, caps: &Caps, spp: u32) -> Result<u32> {
    let Some(samples) = values.unless_auto("pass-samples", Values::integer) else {
        let fits = |(samples, ability): &&(u32, Ability)| spp.is_multiple_of(*samples) && ability.is_there(caps);
        return Ok(MULTIPLE.iter().find(fits).map_or(1, |(samples, _)| *samples));
    };
    let samples = samples as u32;
    if spp.is_multiple_of(samples) {
        return Ok(samples);
    }
    Err(Error::request(format!("--pass-samples {samples}: --spp {spp} is not a multiple of it"))
        .note(format!("--spp {} works, and --pass-samples 1 always", spp.next_multiple_of(samples))))
}

/// What `--pass-samples` needs of a device; None with other kinds of `--shading`, which refuse the setting.
pub fn needs(values: &Values) -> Option<Need> {
    if !values.is("shading", ShadingKind::Msaa) {
        return None;
    }
    let asked = values.unless_auto("pass-samples", Values::integer)?;
    let (_, ability) = MULTIPLE.into_iter().find(|(samples, _)| asked == u64::from(*samples))?;
    let instead = "--pass-samples auto takes as many as the device has";
    Some(Need { of: format!("--pass-samples {asked}"), ability, instead })
}
