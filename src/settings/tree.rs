//! The rows of how rays walk the tree of triangles on a device: the same hits, in another time and memory.
//!
//! Why these defaults: `bench rays` on a terrain of 100,352 triangles, the hall and a map of 33,892, on lavapipe
//! 22.3.6, a software driver; no GPU was tried. Nodes of four with a stack in workgroup memory came first for every
//! query and kind of ray, with 1.14 to 1.27 times the rays a second of nodes of two with a private stack. The two gain
//! together only: with nodes of two the private stack is the faster one, with nodes of four and a private stack nothing
//! is won. A short stack does 0.6 to 0.8 of a whole one's rays. Orders of nodes differ by no more than the
//! measurement's noise. Of `--tree-growth`: boxes and triangles that rays between surfaces try, counted, in parts of those
//! of a tree that is built anew. Triangles that part in all directions: 1.03 where the cost has grown by 0.02, 1.14 by
//! 0.10, 1.41 by 0.32, 2.3 by 0.95. Nothing else that was tried grows by more than 0.14 (arena, chess, fence; truck,
//! engine and interpolation of glTF's samples: at most 1.17), but a box that opens (BoxAnimated: 1.6 by 0.22) and a
//! bending beam (RiggedSimple: 1.0 by 0.39). So at 0.1 rays take about a seventh more steps at most.

use super::{Changes, Kind, Setting, Unread};
use crate::choice::choices;

choices! {
    /// Which node lies behind which in memory (`--node-layout`).
    pub enum NodeOrder {
        "depth-first" => DepthFirst,
        "breadth-first" => BreadthFirst,
        /// Prokop, Cache-Oblivious Algorithms, 1999: halves of the levels, each ordered in the same way.
        "van-emde-boas" => VanEmdeBoas,
    }
}

choices! {
    /// Where waiting nodes are kept (`--stack`).
    pub enum StackPlace {
        "private" => Private,
        "shared" => Shared,
        "short" => Short,
    }
}

/// How long the tree of a moving scene is refitted.
pub const TREE_GROWTH: Setting = Setting {
    key: "tree-growth",
    kind: Kind::Number { min: 0.0, max: 1000.0 },
    default: "0.1",
    paper: "Dubla 2009, 4",
    help: "How much dearer than when it was built the tree that rays walk may become, as a share of its cost (boxes and \
           triangles that a ray meets, by their surfaces), before a frame of --frames builds it anew; until then its \
           boxes are refitted to where the triangles have moved; 0: every frame builds it anew",
    ..Setting::changing(Changes::Nothing)
};

/// Width of the tree, its order in memory, and where a walk keeps the nodes that it has yet to visit.
pub const TREE: &[Setting] = &[
    Setting {
        key: "node-width",
        kind: Kind::Choice(&["2", "4"]),
        default: "4",
        help: "Children of a node of the tree that rays walk; nodes of 4 join nodes of 2, and one read tests all four",
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "node-layout",
        kind: Kind::Choice(NodeOrder::WORDS),
        default: "depth-first",
        help: "Order of the tree's nodes in memory: each node before all below its first child (depth-first), before \
               all that are as deep as it (breadth-first), or the upper half of the levels before each tree of the \
               lower half, and so on within the halves (van-emde-boas)",
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "stack",
        kind: Kind::Choice(StackPlace::WORDS),
        auto: true,
        default: "auto",
        help: "Where a ray keeps the nodes that it has yet to visit: in private memory, in workgroup memory (shared), \
               or in a private stack of --stack-entries with a trail that finds from the root what did not fit \
               (short); auto: workgroup memory where it is large enough, private memory elsewhere",
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "stack-entries",
        kind: Kind::Integer { min: 1, max: 64 },
        default: "8",
        help: "Most nodes that wait in the stack of --stack short; the other stacks hold as many as the tree can make \
               wait",
        unread: |values| {
            Unread::unless(values, "stack", &[StackPlace::Short], "it has room for all nodes that can wait")
        },
        ..Setting::changing(Changes::Nothing)
    },
];
