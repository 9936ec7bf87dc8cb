//! Bytes that a frame touches of buffers that are as long as the worst case (Clarberg & Munkberg 2014, sections 3 and 6: "about
//! 25 MB" of the deep shading buffer at 1.5 executions a pixel). Pointers to lists are cleared, so they are touched whole.

use crate::techniques::deep_shading::resources::{
    ADDRESS_BYTES, ADDRESSES, BEGIN_BYTES, BEGINS, COLOR_BYTES, COLORS, LINEAR, NODE_BYTES, NODES, ORDER, ORDER_BYTES,
    ROW_ID_BYTES, full,
};
use std::collections::BTreeMap;

/// Entries that shaders counted, and those of all lists.
#[derive(Clone, Copy, Debug, Default)]
pub struct TouchedEntries {
    /// Written by insertion.
    pub nodes: u64,
    /// Colours of listed triangles, of triangles that are in a list twice, and of strays.
    pub colors: u64,
    /// Ids in rows of compacted lists.
    pub row_ids: u64,
    /// Addresses of samples that see something.
    pub addresses: u64,
    /// Entries for shading pixels.
    pub begins: u64,
    /// Entries that a compute shader shaded.
    pub ordered: u64,
}

impl TouchedEntries {
    /// Bytes by full name; a frame has only some of these buffers.
    pub fn bytes(&self) -> BTreeMap<String, u64> {
        let of = |name: &str, count: u64, entry_bytes: u64| (full(name), count * entry_bytes);
        BTreeMap::from([
            of(BEGINS, self.begins, BEGIN_BYTES),
            of(NODES, self.nodes, NODE_BYTES),
            of(COLORS, self.colors, COLOR_BYTES),
            of(LINEAR, self.row_ids, ROW_ID_BYTES),
            of(ADDRESSES, self.addresses, ADDRESS_BYTES),
            of(ORDER, self.ordered, ORDER_BYTES),
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The paper's frame (section 6): 1280x720 pixels with 1.5 executions each, a node and a colour for each execution,
    /// and the begin pointers of 1408x848 shading pixels.
    #[test]
    fn what_the_paper_s_frame_touches_is_about_25_mib() {
        let executions = 1280 * 720 * 3 / 2;
        let entries =
            TouchedEntries { nodes: executions, colors: executions, begins: 1408 * 848, ..TouchedEntries::default() };
        let touched = entries.bytes().values().sum::<u64>();
        assert_eq!(touched, 26_894_336);
        assert_eq!(format!("{:.1}", touched as f64 / f64::from(1 << 20)), "25.6");
    }
}
