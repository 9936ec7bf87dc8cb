//! Lists of the triangles to shade, and the passes that make them (Clarberg & Munkberg 2014, section 4.3).
//!
//! Why lanes have samples of one tuple: neighbours in a layer are pixels apart and mostly have lists of their own; the samples
//! of one pixel would all find one list empty at once.

pub mod address;
pub mod compact;
pub mod direct;
pub mod insert;

use super::choices::Choices;
use crate::gpu::{Access, AccessSet, Barrier, Bound, Buffer};
use crate::plan::Resources;
use crate::techniques::deep_shading::resources::{ADDRESSES, BEGINS, COLORS, LINEAR, MARKS, NODES, ZMAX, full};

/// The deep shading buffer: lists, and the colours of what they name.
pub struct Lists {
    /// 4 B a pixel of shading space: one more than the first node's index, 0 where nothing was seen.
    pub begins: Buffer,
    /// 8 B a sample: triangle, next node.
    pub nodes: Buffer,
    /// 64 B a pixel of shading space, with `--compaction on`.
    pub linear: Option<Buffer>,
    /// 4 B a sample, with `--address-buffer on`.
    pub addresses: Option<Buffer>,
    /// 4 B a pixel of shading space, with `--zmax on`: depth as D32_SFLOAT.
    pub zmax: Option<Buffer>,
    /// A bit a triangle of the scene, with `--shaded-triangles listed`: it stands in a list.
    pub marks: Option<Buffer>,
}

/// Lists, and who touched which part of them last: passes read some parts and leave others.
#[derive(Clone, Copy)]
pub struct ListsEdge<'a> {
    pub lists: &'a Lists,
    /// Begins, nodes and rows.
    pub links: AccessSet,
    pub addresses: AccessSet,
    pub zmax_and_marks: AccessSet,
}

impl<'a> ListsEdge<'a> {
    pub fn links_to(self, access: Access) -> impl Iterator<Item = Barrier> + 'a {
        self.lists.links().map(move |buffer| buffer.from(self.links).to(access))
    }

    /// None without addresses.
    pub fn addresses_to(self, access: Access) -> Option<Barrier> {
        self.lists.addresses.as_ref().map(|buffer| buffer.from(self.addresses).to(access))
    }

    /// None without zmax.
    pub fn zmax_to(self, access: Access) -> Option<Barrier> {
        self.lists.zmax.as_ref().map(|buffer| buffer.from(self.zmax_and_marks).to(access))
    }

    /// None without marks.
    pub fn marks_to(self, access: Access) -> Option<Barrier> {
        self.lists.marks.as_ref().map(|buffer| buffer.from(self.zmax_and_marks).to(access))
    }

    /// Addresses where there are some, links otherwise: what leads from a sample to its colour becomes readable.
    pub fn colors_found_by(self, access: Access) -> Vec<Barrier> {
        match self.addresses_to(access) {
            Some(addresses) => vec![addresses],
            None => self.links_to(access).collect(),
        }
    }
}

/// 8 B a sample: RGBA16F; alpha is 1 where it is stored.
pub fn colors(resources: &mut Resources) -> Buffer {
    resources.buffer(&full(COLORS))
}

impl Lists {
    pub fn new(resources: &mut Resources, choices: &Choices) -> Self {
        let mut take = |name: &str| resources.buffer(&full(name));
        Self {
            begins: take(BEGINS),
            nodes: take(NODES),
            linear: choices.lists.is_compacted.then(|| take(LINEAR)),
            addresses: choices.lists.has_addresses.then(|| take(ADDRESSES)),
            zmax: choices.lists.has_zmax.then(|| take(ZMAX)),
            marks: choices.lists.has_marks.then(|| take(MARKS)),
        }
    }

    /// What holds the lists, without addresses and depths.
    pub fn links(&self) -> impl Iterator<Item = &Buffer> {
        [Some(&self.begins), Some(&self.nodes), self.linear.as_ref()].into_iter().flatten()
    }

    /// All of it that is there and as long as shading space or samples: begins, nodes, rows, addresses, depths.
    pub fn all(&self) -> impl Iterator<Item = &Buffer> {
        self.links().chain(&self.addresses).chain(&self.zmax)
    }

    /// All of it, by name.
    pub fn bound(&self) -> Vec<(&'static str, Bound<'_>)> {
        let mut bound = vec![("Begins", Bound::Buffer(&self.begins)), ("Nodes", Bound::Buffer(&self.nodes))];
        let optional =
            [("Linear", &self.linear), ("Addresses", &self.addresses), ("ZMax", &self.zmax), ("Marks", &self.marks)];
        bound.extend(optional.into_iter().filter_map(|(name, buffer)| Some((name, Bound::Buffer(buffer.as_ref()?)))));
        bound
    }

    /// Names the access that touched all of it last.
    pub fn from(&self, access: impl Into<AccessSet>) -> ListsEdge<'_> {
        let access = access.into();
        ListsEdge { lists: self, links: access, addresses: access, zmax_and_marks: access }
    }
}
