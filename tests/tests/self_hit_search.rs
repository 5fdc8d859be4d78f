//! A search for the ray that comes closest to breaking the bound of `SurfacePoint`: hill climbing over vertices, weights,
//! where the first ray comes from, the direction of the second, and the transforms of up to four levels of instances.
//!
//! What is climbed is the largest offset, in units of the bound, at which the second ray is seen to meet the triangle it left: the
//! bound holds as long as that stays below 1. `OPTIX_TEST_SEARCH=120 cargo test --release -p optix-tests --test
//! self_hit_search -- --nocapture` searches for two minutes on each machine; by default it is a few seconds.

use glam::{Affine3A, Vec3};
use optix_host::{BackendKind, Device};
use optix_tests::devices;
use optix_tests::spawn::{
    Content, Dice, FAMILIES, Field, Island, Start, Triangle, approach, extent, level, start, step, weights,
};
use std::time::{Duration, Instant};

/// A ray that leaves a triangle.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    triangle: Triangle,
    weights: [f32; 2],
    from: Vec3,
    leaving: Vec3,
    margin: f32,
}

impl Candidate {
    fn new(dice: &mut Dice) -> Self {
        let triangle = dice.pick(&FAMILIES).triangle([-20, 20], dice);
        let mut new = Self { triangle, weights: weights(dice), from: approach(dice), leaving: Vec3::X, margin: -1.0 };
        new.leaving = direction(dice, &new.triangle);
        new
    }

    /// Something of it is another.
    fn mutate(&mut self, dice: &mut Dice) {
        for _ in 0..1 + dice.below(3) {
            match dice.below(9) {
                0 | 1 => {
                    // A coordinate, by ulps, by a factor, or that of another vertex.
                    let (v, k, w) = (dice.below(3) as usize, dice.below(3) as usize, dice.below(3) as usize);
                    let x = self.triangle[v][k];
                    self.triangle[v][k] = match dice.below(4) {
                        0 => step(x, dice.below(33) as i32 - 16),
                        1 => x * (1.0 + dice.signed() * dice.power(-20.0, 0.0)),
                        2 => self.triangle[w][k],
                        _ => -x,
                    };
                }
                2 => {
                    let by = dice.cube() * size(&self.triangle) * dice.power(-20.0, 4.0);
                    self.triangle = self.triangle.map(|p| p + by);
                }
                3 => {
                    let by = 1.0 + dice.signed() * dice.power(-20.0, 0.0);
                    self.triangle = self.triangle.map(|p| p * by);
                }
                4 => self.weights = weights(dice),
                5 => self.weights = self.weights.map(|b| (b + dice.signed() * dice.power(-20.0, -1.0)).clamp(0.0, 1.0)),
                6 => self.from = approach(dice),
                7 => self.leaving = direction(dice, &self.triangle),
                _ => {
                    let k = dice.below(3) as usize;
                    self.leaving[k] = match dice.below(3) {
                        0 => step(self.leaving[k], dice.below(33) as i32 - 16),
                        1 => self.leaving[k] * (1.0 + dice.signed() * dice.power(-20.0, 0.0)),
                        _ => self.leaving[(k + 1) % 3],
                    };
                }
            }
        }
    }

    fn start(&self, island: &Island, primitive: u32) -> Start {
        let start = start(island, &self.triangle, primitive, self.weights, self.from);
        // Given in object space, as the triangle is.
        let way = self.leaving.as_dvec3();
        let world = (island.to_world(way) - island.to_world(way * 0.0)).normalize_or(way).as_vec3();
        Start { leaving: world.to_array(), ..start }
    }
}

fn size(triangle: &Triangle) -> f32 {
    triangle.iter().fold(0.0, |s: f32, p| s.max(p.abs().max_element()))
}

/// Any direction, or a grazing one.
fn direction(dice: &mut Dice, triangle: &Triangle) -> Vec3 {
    let [p0, p1, p2] = *triangle;
    let along = ((p1 - p0) * dice.signed() + (p2 - p0) * dice.signed()).normalize_or(Vec3::X);
    match dice.below(3) {
        0 => dice.sphere(),
        1 => along,
        _ => along + dice.sphere() * dice.power(-24.0, 0.0),
    }
}

/// Candidates under the same instances.
#[derive(Clone, Debug)]
struct Group {
    levels: Vec<Affine3A>,
    candidates: Vec<Candidate>,
}

impl Group {
    fn new(levels: usize, count: usize, dice: &mut Dice) -> Self {
        Self {
            levels: (0..levels).map(|_| level(dice)).collect(),
            candidates: (0..count).map(|_| Candidate::new(dice)).collect(),
        }
    }

    fn best(&self) -> f32 {
        self.candidates.iter().fold(-1.0, |best, c| best.max(c.margin))
    }

    /// A child: with another instance, or with other candidates.
    fn child(&self, dice: &mut Dice) -> Self {
        let mut child = self.clone();
        if !self.levels.is_empty() && dice.below(4) == 0 {
            let at = dice.below(self.levels.len() as u32) as usize;
            let changed = &mut child.levels[at];
            match dice.below(4) {
                0 => *changed = level(dice),
                1 => changed.translation *= 1.0 + dice.signed() * dice.power(-20.0, 0.0),
                2 => {
                    let k = dice.below(3) as usize;
                    changed.translation[k] = step(changed.translation[k], dice.below(33) as i32 - 16);
                }
                _ => {
                    let (r, c) = (dice.below(3) as usize, dice.below(3) as usize);
                    let column = changed.matrix3.col_mut(c);
                    column[r] *= 1.0 + dice.signed() * dice.power(-20.0, 0.0);
                }
            }
        } else {
            child.candidates.iter_mut().for_each(|c| c.mutate(dice));
        }
        child
    }

    fn island(&self) -> Island {
        let triangles = self.candidates.iter().map(|c| c.triangle).collect();
        Island { levels: self.levels.clone(), content: Content::Triangles(triangles) }
    }

    /// Whether the machines take it, and the bound is stated for it.
    fn is_in_range(&self) -> bool {
        let sane = self.candidates.iter().all(|c| size(&c.triangle) < 1e9 && extent(&c.triangle) > 1e-7);
        // A singular transform is refused.
        sane && self.levels.iter().all(|m| {
            let [x, y, z] = [m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis];
            let volume = x.cross(y).dot(z).abs();
            volume > 1e-3 * x.length() * y.length() * z.length() && m.translation.length() < 1e8
        })
    }
}

/// Measures the groups' candidates, each group in a structure of its own.
fn measure(device: &Device, groups: &mut [Group]) {
    let levels = groups[0].levels.len();
    // Without an instance only the first structure of a scene is a root.
    for groups in groups.chunks_mut(if levels == 0 { 1 } else { 64 }) {
        let islands: Vec<Island> = groups.iter().map(Group::island).collect();
        let field = Field::new(device, &islands).unwrap();
        for (i, (group, island)) in groups.iter_mut().zip(&islands).enumerate() {
            let starts: Vec<Start> = (0..).zip(&group.candidates).map(|(p, c)| c.start(island, p)).collect();
            let departures = field.margins(i, &starts, 0).unwrap();
            group.candidates.iter_mut().zip(departures).for_each(|(c, d)| c.margin = d.margin);
        }
    }
}

/// The worst candidate that is found in a time, and how many were tried.
fn search(device: &Device, levels: usize, (groups, count): (usize, usize), time: Duration) -> (Group, u64) {
    let mut dice = Dice::new(levels as u64);
    // One structure to a scene, so one group with all.
    let (groups, count) = if levels == 0 { (1, count * 4) } else { (groups, count) };
    let mut parents: Vec<Group> = (0..groups).map(|_| Group::new(levels, count, &mut dice)).collect();
    measure(device, &mut parents);
    let (begin, mut tried, mut generation) = (Instant::now(), (groups * count) as u64, 0);
    while begin.elapsed() < time {
        generation += 1;
        let mut children: Vec<Group> = parents.iter().map(|p| p.child(&mut dice)).collect();
        for (child, parent) in children.iter_mut().zip(&parents) {
            if !child.is_in_range() {
                *child = parent.clone();
            }
        }
        measure(device, &mut children);
        tried += (groups * count) as u64;
        for (parent, child) in parents.iter_mut().zip(children) {
            if child.levels != parent.levels {
                if child.best() >= parent.best() {
                    *parent = child;
                }
            } else {
                let pairs = parent.candidates.iter_mut().zip(child.candidates);
                pairs.filter(|(p, c)| c.margin >= p.margin).for_each(|(p, c)| *p = c);
            }
        }
        if generation % 40 == 0 {
            // The worst half of the candidates begins anew near the best ones; the worst group is given up.
            for group in &mut parents {
                group.candidates.sort_by(|a, b| b.margin.total_cmp(&a.margin));
                let half = count / 2;
                for i in half..count {
                    group.candidates[i] =
                        if i % 4 == 0 { Candidate::new(&mut dice) } else { group.candidates[i - half] };
                }
            }
            parents.sort_by(|a, b| b.best().total_cmp(&a.best()));
            if groups > 1 {
                parents[groups - 1] = Group::new(levels, count, &mut dice);
                measure(device, &mut parents[groups - 1..]);
            }
        }
    }
    let best = parents.into_iter().max_by(|a, b| a.best().total_cmp(&b.best())).unwrap();
    let worst = *best.candidates.iter().max_by(|a, b| a.margin.total_cmp(&b.margin)).unwrap();
    (Group { levels: best.levels, candidates: vec![worst] }, tried)
}

/// All numbers of a case as bits, so that it can be replayed.
fn to_bits(group: &Group) -> String {
    let c = &group.candidates[0];
    let vertices = c.triangle.iter().flat_map(|p| p.to_array());
    let ray = c.weights.into_iter().chain(c.from.to_array()).chain(c.leaving.to_array());
    let levels = group.levels.iter().flat_map(|m| m.to_cols_array());
    vertices.chain(ray).chain(levels).map(|x| format!("{:08x}", x.to_bits())).collect()
}

/// What [`to_bits`] wrote.
fn of_bits(bits: &str) -> Group {
    let word = |i: usize| f32::from_bits(u32::from_str_radix(&bits[8 * i..8 * i + 8], 16).expect("hexadecimal digits"));
    let vector = |i: usize| Vec3::new(word(i), word(i + 1), word(i + 2));
    let levels = (17..bits.len() / 8).step_by(12);
    Group {
        levels: levels.map(|i| Affine3A::from_cols_array(&std::array::from_fn(|k| word(i + k)))).collect(),
        candidates: vec![Candidate {
            triangle: [vector(0), vector(3), vector(6)],
            weights: [word(9), word(10)],
            from: vector(11),
            leaving: vector(14),
            margin: -1.0,
        }],
    }
}

/// The worst cases of longer searches, on either machine.
const FOUND: [&str; 0] = [];

#[test]
fn no_ray_is_found_that_breaks_the_bound() {
    let seconds = std::env::var("OPTIX_TEST_SEARCH").ok().and_then(|s| s.parse::<f64>().ok());
    for device in devices::all("no_ray_is_found_that_breaks_the_bound") {
        let gpu = device.kind() == BackendKind::Optix;
        let shape = match seconds {
            Some(_) if gpu => (48, 96),
            _ => (8, 128),
        };
        let time = Duration::from_secs_f64(seconds.unwrap_or(4.0) / 5.0);
        println!("the worst offset found, in units of the bound, on {}:", device.description());
        for levels in 0..=4 {
            let (worst, tried) = search(&device, levels, shape, time);
            let margin = worst.best();
            let case = &worst.candidates[0];
            println!("  {levels} levels: {margin:.3}, of {tried} candidates\n    {}\n    {case:?}", to_bits(&worst));
            assert!((0.01..1.0).contains(&margin), "{margin}");
        }
    }
}

#[test]
fn the_worst_cases_found_keep_the_bound() {
    for device in devices::all("the_worst_cases_found_keep_the_bound") {
        let mut groups = FOUND.map(of_bits);
        println!("worst cases of searches, in units of the bound, on {}:", device.description());
        for (group, bits) in groups.iter_mut().zip(FOUND) {
            measure(&device, std::slice::from_mut(group));
            println!("  {} levels: {:.3}", group.levels.len(), group.best());
            assert!(group.best() < 1.0, "{bits}");
            assert_eq!(to_bits(group), bits);
        }
    }
}
