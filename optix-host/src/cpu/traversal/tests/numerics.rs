//! Signs, bounds and identities, against exact arithmetic and brute force.

use std::cmp::Ordering;

use super::super::bvh::SINGLE_LEAF;
use super::super::bvh::{Bvh, Lanes};
use super::super::primitive::triangle::intersect::{self as triangle, Block, Sheared, TriangleHit, edge};
use super::super::ray::{Axis, BoxRay, PreparedRay, ShearRay};
use super::super::simd::Task;
use super::*;
use crate::cpu::traversal::simd::Portable;

/// A random float of either sign over the given binary exponents; now and then 0 or a neighbour of a power of two.
fn float(random: &mut Random, low: i32, high: i32) -> f32 {
    let exponent = low + random.below((high - low) as usize) as i32;
    let mantissa = match random.below(8) {
        0 => 1.0,
        1 => 1.0f32.next_up(),
        2 => 1.0f32.next_down(),
        _ => 1.0 + random.unit() as f32,
    };
    let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
    if random.below(40) == 0 { 0.0 } else { (f64::from(sign * mantissa) * 2f64.powi(exponent)) as f32 }
}

/// Sign, mantissa and exponent: `x = s m 2^e` exactly.
fn parts(x: f32) -> (i128, i32) {
    let bits = x.to_bits();
    let (e, m) = ((bits >> 23 & 0xff) as i32, i128::from(bits & 0x7f_ffff));
    let (m, e) = if e == 0 { (m, -149) } else { (m | 1 << 23, e - 150) };
    (if x.is_sign_negative() { -m } else { m }, e)
}

/// The sign of `a b - c d` in integers.
fn exact_sign(a: f32, b: f32, c: f32, d: f32) -> Ordering {
    let product = |x: f32, y: f32| {
        let ((m, e), (n, f)) = (parts(x), parts(y));
        (m * n, e + f)
    };
    let ((p, e), (q, f)) = (product(a, b), product(c, d));
    if p == 0 || q == 0 || p.signum() != q.signum() {
        return p.signum().cmp(&q.signum());
    }
    // Bring both to the smaller exponent; 71 and more apart the larger one decides, since |p|, |q| < 2^48.
    match e - f {
        71.. => p.cmp(&0),
        up @ 0.. => (p << up).cmp(&q),
        down @ -70.. => p.cmp(&(q << -down)),
        _ => 0.cmp(&q),
    }
}

#[test]
fn edge_signs_are_exact() {
    let mut random = Random(11);
    let mut zeros = 0;
    for i in 0..400_000 {
        let spread = [(-149, 127), (-10, 10), (-1, 1), (-149, -120)][i % 4];
        let mut x = [(); 4].map(|()| float(&mut random, spread.0, spread.1));
        match i / 4 % 4 {
            // Equal and nearly equal products.
            0 => (x[2], x[3]) = (x[1], x[0]),
            1 => (x[2], x[3]) = (x[1].next_up(), x[0]),
            2 => (x[2], x[3]) = (x[0] * 0.5, x[1] * 2.0),
            _ => {}
        }
        if x.iter().any(|x| !x.is_finite()) {
            continue;
        }
        let [a, b, c, d] = x;
        let value = edge([a, c, 0.0], [d, b, 0.0]);
        let sign = exact_sign(a, b, c, d);
        zeros += usize::from(sign == Ordering::Equal);
        assert_eq!(value.partial_cmp(&0.0), Some(sign), "{x:?}");
    }
    assert!(zeros > 10_000);
}

/// A triangle and a ray that mostly passes near its border.
fn case(random: &mut Random, spread: (i32, i32)) -> ([[f32; 3]; 3], Ray) {
    let corners = [(); 3].map(|()| [(); 3].map(|()| float(random, spread.0, spread.1)));
    let origin = [(); 3].map(|()| float(random, spread.0, spread.1));
    // Inside, on an edge, or beside it.
    let third = [0.0, random.unit(), -0.2 * random.unit()][random.below(3)];
    let weights = [random.unit(), random.unit(), third];
    let sum: f64 = weights.iter().sum::<f64>().max(1e-9);
    let direction = std::array::from_fn(|a| {
        let target: f64 = (0..3).map(|c| weights[c] / sum * f64::from(corners[c][a])).sum();
        (target - f64::from(origin[a])) as f32
    });
    (corners, Ray { origin, direction })
}

fn prepared(ray: &Ray, corners: &[[f32; 3]]) -> Option<PreparedRay> {
    let prepared = PreparedRay::new(&ray.origin, &ray.direction, 0.0)?;
    (prepared.is_far(&Aabb::around(corners)) == Some(false)).then_some(prepared)
}

/// The exact test of a triangle in object space, sheared by the operations of the vector kernels.
fn hit(ray: &ShearRay, corners: [[f32; 3]; 3]) -> Option<TriangleHit> {
    let sheared = corners.map(|corner| {
        let [x, y, z] = [0, 1, 2].map(|i| corner[ray.axes[i] as usize] - ray.origin[i]);
        [x - ray.slope[0] * z, y - ray.slope[1] * z, z]
    });
    triangle::hit(ray, sheared)
}

/// The triangle's exact sheared corners (to `2^-50`), distances of the origin from its edges, and the depth there.
struct Reference {
    reach: f64,
    /// Inside positive.
    inside: f64,
    outside: f64,
    depth: f64,
    /// `|g_x| + |g_y|` of the plane.
    tilt: f64,
    smallest_height: f64,
}

fn reference(corners: &[[f32; 3]; 3], ray: &Ray, axes: [Axis; 3]) -> Option<Reference> {
    let axes = axes.map(|a| a as usize);
    let o = ray.origin.map(f64::from);
    let d = ray.direction.map(f64::from);
    let moved = corners.map(|v| [0, 1, 2].map(|a| f64::from(v[a]) - o[a]));
    let reach = moved.iter().flatten().fold(0.0f64, |r, x| r.max(x.abs()));
    let s = moved.map(|v| {
        let z = v[axes[2]];
        [v[axes[0]] - d[axes[0]] / d[axes[2]] * z, v[axes[1]] - d[axes[1]] / d[axes[2]] * z, z]
    });
    let cross = |a: [f64; 3], b: [f64; 3]| a[0] * b[1] - a[1] * b[0];
    let area = cross([s[1][0] - s[0][0], s[1][1] - s[0][1], 0.], [s[2][0] - s[0][0], s[2][1] - s[0][1], 0.]);
    let (mut inside, mut outside, mut smallest_height, mut depth) = (f64::MAX, f64::MIN, f64::MAX, 0.0);
    for i in 0..3 {
        let (a, b) = (s[(i + 1) % 3], s[(i + 2) % 3]);
        let length = (a[0] - b[0]).hypot(a[1] - b[1]);
        let signed = cross(a, b) * area.signum();
        inside = inside.min(signed / length);
        outside = outside.max(-signed / length);
        smallest_height = smallest_height.min(area.abs() / length);
        depth += signed * s[i][2];
    }
    let [ax, ay, az] = [0, 1, 2].map(|k| s[1][k] - s[0][k]);
    let [bx, by, bz] = [0, 1, 2].map(|k| s[2][k] - s[0][k]);
    let (gx, gy) = ((az * by - bz * ay) / area, (bz * ax - az * bx) / area);
    let tilt = gx.abs() + gy.abs();
    let result = Reference { reach, inside, outside, depth: depth / area.abs(), tilt, smallest_height };
    (area != 0.0 && tilt.is_finite()).then_some(result)
}

#[test]
fn hits_and_distances_keep_their_bound() {
    let e = 2f64.powi(-24);
    let mut random = Random(5);
    let (mut checked, mut worst, mut sure_hits, mut sure_misses) = (0, 0.0f64, 0, 0);
    for i in 0..600_000 {
        let spread = [(-3, 3), (-20, 1), (-100, -90), (90, 100), (-40, 40), (10, 12)][i % 6];
        let (corners, ray) = case(&mut random, spread);
        let Some(prepared) = prepared(&ray, &corners) else { continue };
        let got = hit(&prepared.shear, corners);
        let Some(exact) = reference(&corners, &ray, prepared.shear.axes) else { continue };
        if let Some(TriangleHit { t, u, v, .. }) = got {
            assert!(t.is_finite() && (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v));
        }
        // Corners move by up to 6 e r on two axes, so the border moves by at most 6 sqrt(2) e r.
        let margin = 8.5 * e * exact.reach;
        let ahead = exact.depth / prepared.shear.major > 0.0 && exact.depth.abs() > 1e4 * margin;
        if exact.inside > margin && ahead {
            sure_hits += 1;
            assert!(got.is_some(), "{corners:?} {ray:?} inside by {}", exact.inside / margin);
        }
        if exact.outside > margin {
            sure_misses += 1;
            assert!(got.is_none(), "{corners:?} {ray:?} outside by {}", exact.outside / margin);
        }
        // The first-order bound is meant for triangles much larger than the rounding.
        let (Some(got), true) = (got, exact.smallest_height > 1e4 * margin) else { continue };
        let depth = f64::from(got.t) * prepared.shear.major;
        let bound = e * exact.reach * (1.0 + 6.0 * exact.tilt) * 1.01 + e * exact.depth.abs() * 1.01;
        let tiny = f64::from(f32::MIN_POSITIVE) * prepared.shear.major.abs();
        assert!((depth - exact.depth).abs() <= bound + tiny, "{} of the bound", (depth - exact.depth).abs() / bound);
        worst = worst.max((depth - exact.depth).abs() / bound);
        checked += 1;
    }
    println!(
        "{checked} distances, the worst at {worst:.3} of the bound; {sure_hits} sure hits, {sure_misses} sure misses"
    );
    assert!(checked > 50_000 && sure_hits > 100_000 && sure_misses > 10_000);
}

/// Every triangle, in order; nearest first, ties to the first.
fn brute_force(vertices: &[[f32; 3]], indices: &[[u32; 3]], query: &RayQuery) -> Option<(f32, u32)> {
    let ray = Ray { origin: query.origin, direction: query.direction };
    let used: Vec<_> = indices.iter().flatten().map(|&i| vertices[i as usize]).collect();
    let prepared = prepared(&ray, &used)?;
    let mut best: Option<(f32, u32)> = None;
    for (i, corners) in indices.iter().enumerate() {
        if let Some(hit) = hit(&prepared.shear, corners.map(|i| vertices[i as usize]))
            && hit.t >= query.tmin
            && best.map_or(hit.t <= query.tmax, |(t, _)| hit.t < t)
        {
            best = Some((hit.t, i as u32));
        }
    }
    best
}

#[test]
fn traversal_equals_brute_force() {
    let mut random = Random(21);
    let mut hits = [0; 6];
    for round in 0..240 {
        let kind = round % 6;
        let scale = 2f64.powi([0, -100, 100, 0, 0, 0][kind]);
        let offset = random.sphere().map(|x| x * [0.0, 0.0, 0.0, 1e6, 0.0, 1.0][kind]);
        let vertices: Vec<[f32; 3]> = (0..150)
            .map(|_| {
                let mut p = random.sphere().map(|x| x * random.unit());
                match kind {
                    // A flat sheet, and a lattice on which most rays run along edges and through corners.
                    4 => p[2] = 0.0,
                    5 => p = p.map(|x| (x * 4.0).round() / 4.0),
                    _ => {}
                }
                std::array::from_fn(|a| ((p[a] + if kind == 5 { 0.0 } else { offset[a] }) * scale) as f32)
            })
            .collect();
        let near = |random: &mut Random, i: usize| {
            let j = if random.below(2) == 0 { i } else { random.below(150) };
            j as u32
        };
        let indices: Vec<[u32; 3]> = (0..200)
            .map(|i| [near(&mut random, i % 150), random.below(150) as u32, random.below(150) as u32])
            .collect();
        let accel = mesh(&vertices, &indices);
        for i in 0..200 {
            let mut origin: [f32; 3] = std::array::from_fn(|a| {
                ((random.signed() * 1.5 + if kind == 3 { offset[a] } else { 0.0 }) * scale) as f32
            });
            if kind == 5 {
                origin = origin.map(|x| (x * 4.0).round() / 4.0);
            }
            let mut direction: [f32; 3] = match i % 5 {
                0 => random.sphere().map(|x| x as f32),
                1 => {
                    let v = vertices[random.below(150)];
                    std::array::from_fn(|a| v[a] - origin[a])
                }
                2 => [(); 3].map(|()| float(&mut random, -149, 127)),
                3 => [(); 3].map(|()| [0.0, -0.0, 1.0, -1.0, 1e-42][random.below(5)]),
                _ => {
                    let (v, w) = (vertices[random.below(150)], vertices[random.below(150)]);
                    std::array::from_fn(|a| 0.5 * v[a] + 0.5 * w[a] - origin[a])
                }
            };
            if i % 7 == 0 {
                direction[random.below(3)] = 0.0;
            }
            let mut query = RayQuery::new(origin, direction);
            if i % 3 == 0
                && let Some((t, _)) = brute_force(&vertices, &indices, &query)
            {
                query.tmin = t;
                query.tmax = if i % 2 == 0 { t } else { f32::INFINITY };
            }
            let expected = brute_force(&vertices, &indices, &query);
            let portable = trace_portable(Some(&accel), &query, &mut Opaque);
            let fastest = trace(Some(&accel), &query, &mut Opaque);
            let key = |hit: Option<Hit<'_>>| hit.map(|h| (h.t.to_bits(), h.primitive_index, h.hit_kind, h.attributes));
            assert_eq!(fastest.map(|h| (h.t, h.primitive_index)), expected, "kind {kind} {query:?}");
            assert_eq!(key(fastest), key(portable));
            hits[kind] += usize::from(expected.is_some());
        }
    }
    println!("hits {hits:?}");
    assert!(hits.iter().all(|&h| h > 500), "{hits:?}");
}

#[test]
#[cfg(target_arch = "x86_64")]
fn vector_kernels_are_bit_identical() {
    use super::super::simd::{Avx2, Simd};
    struct Both<'t> {
        block: &'t Block,
        bvh: &'t Bvh,
        prepared: &'t PreparedRay,
        ray: &'t BoxRay,
        limit: f32,
    }
    impl Task for Both<'_> {
        type Output = (u32, Vec<u32>, Vec<(u32, Vec<u32>)>);
        fn run<S: Simd>(self, simd: S) -> Self::Output {
            let boxes = self.bvh.nodes.iter().map(|node| {
                let mut near = Lanes([0.0; 8]);
                let met = simd.boxes(node, self.ray, self.limit, &mut near);
                (met, (0..8).filter(|i| met >> i & 1 != 0).map(|i| near.0[i].to_bits()).collect())
            });
            let depths = [self.prepared.depth_min, self.limit];
            let mut sheared = Sheared::default();
            let met = simd.triangles(self.block, &self.prepared.shear, depths, &mut sheared);
            let corners = sheared.iter().flatten().flat_map(|axis| axis.0.map(f32::to_bits)).collect();
            (met, corners, boxes.collect())
        }
    }
    let Some(avx2) = Avx2::detect() else { return println!("no AVX2 here") };
    let mut random = Random(31);
    for i in 0..20_000 {
        let spread = [(-3, 3), (-149, 124), (-30, 30), (-149, -110)][i % 4];
        let cases = [(); 8].map(|()| case(&mut random, spread));
        let triangles = cases.map(|c| c.0);
        let boxes = triangles.map(|t| Aabb::around(&t));
        let ray = cases[0].1;
        // The rays of `case` end at `t = 1` on their triangles' planes, so these intervals cut.
        let (tmin, tmax) = ([0.0, 1.0][i / 4 % 2], [f32::INFINITY, 1.0][i % 2]);
        let Some(prepared) = PreparedRay::new(&ray.origin, &ray.direction, tmin) else { continue };
        let bvh = Bvh::build(&boxes, SINGLE_LEAF, |primitives| primitives[0]);
        let Some(ray) = prepared.boxes(&bvh.bounds, 1.0) else { continue };
        let block = Block::new(&[0, 1, 2, 3, 4, 5, 6, 7], &triangles);
        let limit = prepared.depth_max(tmax);
        let task = || Both { block: &block, bvh: &bvh, prepared: &prepared, ray: &ray, limit };
        let (a, b) = (avx2.run(task()), Portable.run(task()));
        assert_eq!(a, b);
        for (lane, &triangle) in triangles.iter().enumerate() {
            if hit(&prepared.shear, triangle).is_some_and(|hit| hit.t >= tmin && hit.t <= tmax) {
                assert!(a.0 >> lane & 1 != 0, "the vector test dropped a hit");
            }
        }
    }
}

#[test]
fn exponentially_growing_triangles_do_not_overflow_the_stack() {
    // Every surface-area hierarchy of these is a chain.
    let mut vertices = Vec::new();
    for i in -110..110 {
        let s = 2f32.powi(i);
        vertices.extend([[s, 0.0, 0.0], [s, s, 0.0], [s, 0.0, s]]);
    }
    let count = vertices.len() / 3;
    let accel = Accel::from(Gas::new(vec![triangles(vertices, None, ON)]).unwrap());
    let mut programs = Scripted::new(AnyHit::Ignore);
    let query = RayQuery::new([0.0; 3], [1.0, 0.25, 0.25]);
    assert!(trace(Some(&accel), &query, &mut programs).is_none());
    assert_eq!(programs.calls.len(), count);
}

#[test]
fn coincident_and_collinear_triangles_build_quickly() {
    let count = 100_000;
    let right = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let equal = vec![right; count].concat();
    let points = vec![[[1.0f32; 3]; 3]; count].concat();
    let line = (0..count).flat_map(|i| [[i as f32, 0.0, 0.0]; 3]).collect();
    for (vertices, hits) in [(equal, count), (points, 0), (line, 0)] {
        let begin = std::time::Instant::now();
        let accel = Accel::from(Gas::new(vec![triangles(vertices, None, ON)]).unwrap());
        assert!(begin.elapsed().as_secs() < 20, "{:?}", begin.elapsed());
        let mut programs = Scripted::new(AnyHit::Ignore);
        assert!(trace(Some(&accel), &down(), &mut programs).is_none());
        assert_eq!(programs.calls.len(), hits);
    }
}
