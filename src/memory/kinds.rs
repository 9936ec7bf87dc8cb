//! Which memory type a resource gets, and why: numbers and flags only, testable without a device.

use crate::caps::{Caps, MemoryType};
use crate::error::{Error, Result};
use std::fmt;

/// Purpose of the memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// Read and written by the device alone.
    Device,
    /// Written by the host, read by the device once: staging.
    Upload,
    /// Written by the host between frames, read by every invocation of them.
    Frame,
    /// Written by the device, read by the host.
    Readback,
}

impl fmt::Display for Use {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Device => "device-local",
            Self::Upload => "host-visible",
            Self::Frame => "host-visible, device-local",
            Self::Readback => "host-cached",
        })
    }
}

/// A memory type with the reason for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    pub type_index: u32,
    /// The host must see it.
    pub mapped: bool,
    pub reason: &'static str,
}

/// The device's memory types.
pub struct Kinds {
    types: Vec<MemoryType>,
}

impl Kinds {
    pub fn new(caps: &Caps) -> Self {
        Self { types: caps.memory_types.clone() }
    }

    /// The best type for `usage` among those that `allowed` has a bit for. Mapped types are coherent, so that no
    /// flush is ever due.
    ///
    /// Errors: no type has what the use cannot do without (exit code 4).
    pub fn choose(&self, usage: Use, allowed: u32) -> Result<Choice> {
        type Wanted = (fn(&MemoryType) -> bool, &'static str);
        let host = |kind: &MemoryType| kind.host_visible && kind.host_coherent;
        let wanted: &[Wanted] = match usage {
            Use::Device => &[
                (
                    |kind| kind.device_local && !kind.host_visible && !kind.lazily_allocated,
                    "device-local, not host-visible",
                ),
                (
                    |kind| kind.device_local && !kind.lazily_allocated,
                    "device-local and host-visible: no other type is device-local",
                ),
                (|kind| !kind.lazily_allocated, "not device-local: the driver allows no such type"),
            ],
            Use::Upload => &[
                // The host's memory before what it sees of the device's, which may be little.
                (
                    |kind| kind.host_visible && kind.host_coherent && !kind.device_local && !kind.host_cached,
                    "host-coherent, write-combined",
                ),
                (|kind| kind.host_visible && kind.host_coherent && !kind.device_local, "host-coherent"),
                (|kind| kind.host_visible && kind.host_coherent && !kind.host_cached, "host-coherent, write-combined"),
                (|kind| kind.host_visible && kind.host_coherent, "host-coherent"),
            ],
            Use::Frame => &[
                // Else each wave of a discrete GPU reads it from the host.
                (
                    |kind| kind.device_local && kind.host_visible && kind.host_coherent && !kind.lazily_allocated,
                    "device-local, written by the host",
                ),
                (|kind| kind.host_visible && kind.host_coherent && !kind.host_cached, "host-coherent, write-combined"),
                (|kind| kind.host_visible && kind.host_coherent, "host-coherent"),
            ],
            Use::Readback => &[
                (|kind| kind.host_visible && kind.host_coherent && kind.host_cached, "host-coherent and cached"),
                (|kind| kind.host_visible && kind.host_coherent, "host-coherent, uncached: no cached type"),
            ],
        };
        for (fits, reason) in wanted {
            let found = self.types.iter().enumerate().find(|(index, kind)| allowed & (1 << index) != 0 && fits(kind));
            if let Some((index, kind)) = found {
                let mapped = usage != Use::Device && host(kind);
                return Ok(Choice { type_index: index as u32, mapped, reason });
            }
        }
        Err(Error::device(format!("no {usage} memory type among those the driver allows (mask {allowed:#b})")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caps::known;

    fn kind(device_local: bool, host_visible: bool, host_cached: bool) -> MemoryType {
        let host_coherent = host_visible;
        MemoryType { heap: 0, device_local, host_visible, host_coherent, host_cached, lazily_allocated: false }
    }

    #[test]
    fn a_discrete_gpu_keeps_device_memory_from_the_host_and_reads_back_through_the_cache() {
        let kinds = Kinds { types: vec![kind(true, false, false), kind(false, true, false), kind(false, true, true)] };
        assert_eq!(kinds.choose(Use::Device, 0b111).unwrap().type_index, 0);
        assert_eq!(kinds.choose(Use::Upload, 0b111).unwrap().type_index, 1);
        assert_eq!(kinds.choose(Use::Readback, 0b111).unwrap().type_index, 2);
        // What both see is there on some: frames' numbers lie there, and staging does not.
        let types =
            [kind(true, false, false), kind(false, true, false), kind(false, true, true), kind(true, true, false)];
        let both = Kinds { types: types.to_vec() };
        assert_eq!([Use::Frame, Use::Upload].map(|usage| both.choose(usage, 0b1111).unwrap().type_index), [3, 1]);
        assert_eq!(kinds.choose(Use::Frame, 0b111).unwrap().type_index, 1);
        // The driver's mask decides first.
        assert_eq!(kinds.choose(Use::Device, 0b110).unwrap().type_index, 1);
        assert_eq!(kinds.choose(Use::Upload, 0b001).unwrap_err().exit_code(), 4);
    }

    /// What each use gets on devices as they are: no staging lies in what the host sees of a card's memory.
    #[test]
    fn real_devices_have_a_type_for_each_use() {
        for (name, device, upload, frame, readback) in [
            ("amd-polaris10", 0, 2, 3, 5),
            ("amd-navi21", 0, 2, 3, 5),
            ("intel-arc-a770", 0, 1, 2, 1),
            ("intel-iris-xe", 0, 1, 1, 2),
            ("nvidia-rtx-2070", 1, 2, 4, 3),
            ("tiler-roadmap-2022", 1, 1, 1, 2),
            ("least-1.3", 0, 1, 1, 1),
        ] {
            let kinds = Kinds::new(&known::caps(name).unwrap());
            let chosen = [Use::Device, Use::Upload, Use::Frame, Use::Readback]
                .map(|usage| kinds.choose(usage, u32::MAX).unwrap().type_index);
            assert_eq!(chosen, [device, upload, frame, readback], "{name}");
        }
    }

    #[test]
    fn a_software_driver_has_one_type_for_all() {
        let kinds = Kinds { types: vec![kind(true, true, true)] };
        for usage in [Use::Device, Use::Upload, Use::Frame, Use::Readback] {
            assert_eq!(kinds.choose(usage, 1).unwrap().type_index, 0);
        }
        assert!(!kinds.choose(Use::Device, 1).unwrap().mapped);
    }

    /// Such memory is for attachments that are never stored; where the driver allows no other, there is none.
    #[test]
    fn memory_that_is_allocated_lazily_is_never_chosen() {
        let lazy = || MemoryType { lazily_allocated: true, ..kind(true, true, false) };
        let kinds = Kinds { types: vec![lazy(), kind(true, true, true), lazy(), kind(false, true, true)] };
        assert_eq!(kinds.choose(Use::Device, 0b1111).unwrap().type_index, 1);
        assert_eq!(kinds.choose(Use::Device, 0b1101).unwrap().type_index, 3);
        assert_eq!(kinds.choose(Use::Device, 0b0101).unwrap_err().exit_code(), 4);
        // As tilers have it: what the host does not see is for attachments that are never stored.
        let tiler = Kinds {
            types: vec![MemoryType { host_visible: false, host_coherent: false, ..lazy() }, kind(true, true, true)],
        };
        assert_eq!(tiler.choose(Use::Device, 0b11).unwrap().type_index, 1);
    }
}
