//! The nodes of a tree as one walk of the device reads them: two children or four, in one of several orders, and what the
//! walk needs to keep meanwhile (glsl/bvh_nodes.glsl, glsl/bvh_stack.glsl). Leaves, their boxes and the order of triangles
//! are the tree's, whatever the choice: a ray meets the same.

use super::Bvh;
use crate::caps::Limits;
use crate::error::{Error, Result};
use crate::gpu::shader::bvh::LEAF_SHIFT;
use crate::gpu::shader::structs::{BvhNodeBlock, BvhWideBlock};
use crate::settings::{NodeOrder, StackPlace, Values};
use crate::units::Bytes;
use bytemuck::cast_slice;
use std::collections::VecDeque;

/// Bits of a word of the trail: glsl/bvh_stack.glsl.
const WORD_BITS: u32 = 32;

/// Where waiting nodes are kept; the number is the shader's STACK_IS_.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stack {
    Private,
    Shared,
    /// With room for so many.
    Short(u32),
}

impl Stack {
    /// As settings have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Private => StackPlace::Private.name(),
            Self::Shared => StackPlace::Shared.name(),
            Self::Short(_) => StackPlace::Short.name(),
        }
    }
}

/// A way of walking, as `settings::TREE` says it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Walk {
    /// Children of a node at most: 2 or 4.
    pub width: usize,
    pub order: NodeOrder,
    /// None: the workgroup's memory where that is enough, else a ray's own.
    pub stack: Option<Stack>,
}

impl Walk {
    /// `values` have the settings of `settings::TREE`.
    pub fn from_values(values: &Values) -> Self {
        Self {
            width: values.integer("node-width") as usize,
            order: values.choice("node-layout"),
            stack: values.unless_auto("stack", Values::choice).map(|place| match place {
                StackPlace::Private => Stack::Private,
                StackPlace::Shared => Stack::Shared,
                StackPlace::Short => Stack::Short(values.integer("stack-entries") as u32),
            }),
        }
    }
}

enum Blocks {
    Two(Vec<BvhNodeBlock>),
    Four(Vec<BvhWideBlock>),
}

/// The nodes of one tree for one walk.
pub struct Nodes {
    pub stack: Stack,
    /// Rays of a workgroup.
    threads: u32,
    blocks: Blocks,
    /// Inner nodes on the longest way from the root to a leaf.
    level_count: u32,
    /// Nodes that wait at most.
    waiting_count: u32,
}

impl Nodes {
    /// For workgroups of `threads` rays.
    ///
    /// Errors: `--stack shared` needs more workgroup memory than `limits` have (exit code 2).
    pub fn new(bvh: &Bvh, walk: Walk, threads: u32, limits: &Limits) -> Result<Self> {
        let mut groups = Groups::new(&bvh.nodes, walk.width);
        let [level_count, waiting_count] = groups.depths();
        let (needed, limit) = (4 * u64::from(waiting_count) * u64::from(threads), limits.max_shared_memory_bytes);
        let fits = needed <= u64::from(limit);
        if walk.stack == Some(Stack::Shared) && !fits {
            return Err(Error::request(format!(
                "--stack shared: {threads} rays of a workgroup, each with up to {waiting_count} nodes that wait, need {} of \
                 workgroup memory: this device has {}",
                Bytes(needed),
                Bytes(limit.into())
            ))
            .note("a smaller --workgroup, or --stack private"));
        }
        match walk.order {
            NodeOrder::DepthFirst => {}
            NodeOrder::BreadthFirst => groups.put_in(groups.breadth_first()),
            NodeOrder::VanEmdeBoas => groups.put_in(groups.van_emde_boas()),
        }
        let blocks = if walk.width == 4 { Blocks::Four(groups.wide()) } else { Blocks::Two(groups.pairs()) };
        let stack = walk.stack.unwrap_or(if fits { Stack::Shared } else { Stack::Private });
        Ok(Self { stack, threads, blocks, level_count, waiting_count })
    }

    /// As the device has them.
    pub fn bytes(&self) -> &[u8] {
        match &self.blocks {
            Blocks::Two(blocks) => cast_slice(blocks),
            Blocks::Four(blocks) => cast_slice(blocks),
        }
    }

    pub fn count(&self) -> usize {
        match &self.blocks {
            Blocks::Two(blocks) => blocks.len(),
            Blocks::Four(blocks) => blocks.len(),
        }
    }

    /// The value of the shaders' axis NODES.
    pub fn variant(&self) -> &'static str {
        match &self.blocks {
            Blocks::Two(_) => "two",
            Blocks::Four(_) => "four",
        }
    }

    /// Nodes that a ray has room for.
    pub fn stack_entries(&self) -> u32 {
        match self.stack {
            Stack::Short(entries) => entries,
            Stack::Private | Stack::Shared => self.waiting_count,
        }
    }

    /// STACK, STACK_PRIVATE, STACK_SHARED, STACK_THREADS, TRAIL_WORDS.
    pub fn constants(&self) -> [(&'static str, u32); 5] {
        let waiting = self.waiting_count.max(1);
        let digit_bits = if matches!(self.blocks, Blocks::Four(_)) { 4 } else { 2 };
        let (stack, private, shared, trail) = match self.stack {
            Stack::Private => (0, waiting, 1, 1),
            Stack::Shared => (1, 1, waiting * self.threads, 1),
            // A leaf's level has a digit, too.
            Stack::Short(entries) => (2, entries, 1, (digit_bits * (self.level_count + 1)).div_ceil(WORD_BITS)),
        };
        [
            ("STACK", stack),
            ("STACK_PRIVATE", private),
            ("STACK_SHARED", shared),
            ("STACK_THREADS", self.threads),
            ("TRAIL_WORDS", trail),
        ]
    }
}

/// Nodes of the tree with one parent, which a walk looks at together.
#[derive(Clone, Copy)]
struct Group {
    /// Indices of nodes, `len` of them.
    members: [u32; 4],
    len: usize,
}

impl Group {
    fn members(&self) -> &[u32] {
        &self.members[..self.len]
    }
}

/// All groups of a tree in the order in which they will lie, the root's first, each before those below it.
struct Groups<'a> {
    nodes: &'a [BvhNodeBlock],
    all: Vec<Group>,
    /// Group of the children of each inner node that has one.
    below: Vec<u32>,
}

pub(super) fn is_leaf(node: &BvhNodeBlock) -> bool {
    node.min_count[3].to_bits() > 0
}

/// Half of the surface of a node's box.
pub(super) fn half_area(node: &BvhNodeBlock) -> f32 {
    let [x, y, z] = [0, 1, 2].map(|axis| node.max_first[axis] - node.min_count[axis]);
    x * y + y * z + z * x
}

impl<'a> Groups<'a> {
    /// Depth-first. Of `width` up to 4 members: the one with the largest box is replaced by its children as long as there is
    /// room, so that what most rays enter is soonest taken apart (Wald, Benthin and Boulos 2008).
    fn new(nodes: &'a [BvhNodeBlock], width: usize) -> Self {
        let children = |node: u32| {
            let first = nodes[node as usize].max_first[3].to_bits();
            [first, first + 1]
        };
        let mut groups = Self { nodes, all: Vec::new(), below: vec![0; nodes.len()] };
        if is_leaf(&nodes[0]) {
            groups.all.push(Group { members: [0; 4], len: 1 });
            return groups;
        }
        let mut waiting = vec![0];
        while let Some(node) = waiting.pop() {
            let [first, second] = children(node);
            let mut group = Group { members: [first, second, 0, 0], len: 2 };
            while group.len < width {
                let inner = (0..group.len).filter(|at| !is_leaf(&nodes[group.members[*at] as usize]));
                let area = |at: &usize| half_area(&nodes[group.members[*at] as usize]);
                let Some(largest) = inner.max_by(|a, b| area(a).total_cmp(&area(b))) else { break };
                let [first, second] = children(group.members[largest]);
                group.members[largest] = first;
                group.members[group.len] = second;
                group.len += 1;
            }
            groups.below[node as usize] = groups.all.len() as u32;
            groups.all.push(group);
            waiting.extend(group.members().iter().rev().filter(|node| !is_leaf(&nodes[**node as usize])));
        }
        groups
    }

    /// Groups below a group, nearest to its front first.
    fn children(&self, group: u32) -> impl Iterator<Item = u32> {
        let inner = self.all[group as usize].members().iter().filter(|node| !is_leaf(&self.nodes[**node as usize]));
        inner.map(|node| self.below[*node as usize])
    }

    /// The most groups on a path down, and the most nodes that wait on one: all of a group except the one that is
    /// entered.
    fn depths(&self) -> [u32; 2] {
        let mut above = vec![[0; 2]; self.all.len()];
        let mut most = [0; 2];
        for (index, group) in self.all.iter().enumerate() {
            let [levels, waiting] = above[index];
            let here = [levels + 1, waiting + group.len as u32 - 1];
            most = [most[0].max(here[0]), most[1].max(here[1])];
            self.children(index as u32).for_each(|child| above[child as usize] = here);
        }
        most
    }

    fn breadth_first(&self) -> Vec<u32> {
        let (mut order, mut waiting) = (Vec::with_capacity(self.all.len()), VecDeque::from([0]));
        while let Some(group) = waiting.pop_front() {
            order.push(group);
            waiting.extend(self.children(group));
        }
        order
    }

    fn van_emde_boas(&self) -> Vec<u32> {
        let [level_count, _] = self.depths();
        let mut order = Vec::with_capacity(self.all.len());
        self.emit(0, level_count, &mut order);
        order
    }

    /// Appends the `level_count` upper levels of the tree at `group`, and returns the groups below them.
    fn emit(&self, group: u32, level_count: u32, order: &mut Vec<u32>) -> Vec<u32> {
        if level_count == 1 {
            order.push(group);
            return self.children(group).collect();
        }
        let upper = level_count / 2;
        let middle = self.emit(group, upper, order);
        middle.into_iter().flat_map(|group| self.emit(group, level_count - upper, order)).collect()
    }

    /// `order`: every group once, those above first.
    fn put_in(&mut self, order: Vec<u32>) {
        let mut place = vec![0; order.len()];
        for (at, group) in order.iter().enumerate() {
            place[*group as usize] = at as u32;
        }
        self.below.iter_mut().for_each(|group| *group = place[*group as usize]);
        self.all = order.iter().map(|group| self.all[*group as usize]).collect();
    }

    /// The root, then the children of each group side by side.
    fn pairs(&self) -> Vec<BvhNodeBlock> {
        let block = |node: u32| {
            let mut block = self.nodes[node as usize];
            if !is_leaf(&block) {
                block.max_first[3] = f32::from_bits(1 + 2 * self.below[node as usize]);
            }
            block
        };
        let groups = self.all.iter().filter(|group| group.len == 2);
        std::iter::once(0).chain(groups.flat_map(Group::members).copied()).map(block).collect()
    }

    fn wide(&self) -> Vec<BvhWideBlock> {
        self.all.iter().map(|group| self.wide_block(group)).collect()
    }

    fn wide_block(&self, group: &Group) -> BvhWideBlock {
        // One point, so far that a ray enters it behind every limit or before its origin.
        let nowhere = [f32::MAX; 4];
        let mut block = BvhWideBlock {
            min_x: nowhere,
            min_y: nowhere,
            min_z: nowhere,
            max_x: nowhere,
            max_y: nowhere,
            max_z: nowhere,
            children: [0; 4],
        };
        for (at, index) in group.members().iter().enumerate() {
            let node = &self.nodes[*index as usize];
            [block.min_x[at], block.min_y[at], block.min_z[at], _] = node.min_count;
            [block.max_x[at], block.max_y[at], block.max_z[at], _] = node.max_first;
            let (count, first) = (node.min_count[3].to_bits(), node.max_first[3].to_bits());
            block.children[at] = if count == 0 {
                self.below[*index as usize]
            } else {
                assert!(count >> (u32::BITS - LEAF_SHIFT) == 0 && first >> LEAF_SHIFT == 0, "{count} from {first}");
                count << LEAF_SHIFT | first
            };
        }
        block
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caps::known;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    const ORDERS: [NodeOrder; 3] = [NodeOrder::DepthFirst, NodeOrder::BreadthFirst, NodeOrder::VanEmdeBoas];

    /// A tree of `leaf_count` leaves whose shape is that of `seed`'s bits; each leaf has one triangle and a box of its own.
    fn tree(leaf_count: u32, seed: u32) -> Bvh {
        let leaf = |index: u32| BvhNodeBlock {
            min_count: [index as f32, 0.0, 0.0, f32::from_bits(1)],
            max_first: [index as f32 + 1.0, 1.0, 1.0, f32::from_bits(index)],
        };
        let mut nodes = vec![leaf(0)];
        let mut waiting = vec![(0, 0..leaf_count)];
        let mut bits = seed;
        while let Some((node, leaves)) = waiting.pop() {
            if leaves.len() == 1 {
                nodes[node] = leaf(leaves.start);
                continue;
            }
            bits = bits.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            // One side alone now and then, so that trees are deep.
            let split = leaves.start + 1 + if bits >> 31 == 0 { 0 } else { (bits >> 8) % (leaves.len() as u32 - 1) };
            let first = nodes.len();
            nodes[node] = BvhNodeBlock {
                min_count: [leaves.start as f32, 0.0, 0.0, 0.0],
                max_first: [leaves.end as f32, 1.0, 1.0, f32::from_bits(first as u32)],
            };
            nodes.extend([nodes[node]; 2]);
            waiting.extend([(first, leaves.start..split), (first + 1, split..leaves.end)]);
        }
        Bvh { nodes, ..Bvh::empty() }
    }

    fn nodes(bvh: &Bvh, width: usize, order: NodeOrder, stack: Option<Stack>) -> Result<Nodes> {
        let caps = known::caps("lavapipe-22.3.6").unwrap();
        Nodes::new(bvh, Walk { width, order, stack }, 64, &caps.limits)
    }

    /// A child as a walk finds it: first triangle where it is a leaf, else the place of its children; least and greatest x.
    fn children(nodes: &Nodes, at: u32) -> Vec<(Option<u32>, u32, [f32; 2])> {
        match &nodes.blocks {
            Blocks::Two(blocks) => {
                let child = |index: u32| {
                    let node = &blocks[index as usize];
                    let first = node.max_first[3].to_bits();
                    (is_leaf(node).then_some(first), first, [node.min_count[0], node.max_first[0]])
                };
                if at == 0 { vec![child(0)] } else { vec![child(at), child(at + 1)] }
            }
            Blocks::Four(blocks) => {
                let block = &blocks[at as usize];
                let is_there = |slot: &usize| block.min_x[*slot] < f32::MAX;
                let child = |slot: usize| {
                    let (count, first) =
                        (block.children[slot] >> LEAF_SHIFT, block.children[slot] & ((1 << LEAF_SHIFT) - 1));
                    ((count > 0).then_some(first), first, [block.min_x[slot], block.max_x[slot]])
                };
                (0..4).filter(is_there).map(child).collect()
            }
        }
    }

    proptest! {
        /// Every leaf once, with its own box, inside those above it, and no more waiting than is said.
        #[test]
        fn a_walk_of_all_children_comes_to_every_leaf(leaf_count in 1u32..60, seed in any::<u32>(), wide in any::<bool>()) {
            let bvh = tree(leaf_count, seed);
            for order in ORDERS {
                let nodes = nodes(&bvh, if wide { 4 } else { 2 }, order, Some(Stack::Private)).unwrap();
                let mut waiting = vec![(0, 0, [f32::MIN, f32::MAX])];
                let (mut leaves, mut most_waiting, mut most_levels) = (BTreeSet::new(), 0, 0);
                while let Some((at, level, outer)) = waiting.pop() {
                    for (leaf, first, inner) in children(&nodes, at) {
                        prop_assert!(outer[0] <= inner[0] && inner[1] <= outer[1]);
                        match leaf {
                            Some(leaf) => {
                                prop_assert_eq!(inner, [leaf as f32, leaf as f32 + 1.0]);
                                prop_assert!(leaves.insert(leaf), "leaf {} twice", leaf);
                            }
                            None => waiting.push((first, level + 1, inner)),
                        }
                    }
                    most_levels = most_levels.max(level + u32::from(wide));
                    most_waiting = most_waiting.max(waiting.len() as u32);
                }
                prop_assert!(leaves.into_iter().eq(0..leaf_count));
                // A root that is a leaf is a level of its own where nodes are wide.
                prop_assert_eq!(nodes.level_count, most_levels.max(1));
                prop_assert!(most_waiting <= nodes.waiting_count + 1);
                let expected = if wide { 112 * nodes.count() } else { 32 * bvh.nodes.len() };
                prop_assert_eq!(nodes.bytes().len(), expected);
            }
        }
    }

    #[test]
    fn orders_are_what_they_are_called() {
        // Fifteen groups of two on four levels, numbered depth-first.
        let bvh = tree_of_levels(4);
        let groups = Groups::new(&bvh.nodes, 2);
        assert_eq!(groups.all.len(), 15);
        assert_eq!(groups.breadth_first(), [0, 1, 8, 2, 5, 9, 12, 3, 4, 6, 7, 10, 11, 13, 14]);
        // Two levels, then each of the trees of two levels below them.
        assert_eq!(groups.van_emde_boas(), [0, 1, 8, 2, 3, 4, 5, 6, 7, 9, 10, 11, 12, 13, 14]);
        assert_eq!(groups.depths(), [4, 4]);
        assert_eq!(Groups::new(&bvh.nodes, 4).depths(), [2, 6]);
    }

    /// Every level full, boxes smaller from level to level.
    fn tree_of_levels(levels: u32) -> Bvh {
        let inner = (1u32 << levels) - 1;
        let node = |index: u32| {
            let (count, first) = if index < inner { (0, 2 * index + 1) } else { (1, index - inner) };
            let side = 1.0 / (1 << (index + 1).ilog2()) as f32;
            BvhNodeBlock {
                min_count: [0.0, 0.0, 0.0, f32::from_bits(count)],
                max_first: [side, side, side, f32::from_bits(first)],
            }
        };
        Bvh { nodes: (0..2 * inner + 1).map(node).collect(), ..Bvh::empty() }
    }

    #[test]
    fn a_stack_lies_in_workgroup_memory_where_there_is_enough() {
        // A chain: a node waits at each level.
        let chain = |length: u32| {
            let mut bvh = tree_of_levels(1);
            for _ in 1..length {
                let [inner, leaf] = [bvh.nodes[0], bvh.nodes[1]];
                let last = bvh.nodes.len();
                bvh.nodes[last - 1] = inner;
                bvh.nodes[last - 1].max_first[3] = f32::from_bits(last as u32);
                bvh.nodes.extend([leaf; 2]);
            }
            bvh
        };
        let of = |length, stack| nodes(&chain(length), 2, NodeOrder::DepthFirst, stack);
        // 32 KiB: 128 words for each of 64 rays.
        let (most, more) = (of(128, None).unwrap(), of(129, None).unwrap());
        assert_eq!((most.stack, most.stack_entries()), (Stack::Shared, 128));
        assert_eq!((more.stack, more.stack_entries()), (Stack::Private, 129));
        assert!(
            most.constants().contains(&("STACK_SHARED", 128 * 64)) && more.constants().contains(&("STACK_SHARED", 1))
        );
        let error = of(129, Some(Stack::Shared)).err().unwrap();
        assert!(error.exit_code() == 2 && error.message().contains("up to 129 nodes"), "{error}");
        // Two bits for each of 129 levels and for the leaf's: nine words.
        let short = of(129, Some(Stack::Short(8))).unwrap();
        assert!(short.constants().contains(&("TRAIL_WORDS", 9)) && short.stack_entries() == 8);
    }
}
