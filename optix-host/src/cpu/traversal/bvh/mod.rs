//! The 8-wide bounding volume hierarchy and its memory layout.

mod aabb;
mod binary;
mod collapse;

pub use aabb::Aabb;
pub use collapse::{SINGLE_LEAF, Shape};

use binary::BinaryBvh;
use collapse::Collapse;

/// Children of a node, and lanes of a block of triangles.
pub const WIDTH: usize = 8;

/// Eight floats in a vector register's layout.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub struct Lanes(pub [f32; WIDTH]);

impl Lanes {
    #[inline(always)]
    pub fn splat(x: f32) -> Self {
        Self([x; WIDTH])
    }
}

/// Eight child boxes as structure of arrays, and eight [`Child`]ren. A free slot has the box `[inf, -inf]`, which no
/// finite ray enters.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub struct Node {
    /// Lower and upper plane of each axis.
    pub planes: [[Lanes; 2]; 3],
    pub child: [Child; WIDTH],
}

/// A reference to an inner node, or what a leaf stands for (31 bits, meaning chosen by the owner).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Child(pub u32);

impl Child {
    const LEAF: u32 = 1 << 31;

    pub fn node(index: usize) -> Self {
        Self(index as u32)
    }

    pub fn leaf(payload: u32) -> Self {
        Self(payload | Self::LEAF)
    }

    #[inline(always)]
    pub fn index(self) -> usize {
        self.0 as usize
    }

    #[inline(always)]
    pub fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    #[inline(always)]
    pub fn payload(self) -> u32 {
        self.0 & !Self::LEAF
    }
}

impl Node {
    const EMPTY: Self = Self {
        planes: [[Lanes([f32::INFINITY; WIDTH]), Lanes([f32::NEG_INFINITY; WIDTH])]; 3],
        child: [Child(Child::LEAF); WIDTH],
    };

    fn set(&mut self, lane: usize, bounds: &Aabb, child: Child) {
        for a in 0..3 {
            self.planes[a][0].0[lane] = bounds.min[a];
            self.planes[a][1].0[lane] = bounds.max[a];
        }
        self.child[lane] = child;
    }
}

/// Entries of the traversal stack. A node leaves at most seven children waiting.
pub const STACK: usize = 96;
const MAX_DEPTH: usize = STACK / (WIDTH - 1);

/// An 8-wide hierarchy over boxes; node 0 is the root. Without nodes if nothing is active, or if what it is over is so
/// little that it is tested directly.
#[derive(Clone, Debug)]
pub struct Bvh {
    pub nodes: Vec<Node>,
    pub bounds: Aabb,
}

impl Bvh {
    /// Builds a hierarchy over `boxes`; empty boxes are left out. `leaf` gets the primitives of a leaf in ascending
    /// order, at most `shape.leaf_size`, and gives its 31-bit payload.
    pub fn build(boxes: &[Aabb], shape: Shape, mut leaf: impl FnMut(&[u32]) -> u32) -> Self {
        let active: Vec<u32> = (0..boxes.len() as u32).filter(|&i| !boxes[i as usize].is_empty()).collect();
        if active.is_empty() {
            return Self { nodes: Vec::new(), bounds: Aabb::EMPTY };
        }
        let mut collapse = Collapse::new(BinaryBvh::by_surface_area(boxes, &active), shape);
        if collapse.depth() > MAX_DEPTH {
            // Sizes that grow exponentially make a chain of any hierarchy of low cost, and the stack must hold anyway:
            // of 2^29 primitives, the most there may be, this one has 10 levels.
            collapse = Collapse::by_levels(BinaryBvh::by_median(boxes, &active), shape);
        }

        let mut nodes = vec![Node::EMPTY];
        let mut open = vec![(0, collapse.root())];
        let mut primitives = Vec::new();
        while let Some((slot, wide)) = open.pop() {
            for (lane, child) in collapse.children(wide).into_iter().enumerate() {
                let reference = if collapse.is_leaf(child) {
                    collapse.primitives(child, &mut primitives);
                    Child::leaf(leaf(&primitives))
                } else {
                    nodes.push(Node::EMPTY);
                    open.push((nodes.len() - 1, child));
                    Child::node(nodes.len() - 1)
                };
                nodes[slot].set(lane, collapse.bounds(child), reference);
            }
        }
        nodes.shrink_to_fit();
        Self { nodes, bounds: *collapse.bounds(collapse.root()) }
    }

    /// No nodes, just a box around everything.
    pub fn bounds_only(boxes: &[Aabb]) -> Self {
        Self { nodes: Vec::new(), bounds: boxes.iter().fold(Aabb::EMPTY, |all, b| all.union(b)) }
    }

    pub fn memory_bytes(&self) -> usize {
        self.nodes.len() * size_of::<Node>()
    }
}
