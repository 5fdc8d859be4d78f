//! No ray leaves a closed mesh: rays from inside, a third of them aimed at edges and vertices.
//!
//! `OPTIX_TEST_RAYS=10000000` sets how many rays there are in all; the default is small enough for every run.

use glam::{Affine3A, Vec3};
use optix_device_rs::rng::Pcg32;
use optix_tests::meshes::{self, Model};
use optix_tests::probe::{Part, ProbeRay, Tracer, ray};
use optix_tests::devices;

/// Rays from near `inside`: in all directions, at points of edges, at vertices.
fn rays(model: &Model, inside: Vec3, spread: f32, count: usize, rng: &mut Pcg32) -> Vec<ProbeRay> {
    let mut rays = Vec::with_capacity(count);
    while rays.len() < count {
        let [x, y, z] = core::array::from_fn(|_| rng.next_f32() * 2.0 - 1.0);
        let from = inside + Vec3::new(x, y, z) * spread;
        let triangle = model.indices[rng.next_u32() as usize % model.indices.len()];
        let [a, b, _] = triangle.map(|i| model.positions[i as usize]);
        let direction = match rays.len() % 6 {
            0 => a - from,
            1 => a + (b - a) * rng.next_f32() - from,
            _ => Vec3::from_array(core::array::from_fn(|_| rng.next_f32() * 2.0 - 1.0)),
        };
        if direction != Vec3::ZERO {
            rays.push(ray(from, direction));
        }
    }
    rays
}

/// A point well inside, found by tracing: half way between two hits of a line, where the first face is seen from outside.
fn inside(tracer: &Tracer, model: &Model) -> Option<(Vec3, f32)> {
    let (lo, hi) =
        model.positions.iter().fold((Vec3::MAX, Vec3::MIN), |(lo, hi), &p| (lo.min(p), hi.max(p)));
    let size = (hi - lo).length();
    let mut best: Option<(Vec3, f32)> = None;
    let mut rng = Pcg32::hashed(9, 9);
    for _ in 0..64 {
        let at: [f32; 3] = core::array::from_fn(|_| 0.25 + 0.5 * rng.next_f32());
        let target = lo + (hi - lo) * Vec3::from_array(at);
        let from = target + Vec3::new(0.31, 0.53, 0.79) * size;
        let along = target - from;
        let first = tracer.trace(&[ray(from, along)]).ok()?[0];
        if first.instance == !0 || first.kind != 254 {
            continue;
        }
        let again = ProbeRay { tmin: first.t * (1.0 + 1e-5), ..ray(from, along) };
        let second = tracer.trace(&[again]).ok()?[0];
        let depth = (second.t - first.t) * along.length();
        if second.instance != !0 && best.is_none_or(|(_, d)| depth > 2.0 * d) {
            best = Some((from + along * (0.5 * (first.t + second.t)), 0.5 * depth));
        }
    }
    best
}

#[test]
fn no_ray_leaves() {
    let total: usize = std::env::var("OPTIX_TEST_RAYS").ok().and_then(|n| n.parse().ok()).unwrap_or(200_000);
    let sphere = meshes::sphere(158, 316);
    // Moved by up to a million of its size, where rounding makes many triangles degenerate.
    let mut cases: Vec<(Model, Option<(Vec3, f32)>)> = Vec::new();
    for scale in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
        for moved in [0.0, 1.0, 1e3, 1e6] {
            let by = [0.61 * moved * scale, -0.35 * moved * scale, 0.71 * moved * scale];
            let centre = Vec3::from_array(by.map(|x| x as f32));
            cases.push((sphere.placed(scale, by), Some((centre, (0.2 * scale) as f32))));
        }
    }
    for model in meshes::real() {
        if model.is_closed() {
            cases.push((model, None));
        } else {
            println!("{} is not closed: left out", model.name);
        }
    }
    let each = total.div_ceil(cases.len());
    for device in devices::all("no_ray_leaves") {
        let (mut traced, mut left) = (0, 0);
        for (model, place) in &cases {
            let part =
                Part { positions: &model.positions, indices: Some(&model.indices), transform: Affine3A::IDENTITY };
            let tracer = Tracer::new(&device, &[part]).unwrap();
            let Some((centre, spread)) = place.or_else(|| inside(&tracer, model)) else {
                println!("{}: found no point inside", model.name);
                continue;
            };
            // Around points found by tracing only a little: the surface may be near.
            let spread = if place.is_some() { spread } else { spread * 0.05 };
            let mut rng = Pcg32::hashed(traced as u64, 11);
            let mut here = 0;
            for done in (0..each).step_by(1 << 20) {
                let rays = rays(model, centre, spread, (each - done).min(1 << 20), &mut rng);
                here += tracer.trace(&rays).unwrap().iter().filter(|hit| hit.instance == !0).count();
            }
            if here > 0 {
                println!("{}: {here} of {each} rays left", model.name);
            }
            (traced, left) = (traced + each, left + here);
        }
        println!("watertight on {}: {left} of {traced} rays left {} meshes", device.description(), cases.len());
        // OptiX promises watertightness of its own kind; its figure is recorded, ours must be zero.
        if device.kind() == optix_host::BackendKind::Cpu {
            assert_eq!(left, 0);
        }
    }
}
