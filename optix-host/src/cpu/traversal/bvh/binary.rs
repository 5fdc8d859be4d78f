//! Binary hierarchies, from which the wide one is collapsed.

use std::collections::HashMap;

use glam::{DVec3, Vec3A};
use obvhs::bvh2::{Bvh2, reinsertion::ReinsertionOptimizer};
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use super::aabb::Aabb;

/// A node: two children, or one primitive.
#[derive(Clone, Copy, Debug)]
pub enum BinaryNode {
    Inner(u32, u32),
    Primitive(u32),
}

/// A binary hierarchy with exact bounds, parents before children, node 0 the root.
pub struct BinaryBvh {
    pub links: Vec<BinaryNode>,
    pub bounds: Vec<Aabb>,
}

/// Deeper trees are not optimised further: obvhs sizes its stack before it reinserts.
const MAX_DEPTH_FOR_REINSERTION: usize = 64;
/// Part of the nodes that reinsertion looks at in its first of 16 rounds.
const REINSERTION_RATIO: f32 = 0.15;

impl BinaryBvh {
    /// A tree of low surface-area cost: agglomerative clustering (Meister and Bittner, "Parallel Locally-Ordered
    /// Clustering", 2018) and reinsertion ("Parallel Reinsertion", 2018), both by obvhs.
    ///
    /// Primitives with equal boxes go in as one and are split evenly below it: the clustering merges mutual nearest
    /// neighbours, and among equals it finds one pair a pass, which takes quadratic time.
    pub fn by_surface_area(boxes: &[Aabb], active: &[u32]) -> Self {
        let normalised = normalise(boxes, active);
        let groups = Groups::new(&normalised);
        let mut tree = PlocBuilder::with_capacity(groups.boxes.len()).build(
            PlocSearchDistance::Low,
            &groups.boxes,
            (0..groups.boxes.len() as u32).collect(),
            SortPrecision::U64,
            2,
        );
        if depth(&tree) <= MAX_DEPTH_FOR_REINSERTION {
            ReinsertionOptimizer::default().run(&mut tree, REINSERTION_RATIO, None);
        }

        let mut links = vec![BinaryNode::Primitive(0)];
        let mut open = vec![(0, Source::Node(0))];
        while let Some((to, source)) = open.pop() {
            let halves = match source {
                Source::Node(node) => {
                    let node = &tree.nodes[node as usize];
                    if node.is_leaf() {
                        let group = tree.primitive_indices[node.first_index as usize];
                        open.push((to, groups.members(group)));
                        continue;
                    }
                    [Source::Node(node.first_index), Source::Node(node.first_index + 1)]
                }
                Source::Equals(begin, end) if end - begin == 1 => {
                    links[to] = BinaryNode::Primitive(active[groups.order[begin] as usize]);
                    continue;
                }
                Source::Equals(begin, end) => {
                    let middle = begin.midpoint(end);
                    [Source::Equals(begin, middle), Source::Equals(middle, end)]
                }
            };
            let left = links.len();
            links.extend([BinaryNode::Primitive(0); 2]);
            links[to] = BinaryNode::Inner(left as u32, left as u32 + 1);
            let [first, second] = halves;
            open.extend([(left + 1, second), (left, first)]);
        }
        Self::with_bounds(links, boxes)
    }

    /// A balanced tree: halves the primitives at the median of the longest axis of their centres.
    pub fn by_median(boxes: &[Aabb], active: &[u32]) -> Self {
        let mut order = active.to_vec();
        let mut links = vec![BinaryNode::Primitive(0)];
        let mut open = vec![(0, 0, order.len())];
        while let Some((to, begin, end)) = open.pop() {
            let part = &mut order[begin..end];
            links[to] = if let [only] = part {
                BinaryNode::Primitive(*only)
            } else {
                let centre =
                    |i: u32, a: usize| f64::from(boxes[i as usize].min[a]) + f64::from(boxes[i as usize].max[a]);
                let extent = |a: usize| {
                    let (lo, hi) = part
                        .iter()
                        .map(|&i| centre(i, a))
                        .fold((f64::MAX, f64::MIN), |(lo, hi), c| (lo.min(c), hi.max(c)));
                    hi - lo
                };
                let axis = (0..3).max_by(|&a, &b| extent(a).total_cmp(&extent(b))).unwrap_or(0);
                let middle = part.len() / 2;
                part.select_nth_unstable_by(middle, |&i, &j| {
                    centre(i, axis).total_cmp(&centre(j, axis)).then(i.cmp(&j))
                });
                let left = links.len();
                links.extend([BinaryNode::Primitive(0); 2]);
                open.extend([(left + 1, begin + middle, end), (left, begin, begin + middle)]);
                BinaryNode::Inner(left as u32, left as u32 + 1)
            };
        }
        Self::with_bounds(links, boxes)
    }

    fn with_bounds(links: Vec<BinaryNode>, boxes: &[Aabb]) -> Self {
        let mut bounds = vec![Aabb::EMPTY; links.len()];
        for i in (0..links.len()).rev() {
            bounds[i] = match links[i] {
                BinaryNode::Inner(left, right) => bounds[left as usize].union(&bounds[right as usize]),
                BinaryNode::Primitive(primitive) => boxes[primitive as usize],
            };
        }
        Self { links, bounds }
    }
}

/// What a binary node is made of: a node of obvhs, or a range of primitives with equal boxes.
enum Source {
    Node(u32),
    Equals(usize, usize),
}

/// Boxes without their duplicates.
struct Groups {
    boxes: Vec<obvhs::aabb::Aabb>,
    /// All boxes, those of group `g` at `begin[g] .. begin[g + 1]`.
    order: Vec<u32>,
    begin: Vec<usize>,
}

impl Groups {
    fn new(all: &[obvhs::aabb::Aabb]) -> Self {
        let mut numbers = HashMap::with_capacity(all.len());
        let mut boxes = Vec::new();
        let mut sizes = Vec::new();
        let group_of: Vec<u32> = all
            .iter()
            .map(|b| {
                let group =
                    *numbers.entry([b.min, b.max].map(|v| v.to_array().map(f32::to_bits))).or_insert_with(|| {
                        boxes.push(*b);
                        sizes.push(0);
                        boxes.len() as u32 - 1
                    });
                sizes[group as usize] += 1;
                group
            })
            .collect();
        let mut begin = vec![0];
        begin.extend(sizes.iter().scan(0, |sum, size| {
            *sum += size;
            Some(*sum)
        }));
        let mut next = begin.clone();
        let mut order = vec![0; all.len()];
        for (i, &group) in group_of.iter().enumerate() {
            order[next[group as usize]] = i as u32;
            next[group as usize] += 1;
        }
        Self { boxes, order, begin }
    }

    fn members(&self, group: u32) -> Source {
        Source::Equals(self.begin[group as usize], self.begin[group as usize + 1])
    }
}

/// Added on all sides of normalised boxes, so that boxes in a line differ in area.
const THICKNESS: f32 = 1.0 / (1 << 20) as f32;

/// The active boxes moved and scaled into the unit cube, so that areas neither overflow nor vanish in `f32`. Only the
/// tree's topology comes from these; its bounds are the exact ones.
fn normalise(boxes: &[Aabb], active: &[u32]) -> Vec<obvhs::aabb::Aabb> {
    let all = active.iter().fold(Aabb::EMPTY, |all, &i| all.union(&boxes[i as usize]));
    let wide = |p: [f32; 3]| DVec3::from_array(p.map(f64::from));
    let (origin, extent) = (wide(all.min), (wide(all.max) - wide(all.min)).max_element());
    let scale = if extent > 0.0 { 1.0 / extent } else { 1.0 };
    let place = |p: [f32; 3]| Vec3A::from(((wide(p) - origin) * scale).as_vec3());
    active
        .iter()
        .map(|&i| {
            let Aabb { min, max } = boxes[i as usize];
            obvhs::aabb::Aabb::new(place(min) - THICKNESS, place(max) + THICKNESS)
        })
        .collect()
}

fn depth(tree: &Bvh2) -> usize {
    let mut deepest = 0;
    let mut open = vec![(0u32, 1)];
    while let Some((node, depth)) = open.pop() {
        deepest = deepest.max(depth);
        let node = &tree.nodes[node as usize];
        if !node.is_leaf() {
            open.extend([(node.first_index, depth + 1), (node.first_index + 1, depth + 1)]);
        }
    }
    deepest
}
