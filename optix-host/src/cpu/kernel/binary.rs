//! Binary hierarchies, from which the wide one is collapsed.

use glam::{DVec3, Vec3A};
use obvhs::bvh2::{Bvh2, reinsertion::ReinsertionOptimizer};
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use super::aabb::Aabb;

/// A node: two children, or one primitive.
#[derive(Clone, Copy, Debug)]
pub enum Link {
    Inner(u32, u32),
    Primitive(u32),
}

/// A binary hierarchy with exact bounds, parents before children, node 0 the root.
pub struct Binary {
    pub links: Vec<Link>,
    pub bounds: Vec<Aabb>,
}

/// Deeper trees are not optimised further: obvhs sizes its stack before it reinserts.
const MAX_DEPTH_FOR_REINSERTION: usize = 64;
/// Part of the nodes that reinsertion looks at in its first of 16 rounds.
const REINSERTION_RATIO: f32 = 0.15;

impl Binary {
    /// A tree of low surface-area cost: agglomerative clustering (Meister and Bittner, "Parallel Locally-Ordered
    /// Clustering", 2018) and reinsertion ("Parallel Reinsertion", 2018), both by obvhs.
    pub fn by_surface_area(boxes: &[Aabb], active: &[u32]) -> Self {
        let normalised = normalise(boxes, active);
        let mut tree = PlocBuilder::with_capacity(active.len()).build(
            PlocSearchDistance::Low,
            &normalised,
            (0..active.len() as u32).collect(),
            SortPrecision::U64,
            2,
        );
        if depth(&tree) <= MAX_DEPTH_FOR_REINSERTION {
            ReinsertionOptimizer::default().run(&mut tree, REINSERTION_RATIO, None);
        }

        let mut links = Vec::with_capacity(tree.nodes.len());
        let mut open = vec![(0u32, 0u32)];
        links.push(Link::Primitive(0));
        while let Some((from, to)) = open.pop() {
            let node = &tree.nodes[from as usize];
            links[to as usize] = if node.is_leaf() {
                Link::Primitive(active[tree.primitive_indices[node.first_index as usize] as usize])
            } else {
                let left = links.len() as u32;
                links.extend([Link::Primitive(0); 2]);
                open.extend([(node.first_index + 1, left + 1), (node.first_index, left)]);
                Link::Inner(left, left + 1)
            };
        }
        Self::with_bounds(links, boxes)
    }

    /// A balanced tree: halves the primitives at the median of the longest axis of their centres.
    pub fn by_median(boxes: &[Aabb], active: &[u32]) -> Self {
        let mut order = active.to_vec();
        let mut links = vec![Link::Primitive(0)];
        let mut open = vec![(0, 0, order.len())];
        while let Some((to, begin, end)) = open.pop() {
            let part = &mut order[begin..end];
            links[to] = if let [only] = part {
                Link::Primitive(*only)
            } else {
                let centre = |i: u32, a: usize| {
                    f64::from(boxes[i as usize].min[a]) + f64::from(boxes[i as usize].max[a])
                };
                let extent = |a: usize| {
                    let (lo, hi) = part.iter().map(|&i| centre(i, a)).fold((f64::MAX, f64::MIN), |(lo, hi), c| {
                        (lo.min(c), hi.max(c))
                    });
                    hi - lo
                };
                let axis = (0..3).max_by(|&a, &b| extent(a).total_cmp(&extent(b))).unwrap_or(0);
                let middle = part.len() / 2;
                part.select_nth_unstable_by(middle, |&i, &j| {
                    centre(i, axis).total_cmp(&centre(j, axis)).then(i.cmp(&j))
                });
                let left = links.len();
                links.extend([Link::Primitive(0); 2]);
                open.extend([(left + 1, begin + middle, end), (left, begin, begin + middle)]);
                Link::Inner(left as u32, left as u32 + 1)
            };
        }
        Self::with_bounds(links, boxes)
    }

    fn with_bounds(links: Vec<Link>, boxes: &[Aabb]) -> Self {
        let mut bounds = vec![Aabb::EMPTY; links.len()];
        for i in (0..links.len()).rev() {
            bounds[i] = match links[i] {
                Link::Inner(left, right) => bounds[left as usize].union(&bounds[right as usize]),
                Link::Primitive(primitive) => boxes[primitive as usize],
            };
        }
        Self { links, bounds }
    }
}

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
        .map(|&i| obvhs::aabb::Aabb::new(place(boxes[i as usize].min), place(boxes[i as usize].max)))
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
