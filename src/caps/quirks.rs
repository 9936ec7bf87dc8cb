//! Quirks: what single drivers do that neither limits nor features tell, as one table of who does it. Code asks for the quirk,
//! never for a driver.

use super::Identity;
use std::ops::Range;

/// What a driver does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quirk {
    LoopsEnd(LoopEnd),
    /// A memory barrier inside a divergent loop ends the threads of a workgroup that reach it more often than others.
    BarriersEndThreads,
    /// 32 points that a thread shades one after the other stay in registers.
    ManyRegisters,
}

/// All loops of one invocation together end without a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoopEnd {
    /// Iterations after which they do.
    pub iterations: u32,
    /// The first driver that does not, in words.
    pub gone_in: &'static str,
}

/// A quirk and the drivers that have it.
struct KnownQuirk {
    quirk: Quirk,
    is_of: fn(&Identity) -> bool,
}

const QUIRKS: &[KnownQuirk] = &[
    // Seen on 22.3.6, gone in 25.0.7; what lies between is taken to have it.
    KnownQuirk {
        quirk: Quirk::LoopsEnd(LoopEnd { iterations: 65_535, gone_in: "lavapipe of Mesa 25" }),
        is_of: |identity| is_lavapipe(identity, 0..25),
    },
    // 22.3.6 suspends them there as at a barrier of the workgroup, 25.0.7 does not; what lies between is taken to.
    KnownQuirk { quirk: Quirk::BarriersEndThreads, is_of: |identity| is_lavapipe(identity, 0..25) },
    // 22.3.6 does, 25.0.7 does not.
    KnownQuirk { quirk: Quirk::ManyRegisters, is_of: |identity| is_lavapipe(identity, 22..23) },
];

/// Whether the driver is lavapipe, of one of these major versions of Mesa.
fn is_lavapipe(identity: &Identity, majors: Range<u32>) -> bool {
    let version = identity.driver_info.split_once("Mesa ").and_then(|(_, version)| version.split('.').next());
    let major = version.and_then(|major| major.parse().ok());
    identity.driver == "llvmpipe" && major.is_some_and(|major| majors.contains(&major))
}

impl Identity {
    /// What its driver does that others do not.
    pub fn quirks(&self) -> impl Iterator<Item = Quirk> {
        QUIRKS.iter().filter(|known| (known.is_of)(self)).map(|known| known.quirk)
    }

    /// When all loops of one invocation end without a word; None where they do not.
    pub fn loop_end(&self) -> Option<LoopEnd> {
        self.quirks().find_map(|quirk| match quirk {
            Quirk::LoopsEnd(end) => Some(end),
            _ => None,
        })
    }

    /// Whether a memory barrier inside a divergent loop ends the threads of a workgroup that reach it more often than others.
    /// Who needs such a barrier there must do without it, and with tests that would see what it costs.
    pub fn barriers_end_threads(&self) -> bool {
        self.quirks().any(|quirk| quirk == Quirk::BarriersEndThreads)
    }

    /// Whether 32 points that a thread shades one after the other stay in registers.
    pub fn has_many_registers(&self) -> bool {
        self.quirks().any(|quirk| quirk == Quirk::ManyRegisters)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caps::known;

    #[test]
    fn quirks_are_of_the_drivers_on_which_they_were_seen() {
        for name in known::names() {
            let count = if name == "lavapipe-22.3.6" { QUIRKS.len() } else { 0 };
            assert_eq!(known::caps(name).unwrap().identity.quirks().count(), count, "{name}");
        }
        let lavapipe = known::caps("lavapipe-22.3.6").unwrap().identity;
        for (driver_info, iterations, has_many_registers) in [
            ("Mesa 21.0.1 (LLVM 11)", Some(65_535), false),
            ("Mesa 22.0.0", Some(65_535), true),
            ("Mesa 24.3.9-devel", Some(65_535), false),
            ("Mesa 25.0.0", None, false),
            ("Mesa ", None, false),
            ("", None, false),
        ] {
            let other = Identity { driver_info: driver_info.to_owned(), ..lavapipe.clone() };
            assert_eq!(other.loop_end().map(|end| end.iterations), iterations, "{driver_info}");
            assert_eq!(other.barriers_end_threads(), iterations.is_some(), "{driver_info}");
            assert_eq!(other.has_many_registers(), has_many_registers, "{driver_info}");
        }
        // Mesa's drivers of GPUs are of the same versions.
        assert_eq!(Identity { driver: "radv".to_owned(), ..lavapipe }.quirks().count(), 0);
    }
}
