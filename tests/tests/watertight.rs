//! No ray leaves a closed mesh: rays from inside, a third of them aimed at edges and vertices.
//!
//! `OPTIX_TEST_RAYS=10000000` sets how many rays there are in all; the default is small enough for every run.

use glam::{Affine3A, Vec3};
use optix_device_rs::rng::Pcg32;
use optix_tests::devices;
use optix_tests::meshes::{self, Model};
use optix_tests::probe::{Part, ProbeRay, Tracer, ray};

/// Rays from points inside: in all directions, at points of edges, at vertices.
fn rays(model: &Model, inside: &[Vec3], count: usize, rng: &mut Pcg32) -> Vec<ProbeRay> {
    let mut rays = Vec::with_capacity(count);
    while rays.len() < count {
        let from = inside[rng.next_u32() as usize % inside.len()];
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

/// Points around the centre of a sphere, well inside.
fn inside_sphere(centre: Vec3, radius: f32) -> Vec<Vec3> {
    let mut rng = Pcg32::hashed(5, 6);
    let mut point = || centre + Vec3::from_array(core::array::from_fn(|_| 0.4 * rng.next_f32() - 0.2)) * radius;
    (0..256).map(|_| point()).collect()
}

/// Points inside any closed mesh: half way between where a line enters and where it next leaves, by tracing it.
fn inside_mesh(tracer: &Tracer, model: &Model) -> Vec<Vec3> {
    let (lo, hi) = model.positions.iter().fold((Vec3::MAX, Vec3::MIN), |(lo, hi), &p| (lo.min(p), hi.max(p)));
    let size = (hi - lo).length();
    let mut rng = Pcg32::hashed(9, 9);
    let mut points = Vec::new();
    for _ in 0..512 {
        let at: [f32; 3] = core::array::from_fn(|_| 0.1 + 0.8 * rng.next_f32());
        let target = lo + (hi - lo) * Vec3::from_array(at);
        let from = target + Vec3::new(0.31, 0.53, 0.79) * size;
        let along = target - from;
        let enter = tracer.trace(&[ray(from, along)]).unwrap()[0];
        if enter.instance == !0 || enter.kind != 254 {
            continue;
        }
        let beyond = ProbeRay { tmin: enter.t * (1.0 + 1e-5), ..ray(from, along) };
        let leave = tracer.trace(&[beyond]).unwrap()[0];
        let depth = (leave.t - enter.t) * along.length();
        if leave.instance != !0 && leave.kind == 255 && depth > 0.02 * size {
            points.push(from + along * (0.5 * (enter.t + leave.t)));
        }
    }
    points
}

#[test]
fn no_ray_leaves() {
    let total: usize = std::env::var("OPTIX_TEST_RAYS").ok().and_then(|n| n.parse().ok()).unwrap_or(200_000);
    let sphere = meshes::sphere(158, 316);
    // Moved by up to a million of its size, where rounding makes many triangles degenerate.
    let mut cases: Vec<(Model, Option<Vec<Vec3>>)> = Vec::new();
    for scale in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
        for moved in [0.0, 1.0, 1e3, 1e6] {
            let by = [0.61 * moved * scale, -0.35 * moved * scale, 0.71 * moved * scale];
            let centre = Vec3::from_array(by.map(|x| x as f32));
            cases.push((sphere.placed(scale, by), Some(inside_sphere(centre, scale as f32))));
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
            let inside = place.clone().unwrap_or_else(|| inside_mesh(&tracer, model));
            assert!(!inside.is_empty(), "{}: found no point inside", model.name);
            let mut rng = Pcg32::hashed(traced as u64, 11);
            let mut here = 0;
            for done in (0..each).step_by(1 << 20) {
                let rays = rays(model, &inside, (each - done).min(1 << 20), &mut rng);
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
