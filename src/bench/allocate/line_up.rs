//! All who replay a script: this program's variants, and the rivals that are built.

use super::contender::{Contender, OURS, Place, Variant};
use super::ours::{Numbers, OnDevice};
use super::play::{Player, Script};
#[cfg(feature = "rivals")]
use super::rivals;
use crate::error::Result;
use crate::memory::pool::Rules;

/// All of them for one script: `variants` first, in their order.
///
/// Errors: a rival cannot be made on the device (exit code 4).
pub fn contenders(script: &Script, place: &Place<'_>, variants: &[Variant]) -> Result<Vec<Contender>> {
    let slots = script.slot_count();
    // Sizes of heaps are not what is compared, and a script that is played on a device fits there.
    let caps = place.caps().with_endless_heaps();
    let ours = variants.iter().map(|Variant { label, strategy, block_bytes }| {
        let rules = Rules::new(&caps, *strategy, None, *block_bytes);
        let timed: Box<dyn Player> = match place {
            Place::Numbers(_) => Box::new(Numbers::new(rules.clone(), slots)),
            Place::Device(gpu) => Box::new(OnDevice::new(gpu, &caps, rules.clone(), slots)),
        };
        let accounted = Box::new(Numbers::new(rules, slots));
        Contender { allocator: OURS, variant: label.clone(), accounted, timed }
    });
    let all: Vec<Contender> = ours.collect();
    #[cfg(feature = "rivals")]
    let all = all.into_iter().chain(rivals::contenders(place, &caps, slots)?).collect();
    Ok(all)
}
