//! Path tracing: every way through the tree, rays by the driver's own structures, samples in one submit or each in its
//! own.

use super::super::case::{Group, Place, Settings, Twin};
use crate::selftest::cases::bounds::{AGAIN, CUT, PATHS, SAME, WHOLE};
use crate::selftest::judge::Must;

const NAME: &str = "path_traced";
const CORNELL: Place = Place::Scene("cornell");
const HALL: Place = Place::Scene("hall:triangles=8000");
const FEW: (&str, &str) = ("spp", "4");

/// Beside nodes of two with a private stack, depth first. Some drivers compile each for a quarter of a minute: no more
/// than these.
const WALKS: &[Settings] = &[
    &[("node-width", "2"), ("stack", "shared"), ("node-layout", "van-emde-boas")],
    &[("node-width", "2"), ("stack", "short")],
    &[("node-width", "4"), ("stack", "private"), ("node-layout", "breadth-first")],
    &[("node-width", "4"), ("stack", "shared"), ("workgroup", "8x8")],
    &[("node-width", "4"), ("stack", "short"), ("stack-entries", "1")],
];

const QUERIES: &[Settings] = &[&[("rays", "query")]];

/// Structures that a driver builds hold the same triangles; rays that graze an edge may see its other side, on every
/// driver.
const BY_QUERY: Must = Must::Near(PATHS);

pub const GROUPS: &[Group] = &[
    Group {
        name: "repeat",
        technique: NAME,
        place: CORNELL,
        common: &[FEW],
        twin: Twin::Method(&[]),
        methods: AGAIN,
        must: SAME,
    },
    Group {
        name: "walk",
        technique: NAME,
        place: HALL,
        common: &[FEW],
        twin: Twin::Method(&[("node-width", "2"), ("stack", "private")]),
        methods: WALKS,
        must: Must::Equal(PATHS),
    },
    Group {
        name: "query",
        technique: NAME,
        place: HALL,
        common: &[FEW],
        twin: Twin::Method(&[("rays", "tree")]),
        methods: QUERIES,
        must: BY_QUERY,
    },
    Group {
        name: "query-medium",
        technique: NAME,
        place: CORNELL,
        common: &[FEW, ("medium", "0.05,0.01,0.3")],
        twin: Twin::Method(&[("rays", "tree")]),
        methods: QUERIES,
        must: BY_QUERY,
    },
    Group {
        name: "submits",
        technique: NAME,
        place: CORNELL,
        common: &[("spp", "16")],
        twin: Twin::Method(WHOLE),
        methods: CUT,
        must: Must::Equal(PATHS),
    },
];
