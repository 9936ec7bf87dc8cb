//! What an animation moves: a channel of a file, and what became of it.

use crate::scene::animation::Curve;

/// Property that a channel moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Motion {
    Translation,
    Rotation,
    Scale,
    /// Weights of the morph targets of the node's mesh.
    Weights,
}

/// One property of one node over time.
#[derive(Debug)]
pub struct Channel {
    pub node_index: usize,
    pub motion: Motion,
    pub curve: Curve,
}
