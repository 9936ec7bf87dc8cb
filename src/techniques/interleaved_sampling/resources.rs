//! The technique's name, and the names of what it holds.

pub const NAME: &str = "interleaved_sampling";

/// What a member is drawn with and into.
pub const DEPTH: &str = "interleaved_sampling.depth.reversed";
pub const DRAWN: &str = "interleaved_sampling.material.color";

/// The scene at the moment of a member, with `--effect motion`.
pub const POSED_DRAWS: &str = "interleaved_sampling.posed.draws";
pub const POSED_POSITIONS: &str = "interleaved_sampling.posed.positions";
pub const POSED_ATTRIBUTES: &str = "interleaved_sampling.posed.attributes";

/// With `--effect volume`: how far behind the beginning of its step each member's planes lie.
pub const OFFSETS: &str = "interleaved_sampling.slices.offsets";

/// What the planes of a volume add up to, light and how much of what lies behind it hides.
pub const LAYER: &str = "interleaved_sampling.slices.layer";

/// What some of them do, with `--summation hierarchical`.
pub const GROUP: &str = "interleaved_sampling.slices.group";

/// Where the samples of each member lie.
pub const MEMBERS: &str = "interleaved_sampling.combine.members";

/// Sums over the samples of each pixel so far, and their number.
pub const SUMS: &str = "interleaved_sampling.combine.sums";

/// The picture: the mean of each pixel's samples.
pub const COLOR: &str = "interleaved_sampling.mean.color";

/// Where pixels have no sample: the pixel whose mean each of them takes.
pub const SOURCES: &str = "interleaved_sampling.mean.sources";
