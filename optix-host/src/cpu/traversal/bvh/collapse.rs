//! Collapse of a binary hierarchy into one with eight children a node, at the least surface-area cost.
//!
//! Dynamic programming after Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed
//! Wide BVHs" (HPG 2017), section 4.1: `cost(n, i)` is the least cost of the subtree `n` as a forest of at most `i`
//! wide trees.

use super::WIDTH;
use super::aabb::Aabb;
use super::binary::{BinaryBvh, BinaryNode};

/// What a leaf may hold, and what it costs against visiting a node.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// Most primitives of a leaf, 1 to 8; they are tested together.
    pub leaf_size: u32,
    pub leaf_cost: f32,
}

/// Every primitive in a slot of its own: the slot's box is the primitive's.
pub const SINGLE_LEAF: Shape = Shape { leaf_size: 1, leaf_cost: 1.0 };

/// Which wide nodes to make of a binary tree.
pub struct Collapse {
    tree: BinaryBvh,
    size: Vec<u32>,
    /// `split[n][i]` for `i >= 1`: trees of the forest of `i + 1` that the left child gets, 0 to use one tree less.
    /// `split[n][0]`: the same for the eight children of a wide node made of `n`; 0 for a leaf.
    split: Vec<[u8; WIDTH - 1]>,
}

impl Collapse {
    pub fn new(tree: BinaryBvh, shape: Shape) -> Self {
        let count = tree.links.len();
        let root_area = tree.bounds[0].half_area();
        let scale = if root_area > 0.0 { 1.0 / root_area } else { 1.0 };
        let mut size = vec![1u32; count];
        let mut cost = vec![[0f32; WIDTH - 1]; count];
        let mut split = vec![[0u8; WIDTH - 1]; count];
        for n in (0..count).rev() {
            // The second part makes the fewest nodes the best where there is no area at all.
            let area = (tree.bounds[n].half_area() * scale) as f32 + 1e-7;
            let as_leaf = area * shape.leaf_cost;
            let BinaryNode::Inner(left, right) = tree.links[n] else {
                cost[n] = [as_leaf; WIDTH - 1];
                continue;
            };
            let (left, right) = (left as usize, right as usize);
            size[n] = size[left] + size[right];
            let best = |trees: usize| {
                (1..trees)
                    .map(|k| (cost[left][k - 1] + cost[right][trees - k - 1], k as u8))
                    .fold((f32::INFINITY, 0), |best, next| if next.0 < best.0 { next } else { best })
            };
            let (below, k) = best(WIDTH);
            let as_node = below + area;
            let mut row = [as_node; WIDTH - 1];
            split[n][0] = k;
            if size[n] <= shape.leaf_size && as_leaf <= as_node {
                row[0] = as_leaf;
                split[n][0] = 0;
            }
            for i in 1..WIDTH - 1 {
                let (forest, k) = best(i + 1);
                row[i] = row[i - 1];
                if forest < row[i] {
                    row[i] = forest;
                    split[n][i] = k;
                }
            }
            cost[n] = row;
        }
        Self { tree, size, split }
    }

    /// Three levels of the binary tree to each wide one, whatever the cost.
    pub fn by_levels(tree: BinaryBvh, shape: Shape) -> Self {
        let mut collapse = Self::new(tree, shape);
        for (n, split) in collapse.split.iter_mut().enumerate() {
            if collapse.size[n] > shape.leaf_size {
                *split = [4, 1, 0, 2, 0, 0, 0];
            }
        }
        collapse
    }

    pub fn root(&self) -> u32 {
        0
    }

    pub fn bounds(&self, n: u32) -> &Aabb {
        &self.tree.bounds[n as usize]
    }

    pub fn is_leaf(&self, n: u32) -> bool {
        self.split[n as usize][0] == 0
    }

    /// The children of the wide node made of `n`; the root may be a leaf, and is then its own only child.
    pub fn children(&self, n: u32) -> Vec<u32> {
        let mut children = Vec::with_capacity(WIDTH);
        match self.tree.links[n as usize] {
            BinaryNode::Inner(left, right) if !self.is_leaf(n) => {
                let k = usize::from(self.split[n as usize][0]);
                self.forest(left, k, &mut children);
                self.forest(right, WIDTH - k, &mut children);
            }
            _ => children.push(n),
        }
        children
    }

    fn forest(&self, n: u32, trees: usize, roots: &mut Vec<u32>) {
        if trees == 1 {
            roots.push(n);
            return;
        }
        match (self.tree.links[n as usize], usize::from(self.split[n as usize][trees - 1])) {
            (BinaryNode::Inner(left, right), k) if k > 0 => {
                self.forest(left, k, roots);
                self.forest(right, trees - k, roots);
            }
            _ => self.forest(n, trees - 1, roots),
        }
    }

    /// The primitives below `n`, ascending.
    pub fn primitives(&self, n: u32, into: &mut Vec<u32>) {
        into.clear();
        into.reserve(self.size[n as usize] as usize);
        let mut open = vec![n];
        while let Some(n) = open.pop() {
            match self.tree.links[n as usize] {
                BinaryNode::Inner(left, right) => open.extend([left, right]),
                BinaryNode::Primitive(primitive) => into.push(primitive),
            }
        }
        into.sort_unstable();
    }

    /// Wide nodes on the longest way down.
    pub fn depth(&self) -> usize {
        let mut deepest = 0;
        let mut open = vec![(self.root(), 1)];
        while let Some((n, depth)) = open.pop() {
            deepest = deepest.max(depth);
            open.extend(self.children(n).into_iter().filter(|&c| !self.is_leaf(c)).map(|c| (c, depth + 1)));
        }
        deepest
    }
}
