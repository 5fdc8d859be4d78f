//! A search for the ray that comes closest to breaking the bound of `SurfacePoint`: hill climbing over vertices, weights,
//! where the first ray comes from, the direction of the second, and the transforms of up to four levels of instances.
//!
//! What is climbed is the largest offset, in units of the bound, at which the second ray is seen to meet the triangle it left: the
//! bound holds as long as that stays below 1. A second search does that for planes through 0 across an axis, where the
//! triangle test alone counts. `OPTIX_TEST_SEARCH=120 cargo test --release -p optix-tests --test
//! self_hit_search -- --nocapture` searches for two minutes on each machine; by default it is a few seconds.

use glam::{Affine3A, DVec3, Vec3};
use optix_host::{BackendKind, Device};
use optix_tests::devices;
use optix_tests::spawn::{
    Content, Dice, FAMILIES, Field, Island, Start, Triangle, approach, extent, level, start, step, weights,
};
use std::time::{Duration, Instant};

/// What is searched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Among {
    /// Triangles of all families, in so many instances.
    All(usize),
    /// Triangles in a plane through 0 across an axis, in no instance.
    Planes,
}

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
    fn new(among: Among, dice: &mut Dice) -> Self {
        let triangle = match among {
            Among::All(_) => dice.pick(&FAMILIES).triangle([-20, 20], dice),
            Among::Planes => [(); 3].map(|()| dice.cube().with_y(0.0)),
        };
        let mut new = Self { triangle, weights: weights(dice), from: approach(dice), leaving: Vec3::X, margin: -1.0 };
        new.leaving = direction(dice, &new.triangle);
        new
    }

    /// Something of it is another.
    fn mutate(&mut self, among: Among, dice: &mut Dice) {
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
        if among == Among::Planes {
            self.triangle = self.triangle.map(|p| p.with_y(0.0));
        }
    }

    fn start(&self, island: &Island, primitive: u32) -> Start {
        let start = start(island, &self.triangle, primitive, self.weights, self.from);
        // Given in object space, as the triangle is.
        let way = self.leaving.as_dvec3();
        let world = (island.to_world(way) - island.to_world(way * 0.0)).normalize_or(DVec3::X).as_vec3();
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
    among: Among,
    levels: Vec<Affine3A>,
    candidates: Vec<Candidate>,
}

impl Group {
    fn new(among: Among, count: usize, dice: &mut Dice) -> Self {
        let levels = if let Among::All(levels) = among { levels } else { 0 };
        Self {
            among,
            levels: (0..levels).map(|_| level(dice)).collect(),
            candidates: (0..count).map(|_| Candidate::new(among, dice)).collect(),
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
            child.candidates.iter_mut().for_each(|c| c.mutate(self.among, dice));
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
fn search(device: &Device, among: Among, (groups, count): (usize, usize), time: Duration) -> (Group, u64) {
    let mut dice = Dice::new(8);
    // One structure to a scene, so one group with all.
    let (groups, count) = match among {
        Among::All(1..) => (groups, count),
        _ => (1, count * 4),
    };
    let mut parents: Vec<Group> = (0..groups).map(|_| Group::new(among, count, &mut dice)).collect();
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
                        if i % 4 == 0 { Candidate::new(among, &mut dice) } else { group.candidates[i - half] };
                }
            }
            parents.sort_by(|a, b| b.best().total_cmp(&a.best()));
            if groups > 1 {
                parents[groups - 1] = Group::new(among, count, &mut dice);
                measure(device, &mut parents[groups - 1..]);
            }
        }
    }
    let best = parents.into_iter().max_by(|a, b| a.best().total_cmp(&b.best())).unwrap();
    let worst = *best.candidates.iter().max_by(|a, b| a.margin.total_cmp(&b.margin)).unwrap();
    (Group { candidates: vec![worst], ..best }, tried)
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
        among: Among::All(bits.len() / 8 / 12 - 1),
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
const FOUND: [&str; 10] = [
    "3c3ff565c11dff0cc11fabf53c3ff565c11dff0c41092c6c3ccb38bc411c1d52c11fac1b3ea527693ef9a8763e86df9fbd8e05da3d08f15cbf119c51bf204776bf119c3d",
    "480219b4c65a94cc46ef284e480219b2c65a881846ef2923480219a2c65ab69f46eaf27f3d43884a3f69eb92bf1ea178bfd38f0bbf8867c53f482be5bddf3e55bf1d2057bd94b12e3e1974963f7c6ea5be4506e53f781a04be24c607bf79a644be4de81cbd2747b9c07dcc67c0f8275440e5bec8",
    "490167a746676070471f190e49016812c66be5ebc64d87e24901679ec6623dfa463419473e746b2d3c553b31be890946be0e24cb3e3dbb4038e4e571bf60014338e59c503fd5e5f93d8e8a00bd72fe1fbe0ef6864052dd93bda45808bb8c59fdbb529b39bdfec871bd6764fb3c81fa74bd979302421943cc000000000000000000000000bcc5d482000000000000000000000000bf204eee3f72cc8f407c8d7d40524040",
    "c416dbbf4409dc97c3d47c7ac416dbb84409c0a6c3d57b09c416dbbf4409c0b3c3d47c7a3f3dfcdf3e5a443f417a3511c0bdf52fc056c6593886296abe5809d73886296abfdbb3563e98c48dbdecf2b53f6c241c4086af98c0344dae3b9f84c53d8c20a43dd4a658c0d1a0c0c0cf993e3fc215033f8000000000000000000000000000003f8000000000000000000000000000003f800000be4790423e9a97743de10fa5421bc2320000000000000000000000003f2333fe0000000000000000000000003f0a5d463f8daf78c1d2ad0ec382f7ff",
    "3c75464d3e1d5c6ac21bbc23be56b20c3e86dc90c21bbc23bdcabaee3eb63511c21bbc173d1ca6ca3f73f410be33061f3eefe36e3f4b97eebebf8cbbbebf8cbb39995dfa3f8000000000000000000000000000003f8000000000000000000000000000003f800000bbbb44233f0038efbeb1b1173f6c64cabdc840703ebe06933d94835a3f7e79143da6d492bec0f867bd45ddf03f6ccc7f3e547b1cbdca9ef5beba3bc3bc5e2a3cbce609d83bbec927bcdeff643c6fb0df3beaa4bdbc13d8dfbafdaa71bcf8a0c50000001b80000008000000003f8000000000000000000000000000003f8000000000000000000000000000003f800000c0661c9d408474aa41836b68",
    "448010433f7e9375bf899bf54480191c3fcd7c82bfad1b80448010433fcd7c50bf899bf53d135b2a37a6df03412c162c40ba06c2c1936be53edd0b4b3eea8e443f447bb8",
    "c2200000be738650bef8cf98c2200000bf0e823a3f7db088c2200000befc61b8bdbfed903e3c74a03bfd8b803eb9de03be9f2f26bea27bb4000000003e3b99e7bf7baacc3f79cf44be4896703dc6a0213e0fcbfe3f66df563ed1343fbe2b8674bec52c173f6854e4c0078df6410ffa99c0b6ff56",
    "c48975dec515bf4bc327a6eec4897442c515bf4bc3279a8cc4897792c515bf7fc3279ed83f18aaf63c4db2b9c02ba85d40926f9940181c423f65badabeddf88fbd94a6603f8000000000000000000000000000003f8000000000000000000000000000003f80000042c9e69342b7f54bc12987c83f7fcb28bd15877fbc88ec253d1616e53f7fd1ea3c0241433c8672d7bc0c2f333f7ff4c6c02e8f8741752964c077f1d8",
    "cb28dc34cb19de3c4ae9faf8cb25a7efcb19de3c4ae9faf8cb25a7efcb19de3c4af063813e2313df3f36abc34015542e41aa0f73419c67763f516a6a3e1cdf213f516a6a3f35af00000000000000000000000000c08c20e00000000000000000000000003f04a1063f58d2a03ff1d4c9bf0cc78c3f8000000000000000000000000000003f8000000000000000000000000000003f8000004182a795c389e669440d7aa04199fb42000000000000000000000000419bff00000000000000000000000000be247db9c42a79fa44515851c45de34c",
    "3e43a630c09c136c44752b2ebf98f980c07bcfd444752b2ebf8415c5c0708fd444752b2e3ee290103e9a2b744158e199409aba3ec10b2932bc5e14e83f7ff9f8344e47693f8000000000000000000000000000003f8000000000000000000000000000003f800000c1836b84c0cfa294c0eb0760421b0c660000000000000000000000003f6d36930000000000000000000000003f30f19cc5093a4cc4caabcc433bafb93f8000000000000000000000000000003f8000000000000000000000000000003f80000042a57525c2d3acb2c1a4f78bbfd2c6f43f9cb5cdbf7f37db3d9c986f3e1a7db43d71947540f058223f347235c138a4b842b7ab7843f47acec398d8d8",
];

#[test]
fn no_ray_is_found_that_breaks_the_bound() {
    let seconds = std::env::var("OPTIX_TEST_SEARCH").ok().and_then(|s| s.parse::<f64>().ok());
    for device in devices::all("no_ray_is_found_that_breaks_the_bound") {
        let gpu = device.kind() == BackendKind::Optix;
        let shape = match seconds {
            Some(_) if gpu => (48, 96),
            _ => (8, 128),
        };
        let time = Duration::from_secs_f64(seconds.unwrap_or(6.0) / 6.0);
        println!("the worst offset found, in units of the bound, on {}:", device.description());
        let all = [Among::Planes].into_iter().chain((0..=4).map(Among::All));
        for among in all {
            let (worst, tried) = search(&device, among, shape, time);
            let margin = worst.best();
            let case = &worst.candidates[0];
            println!("  {among:?}: {margin:.3}, of {tried} candidates\n    {}\n    {case:?}", to_bits(&worst));
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
