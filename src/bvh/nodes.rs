//! The nodes of a tree as one walk of the device reads them: two children or four, in one of several orders, and what the
//! walk needs to keep meanwhile (glsl/bvh_nodes.glsl, glsl/bvh_stack.glsl). Leaves, their boxes and the order of triangles
//! are the tree's, whatever the choice: a ray meets the same.

use super::Bvh;
use crate::error::{Error, Result};
use crate::gpu::caps::Limits;
use crate::gpu::shader::structs::{BvhNodeBlock, BvhWideBlock};
use crate::settings::Values;
use crate::units::Bytes;
use bytemuck::cast_slice;
use std::collections::VecDeque;

/// A wide node's bits for a child's number of triangles begin here: bvh.glsl's LEAF_SHIFT.
const LEAF_SHIFT: u32 = 26;
/// Bits of a word of the trail: glsl/bvh_stack.glsl.
const WORD_BITS: u32 = 32;

/// What lies behind what in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    DepthFirst,
    BreadthFirst,
    /// Prokop, Cache-Oblivious Algorithms, 1999: halves of the levels, each ordered in the same way.
    VanEmdeBoas,
}

/// Where waiting nodes are kept; the number is the shader's STACK_IS_.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stack {
    Private,
    Shared,
    /// With room for so many.
    Short(u32),
}

/// A way of walking, as `settings::TREE` says it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Walk {
    /// Children of a node at most: 2 or 4.
    pub width: usize,
    pub order: Order,
    pub stack: Stack,
}

impl Walk {
    /// `values` have the settings of `settings::TREE`.
    pub fn from_values(values: &Values) -> Self {
        Self {
            width: if values.text("node-width") == "4" { 4 } else { 2 },
            order: match values.text("node-layout") {
                "breadth-first" => Order::BreadthFirst,
                "van-emde-boas" => Order::VanEmdeBoas,
                _ => Order::DepthFirst,
            },
            stack: match values.text("stack") {
                "shared" => Stack::Shared,
                "short" => Stack::Short(values.integer("stack-entries") as u32),
                _ => Stack::Private,
            },
        }
    }
}

enum Blocks {
    Two(Vec<BvhNodeBlock>),
    Four(Vec<BvhWideBlock>),
}

/// The nodes of one tree for one walk.
pub struct Nodes {
    stack: Stack,
    blocks: Blocks,
    /// Inner nodes on the longest way from the root to a leaf.
    level_count: u32,
    /// Nodes that wait at most.
    waiting_count: u32,
}

impl Nodes {
    pub fn new(bvh: &Bvh, walk: Walk) -> Self {
        let mut groups = Groups::new(&bvh.nodes, walk.width);
        let [level_count, waiting_count] = groups.depths();
        match walk.order {
            Order::DepthFirst => {}
            Order::BreadthFirst => groups.put_in(groups.breadth_first()),
            Order::VanEmdeBoas => groups.put_in(groups.van_emde_boas()),
        }
        let blocks = if walk.width == 4 { Blocks::Four(groups.wide()) } else { Blocks::Two(groups.pairs()) };
        Self { stack: walk.stack, blocks, level_count, waiting_count }
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

    /// Workgroup memory that `threads` rays take.
    fn shared_bytes(&self, threads: u32) -> u64 {
        if self.stack == Stack::Shared { 4 * u64::from(self.waiting_count) * u64::from(threads) } else { 0 }
    }

    /// Errors: `threads` rays need more workgroup memory than the device has (exit code 2).
    pub fn check(&self, what: &str, threads: u32, limits: &Limits) -> Result<()> {
        let (needed, limit) = (self.shared_bytes(threads), u64::from(limits.max_shared_memory_bytes));
        if needed <= limit {
            return Ok(());
        }
        Err(Error::request(format!(
            "{what}: --stack shared with {threads} rays a workgroup, each with up to {} nodes that wait, needs {} of \
             workgroup memory: this device has {}",
            self.waiting_count,
            Bytes(needed),
            Bytes(limit)
        ))
        .note("a smaller --workgroup, or --stack private"))
    }

    /// STACK, STACK_PRIVATE, STACK_SHARED, STACK_THREADS, TRAIL_WORDS, for workgroups of `threads`.
    pub fn constants(&self, threads: u32) -> [(&'static str, u32); 5] {
        let waiting = self.waiting_count.max(1);
        let digit_bits = if matches!(self.blocks, Blocks::Four(_)) { 4 } else { 2 };
        let (stack, private, shared, trail) = match self.stack {
            Stack::Private => (0, waiting, 1, 1),
            Stack::Shared => (1, 1, waiting * threads, 1),
            // A leaf's level has a digit, too.
            Stack::Short(entries) => (2, entries, 1, (digit_bits * (self.level_count + 1)).div_ceil(WORD_BITS)),
        };
        [
            ("STACK", stack),
            ("STACK_PRIVATE", private),
            ("STACK_SHARED", shared),
            ("STACK_THREADS", threads),
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
    /// Of each inner node that has one: the group of its children.
    below: Vec<u32>,
}

fn is_leaf(node: &BvhNodeBlock) -> bool {
    node.min_count[3].to_bits() > 0
}

/// Half of its box's surface.
fn half_area(node: &BvhNodeBlock) -> f32 {
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

    /// The most groups on a way down, and the most nodes that wait on one: all of a group but the one that is gone to.
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
