//! The rows of how rays walk the tree of triangles on a device: the same hits, in another time and memory.
//!
//! Why these defaults: `bench rays` on a terrain of 100,352 triangles, the hall and a map of 33,892, on lavapipe 22.3.6 (a
//! software driver: no GPU was there to try). Nodes of four with a stack in workgroup memory came first everywhere, 1.1 to
//! 1.8 times as many rays a second as nodes of two with a private stack; a stack of a ray's own costs lavapipe a store for
//! each lane, whether it has anything to store or not. A short stack is slower than a whole one. Orders of nodes differ by
//! no more than the measurement's noise.

use super::{Kind, Setting};

/// How wide the tree is, how it lies in memory, and where a walk keeps what it has not looked at.
pub const TREE: &[Setting] = &[
    Setting {
        key: "node-width",
        symbol: "",
        kind: Kind::Choice(&["2", "4"]),
        default: "4",
        unit: "",
        paper: "",
        help: "children of a node of the tree that rays walk; 4 joins nodes of 2, and one reading tests all of them",
    },
    Setting {
        key: "node-layout",
        symbol: "",
        kind: Kind::Choice(&["depth-first", "breadth-first", "van-emde-boas"]),
        default: "depth-first",
        unit: "",
        paper: "",
        help: "order of the tree's nodes in memory: a node before all below its first child, before all as deep as it, or the \
               upper half of its levels before each tree of the lower half, and so on in the halves",
    },
    Setting {
        key: "stack",
        symbol: "",
        kind: Kind::Choice(&["auto", "private", "shared", "short"]),
        default: "auto",
        unit: "",
        paper: "",
        help: "where a ray keeps the nodes that wait: memory of its own, of the workgroup, or --stack-entries of its own, with \
               a trail by which it finds from the root what did not fit; auto: the workgroup's where that is enough, else its own",
    },
    Setting {
        key: "stack-entries",
        symbol: "",
        kind: Kind::Integer { min: 1, max: 64 },
        default: "8",
        unit: "",
        paper: "",
        help: "of --stack short: nodes that wait at most; the others are as many as the tree can make wait",
    },
];
