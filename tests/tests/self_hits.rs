//! Secondary rays don't meet the triangle they left, moved by the bound that `SurfacePoint` derives.
//!
//! `OPTIX_TEST_RAYS=100000000 cargo test --release -p optix-tests --test self_hits -- --nocapture` sends 10^8 rays from the
//! families of triangles; by default it is a million.

use glam::{Affine3A, DVec3, Quat, Vec3};
use optix_host::Device;
use optix_tests::devices;
use optix_tests::meshes;
use optix_tests::probe::{Part, ProbeRay, Tracer, ray};
use optix_tests::spawn::{
    Content, Departure, Dice, FAMILIES, Family, Field, Island, Start, Triangle, aimed, approach, extent, level, range,
    start, weights,
};
use path_tracer::scene::{self, MESH_PLACE};
use path_tracer::{knot, mesh};

/// Rays from all around towards points in a box.
fn rays_at(centre: Vec3, extent: f32, count: u32) -> Vec<ProbeRay> {
    let mut rng = optix_device_rs::rng::Pcg32::hashed(3, 4);
    let mut unit = || Vec3::from_array(core::array::from_fn(|_| rng.next_f32() * 2.0 - 1.0));
    (0..count)
        .map(|_| {
            let (from, to) = (centre + unit() * (3.0 * extent), centre + unit() * extent);
            ray(from, to - from)
        })
        .collect()
}

#[test]
fn none_in_the_default_scene() {
    let mut knot = knot::torus_knot(512, 48);
    mesh::fit_into(&mut knot, MESH_PLACE.0, MESH_PLACE.1);
    let positions: Vec<Vec3> = knot.positions.iter().map(|&p| p.into()).collect();
    let walls = scene::walls().concat();
    let (corner, side, other) = scene::leaf();
    let leaf = scene::parallelogram(corner, side, other);
    let here = Affine3A::IDENTITY;
    let parts = [
        Part { positions: &walls, indices: None, transform: here },
        Part { positions: &positions, indices: Some(&knot.indices), transform: here },
        Part { positions: &leaf, indices: None, transform: here },
    ];
    for device in devices::all("none_in_the_default_scene") {
        let tracer = Tracer::with_balls(&device, &parts, &[scene::ball_placement()]).unwrap();
        let rays = rays_at(Vec3::ZERO, 1.0, 20_000);
        let tally = tracer.respawn(&rays, 50, 1.0).unwrap();
        println!("self-hits in the default scene on {}: {tally:?}", device.description());
        assert!(tally.traced > 500_000, "{tally:?}");
        assert_eq!(tally.own, 0);
        // The test can see self-hits: without the offset there are some.
        let without = tracer.respawn(&rays, 50, 0.0).unwrap();
        println!("  without the offset: {without:?}");
        assert!(without.own > 0, "{without:?}");
    }
}

#[test]
fn none_at_the_extremes() {
    let sphere = meshes::sphere(40, 80);
    let placements = [
        ("tiny", Affine3A::from_scale(Vec3::splat(1e-6))),
        ("huge", Affine3A::from_scale(Vec3::splat(1e6))),
        ("far", Affine3A::from_translation(Vec3::new(1e4, -3e4, 2e4))),
        (
            "flat, turned and far",
            Affine3A::from_scale_rotation_translation(
                Vec3::new(3.0, 0.01, 1.0),
                Quat::from_rotation_x(1.0) * Quat::from_rotation_y(0.7),
                Vec3::new(-900.0, 40.0, 7.0),
            ),
        ),
    ];
    let far_vertices = sphere.placed(1.0, [1e4, -2e4, 5e3]);
    for device in devices::all("none_at_the_extremes") {
        let check = |name: &str, positions: &[Vec3], transform: Affine3A| {
            let part = Part { positions, indices: Some(&sphere.indices), transform };
            let tracer = Tracer::new(&device, &[part]).unwrap();
            let (lo, hi) = positions
                .iter()
                .map(|&p| transform.transform_point3(p))
                .fold((Vec3::MAX, Vec3::MIN), |(lo, hi), p| (lo.min(p), hi.max(p)));
            let rays = rays_at((lo + hi) * 0.5, (hi - lo).max_element() * 0.5, 4_000);
            let tally = tracer.respawn(&rays, 25, 1.0).unwrap();
            println!("{name}, on {}: {tally:?}", device.description());
            assert!(tally.traced > 10_000, "{name}: {tally:?}");
            assert_eq!(tally.own, 0, "{name}");
        };
        for (name, transform) in placements {
            check(name, &sphere.positions, transform);
        }
        check("far vertices", &far_vertices.positions, Affine3A::IDENTITY);
    }
}

/// How many rays the families send.
fn budget() -> u64 {
    std::env::var("OPTIX_TEST_RAYS").ok().and_then(|n| n.parse().ok()).unwrap_or(1_000_000)
}

/// Islands of a family, one after the other, and starts on each: a field to a batch.
struct Batch {
    islands: Vec<Island>,
    /// Per island.
    starts: Vec<Vec<Start>>,
}

/// Triangles of an island.
const TRIANGLES: u32 = 128;

impl Batch {
    fn new(family: &[Family], range: [i32; 2], levels: usize, starts: usize, dice: &mut Dice) -> Self {
        // Without an instance only the first structure of a scene is a root.
        let islands = if levels == 0 { 1 } else { 4 };
        let islands: Vec<Island> = (0..islands)
            .map(|_| Island {
                levels: (0..levels).map(|_| level(dice)).collect(),
                content: Content::Triangles((0..TRIANGLES).map(|_| dice.pick(family).triangle(range, dice)).collect()),
            })
            .collect();
        let per_island = starts / islands.len();
        let starts = islands
            .iter()
            .map(|island| {
                let Content::Triangles(triangles) = &island.content else { unreachable!() };
                (0..per_island)
                    .map(|_| {
                        let primitive = dice.below(TRIANGLES);
                        let (at, from) = (weights(dice), approach(dice));
                        let start = start(island, &triangles[primitive as usize], primitive, at, from);
                        Start { seed: dice.bits(), ..start }
                    })
                    .collect()
            })
            .collect();
        Self { islands, starts }
    }

    fn custom(content: impl Fn(&mut Dice) -> Content, levels: usize, starts: usize, dice: &mut Dice) -> Self {
        let islands: Vec<Island> = (0..if levels == 0 { 1 } else { 4 })
            .map(|_| Island { levels: (0..levels).map(|_| level(dice)).collect(), content: content(dice) })
            .collect();
        let per_island = starts / islands.len();
        let starts = islands
            .iter()
            .map(|island| {
                let size = match island.content {
                    Content::Ball(radius) => Vec3::splat(radius),
                    Content::Slab(half) => half,
                    Content::Triangles(_) => unreachable!(),
                };
                (0..per_island)
                    .map(|_| {
                        let at = (dice.cube() * size).as_dvec3();
                        let from = dice.sphere().as_dvec3() * f64::from(size.max_element() * dice.power(1.0, 6.0));
                        Start { seed: dice.bits(), ..aimed(island, at, from, 0) }
                    })
                    .collect()
            })
            .collect();
        Self { islands, starts }
    }

    /// The pair `i` of a field of [`pairs`], alone.
    fn pair(&self, i: usize) -> Self {
        let [Island { levels, content: Content::Triangles(triangles) }] = &self.islands[..] else { unreachable!() };
        let content = Content::Triangles(triangles[3 * i..3 * i + 3].to_vec());
        let starts = (0..).zip(&self.starts[0][2 * i..2 * i + 2]);
        let starts = starts.map(|(primitive, s)| Start { primitive, other: 2, ..*s }).collect();
        Self { islands: vec![Island { levels: levels.clone(), content }], starts: vec![starts] }
    }

    /// Runs `of` on each island's starts.
    fn run(&self, device: &Device, of: impl Fn(&Field, usize, &[Start]) -> Vec<Departure>) -> Vec<Departure> {
        let field = Field::new(device, &self.islands).unwrap();
        let each = self.starts.iter().enumerate();
        each.flat_map(|(island, starts)| of(&field, island, starts)).collect()
    }
}

/// What became of a family's rays.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    starts: u64,
    /// Of the starts.
    met: u64,
    traced: u64,
    own: u64,
    lost: u64,
}

impl Sum {
    fn add(&mut self, departures: &[Departure]) {
        for d in departures {
            self.starts += 1;
            self.met += u64::from(d.traced > 0);
            self.traced += u64::from(d.traced);
            self.own += u64::from(d.own);
            self.lost += u64::from(d.lost);
        }
    }
}

/// The families: a name, and the batch with so many starts.
type Make = Box<dyn Fn(usize, &mut Dice) -> Batch>;

fn families(range: [i32; 2]) -> Vec<(String, Make)> {
    let mut all: Vec<(String, Make)> = Vec::new();
    for family in FAMILIES {
        let make = move |starts, dice: &mut Dice| Batch::new(&[family], range, 0, starts, dice);
        all.push((format!("{family:?}"), Box::new(make)));
    }
    let inside = [Family::AxisAligned, Family::Tilted, Family::Any, Family::Far, Family::Needle];
    for levels in 1..=4 {
        let make = move |starts, dice: &mut Dice| Batch::new(&inside, range, levels, starts, dice);
        all.push((format!("Instances, {levels}"), Box::new(make)));
    }
    for levels in [0, 1, 3] {
        let ball = |dice: &mut Dice| Content::Ball(dice.power(-6.0, 6.0));
        let make = move |starts, dice: &mut Dice| Batch::custom(ball, levels, starts, dice);
        all.push((format!("Ball, {levels}"), Box::new(make)));
        let slab = |dice: &mut Dice| {
            Content::Slab(Vec3::new(dice.power(-6.0, 6.0), dice.power(-6.0, 6.0), dice.power(-6.0, 6.0)))
        };
        let make = move |starts, dice: &mut Dice| Batch::custom(slab, levels, starts, dice);
        all.push((format!("Box, {levels}"), Box::new(make)));
    }
    all
}

/// How rays are spread over fields, starts and directions.
struct Spread {
    fields: u64,
    starts: usize,
    rays: u32,
}

impl Spread {
    fn of(rays: u64) -> Self {
        let fields = (rays / 10_000).isqrt().clamp(2, 16);
        let starts = (rays / fields * 8).isqrt().clamp(64, 1 << 14);
        Self { fields, starts: starts as usize, rays: (rays / fields / starts).max(4) as u32 }
    }
}

#[test]
fn none_in_the_families() {
    for device in devices::all("none_in_the_families") {
        let families = families(range(&device));
        let Spread { fields, starts, rays } = Spread::of(budget() * 5 / 4 / families.len() as u64);
        let (mut all, mut failed) = (Sum::default(), Vec::new());
        println!("self-hits in families on {}:", device.description());
        for (number, (name, make)) in families.iter().enumerate() {
            let mut sum = Sum::default();
            for field in 0..fields {
                let batch = make(starts, &mut Dice::new(number as u64 * 1000 + field));
                let departures = batch.run(&device, |field, island, s| field.leave(island, s, rays, false).unwrap());
                sum.add(&departures);
                all.add(&departures);
                let starts = batch.starts.iter().flatten();
                failed.extend(
                    starts.zip(&departures).filter(|(_, d)| d.own > 0).map(|(s, d)| format!("{name}: {s:?} {d:?}")),
                );
            }
            println!("  {name:<14} {:>9} of {:>11} rays from {} of {} hits", sum.own, sum.traced, sum.met, sum.starts);
            assert!(sum.met * 4 > sum.starts, "{name}: {sum:?}");
        }
        println!("  all            {:>9} of {:>11} rays", all.own, all.traced);
        assert!(failed.is_empty(), "{} hits, the first: {}", failed.len(), failed[0]);
    }
}

#[test]
fn the_families_find_a_bound_per_axis() {
    for device in devices::all("the_families_find_a_bound_per_axis") {
        let mut dice = Dice::new(5);
        println!("with errors per axis, on {}:", device.description());
        let mut in_instances = 0;
        for (name, make) in families(range(&device)).iter().take(11) {
            let mut sum = Sum::default();
            for _ in 0..5 {
                let batch = make(400, &mut dice);
                sum.add(&batch.run(&device, |field, island, s| field.leave(island, s, 20, true).unwrap()));
            }
            println!("  {name:<14} {:>9} of {:>11} rays", sum.own, sum.traced);
            // What was found first: a plane across an axis.
            assert!(name != "AxisAligned" || sum.own > 1_000, "{sum:?}");
            in_instances += if name.starts_with("Instances") { sum.own } else { 0 };
        }
        assert!(in_instances > 0);
    }
}

/// Unit normal, in `f64`.
fn normal(triangle: &Triangle) -> DVec3 {
    let [p0, p1, p2] = triangle.map(|p| p.as_dvec3());
    let (e1, e2) = (p1 - p0, p2 - p0);
    let scale = e1.abs().max(e2.abs()).max_element().recip();
    (e1 * scale).cross(e2 * scale).normalize()
}

/// The largest coordinate.
fn size(triangle: &Triangle) -> f64 {
    f64::from(triangle.iter().fold(0.0f32, |s, p| s.max(p.abs().max_element())))
}

#[test]
fn a_surface_farther_than_both_errors_is_met() {
    for device in devices::all("a_surface_farther_than_both_errors_is_met") {
        let spread = Spread::of(budget() / 20);
        let mut sum = Sum::default();
        for seed in 0..spread.fields {
            let mut dice = Dice::new(90 + seed);
            let family = [Family::AxisAligned, Family::Tilted, Family::Any, Family::Far][seed as usize % 4];
            let first: Vec<Triangle> = (0..TRIANGLES).map(|_| family.triangle(range(&device), &mut dice)).collect();
            let (at, from) = (weights(&mut dice), dice.sphere());
            let wide = |by: f64| -> Vec<Triangle> {
                let place = |(t, error): (&Triangle, f64)| {
                    let p = t.map(|p| p.as_dvec3());
                    let middle = (p[0] + p[1] + p[2]) / 3.0;
                    p.map(|p| (middle + (p - middle) * 8.0 + normal(t) * error).as_vec3())
                };
                first.iter().map(|t| place((t, by))).collect()
            };
            // NaN where the first ray misses.
            let errors = |triangles: &[Triangle]| -> Vec<f32> {
                let island = Island { levels: Vec::new(), content: Content::Triangles(triangles.to_vec()) };
                let starts = (0..).zip(triangles).map(|(i, t)| start(&island, t, i, at, from)).collect();
                let batch = Batch { islands: vec![island], starts: vec![starts] };
                let departures = batch.run(&device, |field, island, s| field.leave(island, s, 1, false).unwrap());
                departures.iter().map(|d| if d.traced > 0 { d.error } else { f32::NAN }).collect()
            };
            let both: Vec<f32> = errors(&first).iter().zip(errors(&wide(0.0))).map(|(a, b)| a + b).collect();
            // The second surface is moved by the errors of both, and what rounding its vertices may take of that.
            let second = first.iter().zip(&both).map(|(t, &error)| {
                let p = t.map(|p| p.as_dvec3());
                let middle = (p[0] + p[1] + p[2]) / 3.0;
                let by = f64::from(if error.is_nan() { 0.0 } else { error }) * 1.01 + size(t) * 17.0 * 2f64.powi(-24);
                p.map(|p| (middle + (p - middle) * 8.0 + normal(t) * by).as_vec3())
            });
            let pairs: Vec<Triangle> = first.iter().copied().zip(second).flat_map(|(a, b)| [a, b]).collect();
            let known: Vec<u32> = (0..TRIANGLES).filter(|&i| both[i as usize].is_finite()).collect();
            assert!(known.len() * 4 > TRIANGLES as usize);
            let starts = (0..spread.starts)
                .map(|_| {
                    let i = dice.pick(&known);
                    let t = &pairs[2 * i as usize];
                    let island = Island { levels: Vec::new(), content: Content::Triangles(Vec::new()) };
                    let from = start(&island, t, 2 * i, weights(&mut dice), approach(&mut dice));
                    let leaving = normal(t).as_vec3().to_array();
                    Start { seed: dice.bits(), leaving, other: 2 * i + 1, ..from }
                })
                .collect();
            let island = Island { levels: Vec::new(), content: Content::Triangles(pairs) };
            let batch = Batch { islands: vec![island], starts: vec![starts] };
            sum.add(&batch.run(&device, |field, island, s| field.neighbours(island, s, spread.rays).unwrap()));
        }
        println!("surfaces close together, on {}: {sum:?}", device.description());
        assert!(sum.met * 4 > sum.starts, "{sum:?}");
        assert_eq!((sum.own, sum.lost), (0, 0));
    }
}

/// Pairs of triangles with a third one across the way between their points, and a start for each point.
fn pairs(range: [i32; 2], levels: usize, count: usize, dice: &mut Dice) -> Batch {
    let chain: Vec<Affine3A> = (0..levels).map(|_| level(dice)).collect();
    let empty = Island { levels: chain.clone(), content: Content::Triangles(Vec::new()) };
    let mut triangles = Vec::new();
    let mut starts = Vec::new();
    for _ in 0..count {
        let family = dice.pick(&[Family::AxisAligned, Family::Tilted, Family::Any, Family::Needle]);
        let (a, b) = (family.triangle(range, dice), family.triangle(range, dice));
        let away = dice.sphere() * (size(&a) as f32 * dice.power(1.0, 20.0));
        let b = b.map(|p| p + away);
        let (in_a, in_b) = (weights(dice), weights(dice));
        let at = |t: &Triangle, [u, v]: [f32; 2]| {
            let [p0, p1, p2] = t.map(|p| p.as_dvec3());
            p0 + (p1 - p0) * f64::from(u) + (p2 - p0) * f64::from(v)
        };
        let (from, to) = (at(&a, in_a), at(&b, in_b));
        // Across the way, anywhere on it.
        let (way, share) = (to - from, f64::from(0.1 + 0.8 * dice.unit()));
        let (x, y) = way.normalize().any_orthonormal_pair();
        let middle = from + way * share;
        let wide = way.length() * 0.3;
        let sheet = [x * wide, -x * wide + y * wide, -x * wide - y * wide].map(|d| (middle + d).as_vec3());
        let base = triangles.len() as u32;
        for (i, t, weights) in [(0, &a, in_a), (1, &b, in_b)] {
            // Near by, so that the first rays are not in the way of others.
            let first = start(&empty, t, base + i, weights, dice.sphere());
            starts.push(Start { other: base + 2, ..first });
        }
        triangles.extend([a, b, sheet]);
    }
    let island = Island { levels: chain, content: Content::Triangles(triangles) };
    Batch { islands: vec![island], starts: vec![starts] }
}

#[test]
fn segments_meet_what_is_between_and_no_end() {
    for device in devices::all("segments_meet_what_is_between_and_no_end") {
        let count = (budget() / 20).clamp(1_000, 1 << 16) as usize;
        let mut sums = [Sum::default(); 3];
        let fields = count.div_ceil(512).max(12);
        for seed in 0..fields {
            let levels = seed % 3;
            let batch = pairs(range(&device), levels, count / fields, &mut Dice::new(700 + seed as u64));
            let departures = batch.run(&device, |field, island, s| field.between(island, s).unwrap());
            sums[levels].add(&departures);
            let failed = (0..departures.len()).filter(|&i| departures[i].own + departures[i].lost > 0);
            for (count, i) in failed.enumerate() {
                // Whether the ray fails, or the structure.
                if count == 0 {
                    let alone = batch.pair(i).run(&device, |field, island, s| field.between(island, s).unwrap());
                    println!("  field {seed}, {levels} levels, pair {i}: {:?}, alone {:?}", departures[i], alone[0]);
                } else if count % 100 == 0 {
                    println!("  {count} more in field {seed}, the last pair {i}");
                }
            }
        }
        println!("segments, by levels of instances, on {}: {sums:?}", device.description());
        for sum in sums {
            assert!(sum.met * 4 > sum.starts, "{sum:?}");
            assert_eq!((sum.own, sum.lost), (0, 0));
        }
    }
}

/// A ray meets the one triangle that it does not ignore, whether it ends soon after that or never.
#[test]
fn rays_without_an_end_return() {
    for device in devices::all("rays_without_an_end_return") {
        let batch = pairs(range(&device), 0, 510, &mut Dice::new(700));
        let met = |reach| batch.run(&device, |field, island, s| field.met(island, s, reach).unwrap());
        let ends = met(2.0);
        let hits = ends.iter().filter(|d| d.error > 0.0).count();
        assert!(hits * 4 > ends.len(), "{hits} of {}", ends.len());
        assert_eq!(met(f32::MAX), ends);
        println!("rays without an end, on {}: {hits} hits as those that end", device.description());
    }
}

#[test]
fn offsets_are_not_much_too_large() {
    for device in devices::all("offsets_are_not_much_too_large") {
        let starts = (budget() / 1_000).clamp(1_000, 20_000) as usize;
        println!("offset over the smallest that works for 64 directions, on {}:", device.description());
        for (number, (name, make)) in families(range(&device)).iter().enumerate() {
            let batch = make(starts, &mut Dice::new(40 + number as u64));
            let departures = batch.run(&device, |field, island, s| field.margins(island, s, 64).unwrap());
            let mut margins: Vec<f32> = departures.iter().map(|d| d.margin).filter(|m| *m >= 0.0).collect();
            let hits = margins.len();
            // Where no ray meets the surface again even without an offset there is no ratio.
            margins.retain(|m| *m > 0.0);
            let none = 100.0 * (hits - margins.len()) as f64 / hits as f64;
            margins.sort_by(f32::total_cmp);
            if margins.is_empty() {
                println!("  {name:<14} no hit of {hits} needs an offset");
                continue;
            }
            let at = |share: f64| margins[((margins.len() - 1) as f64 * share) as usize].recip();
            // Large offsets are those with small margins.
            let (median, most, least) = (at(0.5), at(0.01), at(1.0));
            println!(
                "  {name:<14} median {median:>8.1}  99 % below {most:>8.1}  least {least:>8.2}  none needed {none:>5.1} % of {hits}"
            );
            assert!(least > 1.0, "{name}: {least}");
        }
    }
}

/// Where products of coordinates over- and underflow, a machine's test has limits that the bound can't mend.
#[test]
fn the_bound_holds_at_all_sizes_that_a_machine_can_do() {
    for device in devices::all("the_bound_holds_at_all_sizes_that_a_machine_can_do") {
        println!("hits and worst offset in units of the bound, by size, on {}:", device.description());
        let [least, most] = range(&device);
        for exponent in (-80..=80).step_by(4) {
            let mut dice = Dice::new(exponent as u64);
            let mut batch = Batch::new(&[Family::AxisAligned, Family::Any], [0, 0], 0, 512, &mut dice);
            let Content::Triangles(triangles) = &mut batch.islands[0].content else { unreachable!() };
            for triangle in &mut *triangles {
                let scale = 2f32.powi(exponent) / extent(triangle);
                *triangle = triangle.map(|p| p * scale);
            }
            let (triangles, primitives) = (triangles.clone(), batch.starts[0].iter().map(|s| s.primitive));
            let island = &batch.islands[0];
            let starts = primitives
                .map(|i| {
                    let start = start(island, &triangles[i as usize], i, weights(&mut dice), dice.sphere() * 4.0);
                    Start { seed: dice.bits(), ..start }
                })
                .collect();
            batch.starts = vec![starts];
            let departures = batch.run(&device, |field, island, s| field.margins(island, s, 64).unwrap());
            let met = departures.iter().filter(|d| d.margin >= 0.0).count();
            let worst = departures.iter().fold(0.0f32, |worst, d| worst.max(d.margin));
            println!("  2^{exponent:<4} {met:>4} of {}, {worst:.3}", departures.len());
            assert!(!(least..=most).contains(&exponent) || met * 2 > departures.len() && worst < 1.0);
        }
    }
}
