//! Rays from inside closed meshes: none may get out.
//!
//! `KERNEL_WATERTIGHT_RAYS=10000000 cargo test --release -p optix-host watertight -- --nocapture` traces 10 million.

use std::collections::HashMap;

use rayon::prelude::*;

use super::*;

struct Mesh {
    vertices: Vec<[f64; 3]>,
    indices: Vec<[u32; 3]>,
}

/// An icosahedron, each face split into `4^levels`, on the unit sphere; corners are shared.
fn icosphere(levels: u32) -> Mesh {
    let phi = 0.5 + 1.25f64.sqrt();
    let unit = |p: [f64; 3]| {
        let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        p.map(|x| x / length)
    };
    let mut vertices = Vec::new();
    for (a, b) in [(1.0, phi), (-1.0, phi), (1.0, -phi), (-1.0, -phi)] {
        vertices.extend([[a, b, 0.0], [0.0, a, b], [b, 0.0, a]].map(unit));
    }
    // The faces are the triples of mutual neighbours.
    let near = |i: usize, j: usize| {
        let d: f64 = (0..3).map(|a| (vertices[i][a] - vertices[j][a]).powi(2)).sum();
        d < 1.2
    };
    let mut indices = Vec::new();
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if near(i, j) && near(j, k) && near(i, k) {
                    let [a, b, c] = [i, j, k].map(|i| vertices[i]);
                    let cross = |x: usize, y: usize| a[x] * b[y] - a[y] * b[x];
                    let outward = cross(1, 2) * c[0] + cross(2, 0) * c[1] + cross(0, 1) * c[2] > 0.0;
                    indices.push(if outward { [i, j, k] } else { [i, k, j] }.map(|i| i as u32));
                }
            }
        }
    }
    for _ in 0..levels {
        let mut middles = HashMap::new();
        let mut finer = Vec::with_capacity(4 * indices.len());
        for [a, b, c] in indices {
            let mut middle = |i: u32, j: u32| {
                *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                    let sum = [0, 1, 2].map(|k| vertices[i as usize][k] + vertices[j as usize][k]);
                    vertices.push(unit(sum));
                    vertices.len() as u32 - 1
                })
            };
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        indices = finer;
    }
    Mesh { vertices, indices }
}

/// A sphere by rings and segments: long thin triangles at the poles, and many corners on the coordinate planes.
fn uv_sphere(rings: u32, segments: u32) -> Mesh {
    let mut vertices = vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    for i in 1..rings {
        for j in 0..segments {
            let theta = f64::from(i) / f64::from(rings) * std::f64::consts::PI;
            let phi = f64::from(j) / f64::from(segments) * std::f64::consts::TAU;
            vertices.push([theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]);
        }
    }
    let at = |i: u32, j: u32| 2 + (i - 1) * segments + j % segments;
    let mut indices = Vec::new();
    for j in 0..segments {
        indices.extend([[0, at(1, j), at(1, j + 1)], [1, at(rings - 1, j + 1), at(rings - 1, j)]]);
        for i in 1..rings - 1 {
            indices.extend([[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]);
        }
    }
    Mesh { vertices, indices }
}

/// A Wavefront file, its holes closed by fans. `None` where there is no file, or no closed surface comes of it.
fn load(file: &str) -> Option<Mesh> {
    let text = std::fs::read_to_string(file).ok()?;
    let (mut vertices, mut indices) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => vertices.push([(); 3].map(|()| words.next().and_then(|w| w.parse().ok()).unwrap_or(f64::NAN))),
            Some("f") => {
                let corners: Vec<u32> =
                    words.filter_map(|w| w.split('/').next()?.parse::<u32>().ok()).map(|i| i - 1).collect();
                indices.extend((2..corners.len()).map(|i| [corners[0], corners[i - 1], corners[i]]));
            }
            _ => {}
        }
    }
    let mut open = open_edges(&indices);
    while let Some((&from, _)) = open.iter().next() {
        let mut loop_ = vec![from];
        while let Some(next) = open.get_mut(loop_.last()?).and_then(Vec::pop) {
            loop_.push(next);
            if next == from {
                break;
            }
        }
        open.retain(|_, to| !to.is_empty());
        if loop_.last() != Some(&from) || loop_.len() < 3 {
            return None;
        }
        let sum = loop_[1..].iter().fold([0.0; 3], |s, &i| [0, 1, 2].map(|a| s[a] + vertices[i as usize][a]));
        vertices.push(sum.map(|x| x / (loop_.len() - 1) as f64));
        let centre = vertices.len() as u32 - 1;
        indices.extend(loop_.windows(2).map(|pair| [pair[1], pair[0], centre]));
    }
    open_edges(&indices).is_empty().then_some(Mesh { vertices, indices })
}

/// Directed edges without an opposite one. A surface without any is closed: every edge has as many triangles on the one
/// side as on the other.
fn open_edges(indices: &[[u32; 3]]) -> std::collections::BTreeMap<u32, Vec<u32>> {
    let mut balance = std::collections::BTreeMap::<(u32, u32), i32>::new();
    for t in indices {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            *balance.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
        }
    }
    let mut open = std::collections::BTreeMap::<u32, Vec<u32>>::new();
    for ((a, b), n) in balance {
        let (from, to) = if n > 0 { (a, b) } else { (b, a) };
        for _ in 0..n.abs() {
            open.entry(from).or_default().push(to);
        }
    }
    open
}

/// Whether the rounded surface goes round a point, off the surface itself: solid angles after Van Oosterom and Strackee,
/// "The Solid Angle of a Plane Triangle" (1983).
fn is_inside(vertices: &[[f32; 3]], indices: &[[u32; 3]], point: [f32; 3]) -> bool {
    let mut sum = 0.0;
    for t in indices {
        let [a, b, c] = t.map(|i| [0, 1, 2].map(|k| f64::from(vertices[i as usize][k]) - f64::from(point[k])));
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let minor = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
        let volume = minor(1, 2) * c[0] + minor(2, 0) * c[1] + minor(0, 1) * c[2];
        let [la, lb, lc] = [a, b, c].map(|v| dot(v, v).sqrt());
        let size = la * lb * lc;
        let spread = size + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        // In the plane of the triangle and not beside it: on the surface.
        if volume.abs() <= 1e-6 * size && spread <= 1e-6 * size {
            return false;
        }
        sum += 2.0 * volume.atan2(spread);
    }
    (sum / (4.0 * std::f64::consts::PI)).abs() > 0.5
}

#[derive(Default)]
struct Tally {
    traced: usize,
    escaped: usize,
    triangles: usize,
    /// Made so by rounding.
    degenerate: usize,
}

/// Scales and moves a mesh at random, rounds it, and traces `rays` from points inside, if rounding has left any.
fn escape(mesh: &Mesh, rays: usize, seed: u64, tally: &mut Tally) {
    let mut random = Random(seed);
    let low: [f64; 3] = [0, 1, 2].map(|a| mesh.vertices.iter().map(|v| v[a]).fold(f64::MAX, f64::min));
    let high: [f64; 3] = [0, 1, 2].map(|a| mesh.vertices.iter().map(|v| v[a]).fold(f64::MIN, f64::max));
    let size = (0..3).map(|a| high[a] - low[a]).fold(0.0, f64::max);
    let scale = 10f64.powf(6.0 * random.signed());
    let distance = if random.below(4) == 0 { 0.0 } else { size * 10f64.powf(6.0 * random.unit()) };
    let shift = random.sphere().map(|x| x * distance);
    let round = |p: [f64; 3]| -> [f32; 3] { std::array::from_fn(|a| (scale * (p[a] + shift[a])) as f32) };
    let vertices: Vec<[f32; 3]> = mesh.vertices.iter().map(|&v| round(v)).collect();
    let degenerate = mesh
        .indices
        .iter()
        .filter(|t| {
            let [a, b, c] = t.map(|i| vertices[i as usize]);
            a == b || b == c || c == a
        })
        .count();

    let mut origins = Vec::new();
    for attempt in 0..200 {
        let p = [0, 1, 2].map(|a| {
            let middle = 0.5 * (low[a] + high[a]);
            if attempt == 0 { middle } else { middle + 0.5 * random.signed() * (high[a] - low[a]) }
        });
        let p = round(p);
        if is_inside(&vertices, &mesh.indices, p) {
            origins.push(p);
        }
        if origins.len() == 4 {
            break;
        }
    }
    if origins.is_empty() {
        return;
    }

    let accel = super::mesh(&vertices, &mesh.indices);
    let escaped: usize = (0..rays.div_ceil(4096))
        .into_par_iter()
        .map(|chunk| {
            let mut random = Random(seed ^ (chunk as u64) << 20);
            (0..4096.min(rays - 4096 * chunk))
                .filter(|i| {
                    let origin = origins[random.below(origins.len())];
                    let corners = mesh.indices[random.below(mesh.indices.len())].map(|i| vertices[i as usize]);
                    let towards =
                        |p: [f64; 3]| -> [f32; 3] { std::array::from_fn(|a| (p[a] - f64::from(origin[a])) as f32) };
                    let [a, b] = [corners[0], corners[1]].map(|v| v.map(f64::from));
                    let direction = match i % 6 {
                        0 => towards(a),
                        1 => {
                            let s = if i % 12 == 1 { 0.5 } else { random.unit() };
                            towards([0, 1, 2].map(|k| a[k] + s * (b[k] - a[k])))
                        }
                        2 => {
                            let mut axis = random.sphere().map(|x| x as f32);
                            axis[random.below(3)] = 0.0;
                            axis
                        }
                        _ => random.sphere().map(|x| x as f32),
                    };
                    if direction == [0.0; 3] {
                        return false;
                    }
                    let query = RayQuery::new(origin, direction);
                    match trace(Some(&accel), &query, &mut Opaque) {
                        Some(hit) => !(hit.t >= 0.0 && hit.t.is_finite()),
                        None => true,
                    }
                })
                .count()
        })
        .sum();
    tally.traced += rays;
    tally.escaped += escaped;
    tally.triangles += mesh.indices.len();
    tally.degenerate += degenerate;
}

#[test]
fn nothing_escapes_a_closed_mesh() {
    let total: usize = std::env::var("KERNEL_WATERTIGHT_RAYS").ok().and_then(|n| n.parse().ok()).unwrap_or(1_000_000);
    let mut meshes = vec![("icosphere".to_string(), icosphere(6)), ("UV sphere".to_string(), uv_sphere(180, 280))];
    for name in ["fandisk", "rocker-arm", "stanford-bunny", "suzanne"] {
        match load(&format!("{}/../../shared/data/{name}.obj", env!("CARGO_MANIFEST_DIR"))) {
            Some(mesh) => meshes.push((name.to_string(), mesh)),
            None => println!("{name}: no file, or no closed surface"),
        }
    }
    let share = total.div_ceil(meshes.len());
    let rays = (share / 5).min(25_000);
    for (name, mesh) in &meshes {
        assert!(open_edges(&mesh.indices).is_empty());
        let mut tally = Tally::default();
        for seed in 0.. {
            if tally.traced >= share {
                break;
            }
            escape(mesh, rays, 1000 * seed + 17, &mut tally);
        }
        let Tally { traced, escaped, triangles, degenerate } = tally;
        println!(
            "{name}: {} triangles, {traced} rays, {escaped} escaped; {:.1} % of triangles made degenerate by rounding",
            mesh.indices.len(),
            100.0 * degenerate as f64 / triangles as f64
        );
        assert_eq!(escaped, 0, "{name}");
    }
}

#[test]
fn threads_do_not_change_the_result() {
    let sphere = icosphere(4);
    let vertices: Vec<[f32; 3]> = sphere.vertices.iter().map(|v| v.map(|x| x as f32)).collect();
    let accel = super::mesh(&vertices, &sphere.indices);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            (0..20_000u64)
                .into_par_iter()
                .map(|i| {
                    let mut random = Random(i);
                    let query =
                        RayQuery::new(random.sphere().map(|x| 2.0 * x as f32), random.sphere().map(|x| x as f32));
                    trace(Some(&accel), &query, &mut Opaque).map(|h| (h.t.to_bits(), h.primitive_index, h.attributes))
                })
                .collect::<Vec<_>>()
        })
    };
    assert_eq!(run(1), run(5));
}
