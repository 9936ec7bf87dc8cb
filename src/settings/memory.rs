//! The rows of how memory is kept, and of what is counted of it.

use super::{Changes, Kind, Setting};
use crate::memory::touched::Touched;
use crate::memory::{Strategy, Tiling, alias};

pub const ALLOCATION: Setting = Setting {
    key: "allocation",
    kind: Kind::Choice(Strategy::WORDS),
    default: "linear",
    help: "How memory is allocated for resources: as ranges one after the other in shared memory blocks (linear), \
           as one memory block for each (dedicated), as ranges in shared memory blocks wherever there is room (tlsf), \
           or as halves of halves of them, each a power of two of bytes (buddy)",
    ..Setting::changing(Changes::Nothing)
};

pub const MEMORY_BLOCK: Setting = Setting {
    key: "memory-block",
    kind: Kind::PowerOfBytes { min: 64 << 10, max: 1 << 30 },
    auto: true,
    default: "auto",
    help: "Greatest size of a memory block that resources share; the first ones are smaller, and what takes a quarter \
           of it or more has a memory block of its own; auto: 16MiB",
    ..Setting::changing(Changes::Nothing)
};

pub const IMAGE_TILING: Setting = Setting {
    key: "image-tiling",
    kind: Kind::Choice(Tiling::WORDS),
    default: "optimal",
    help: "How texels of images lie in memory: as the driver likes best (optimal), or row by row (linear) where it makes \
           such images; the others stay as they are; the same picture",
    ..Setting::changing(Changes::Nothing)
};

pub const ALIAS: Setting = Setting {
    key: "alias",
    kind: Kind::Choice(alias::Mode::WORDS),
    default: "greedy",
    help: "How resources of a frame that never live in the same pass share bytes: placed by the best of a few \
           orders (greedy), by a search for the least sum (optimal), or not at all (off)",
    ..Setting::changing(Changes::Nothing)
};

pub const MEMORY_BUDGET: Setting = Setting {
    key: "memory-budget",
    kind: Kind::Bytes,
    default: "none",
    help: "Most bytes that the memory blocks of one heap may sum up to; an allocation beyond it is refused; none: \
           the heap's size",
    ..Setting::changing(Changes::Nothing)
};

pub const TOUCHED: Setting = Setting {
    key: "touched",
    kind: Kind::Choice(Touched::WORDS),
    default: "off",
    help: "Count which bytes each pass reads and writes of each resource: in cache lines of 64 bytes (line), in pages of \
           4096 bytes (page), or not at all (off); shaders count themselves, which takes much time; the same picture",
    ..Setting::changing(Changes::Nothing)
};
