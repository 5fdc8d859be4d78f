//! The CPU executor against OptiX: the same hits, the same picture, and nothing for validation mode to report.
//!
//! Without a driver the GPU's half does not run, and says so.

use glam::{Affine3A, DVec3, Vec2, Vec3};
use optix_device_rs::rng::Pcg32;
use optix_host::report::Moments;
use optix_host::{Device, OptixOptions};
use optix_tests::devices;
use optix_tests::probe::{Part, ProbeHit, ProbeRay, Tracer, ray};
use path_tracer::render::{LARGEST_PASS, Render, Settings};
use path_tracer::scene::{self, Cornell};
use path_tracer::shaders::Pinhole;

/// The triangles of the default scene. The mesh stands turned, so transforms count.
struct Triangles {
    parts: Vec<Placed>,
}

/// Positions and indices in object space, and where they are placed.
type Placed = (Vec<Vec3>, Option<Vec<[u32; 3]>>, Affine3A);

impl Triangles {
    fn of_default_scene() -> Self {
        let mesh = scene::knot();
        let positions: Vec<Vec3> = mesh.positions.iter().map(|&p| p.into()).collect();
        let turned = Affine3A::from_rotation_y(0.3) * Affine3A::from_scale(Vec3::new(1.05, 0.9, 1.1));
        let (corner, side, other) = scene::leaf();
        let here = Affine3A::IDENTITY;
        let light = scene::light();
        let lamp = scene::parallelogram(light.corner, light.side, light.other);
        Self {
            parts: vec![
                (scene::walls().concat(), None, here),
                (lamp.to_vec(), None, here),
                (positions, Some(mesh.indices), turned),
                (scene::parallelogram(corner, side, other).to_vec(), None, here),
            ],
        }
    }

    fn tracer(&self, device: &Device) -> Tracer {
        let parts: Vec<_> = self
            .parts
            .iter()
            .map(|(positions, indices, transform)| Part {
                positions,
                indices: indices.as_deref(),
                transform: *transform,
            })
            .collect();
        Tracer::new(device, &parts).unwrap()
    }

    /// The triangle of a hit, in world space.
    fn triangle(&self, hit: &ProbeHit) -> [DVec3; 3] {
        let (positions, indices, transform) = &self.parts[hit.instance as usize];
        let first = hit.primitive * 3;
        let corners = indices.as_ref().map_or([first, first + 1, first + 2], |i| i[hit.primitive as usize]);
        let matrix = transform.matrix3.as_dmat3();
        corners.map(|i| matrix * positions[i as usize].as_dvec3() + transform.translation.as_dvec3())
    }
}

/// Rays through the pixels of a picture: at a random point of each, as the renderer's are, or through the middle.
fn camera_rays(width: u32, height: u32, jitter: bool) -> Vec<ProbeRay> {
    let camera = Pinhole::look_at(Vec3::new(0.0, 0.0, 3.9), Vec3::ZERO, Vec3::Y, 0.69, width as f32 / height as f32);
    let pixel = |i: u32| {
        let within = if jitter { Pcg32::hashed(u64::from(i) << 32, 0).next_vec2() } else { Vec2::splat(0.5) };
        let at = Vec2::new((i % width) as f32, (i / width) as f32) + within;
        let r = camera.ray(at / Vec2::new(width as f32, height as f32));
        ray(r.origin, r.direction)
    };
    (0..width * height).map(pixel).collect()
}

/// The least distance of a ray's line from the edges of a triangle.
fn distance_to_edges(ray: &ProbeRay, triangle: [DVec3; 3]) -> f64 {
    let (o, d) = (Vec3::from_array(ray.origin).as_dvec3(), Vec3::from_array(ray.direction).as_dvec3().normalize());
    let to_segment = |a: DVec3, b: DVec3| {
        // Seen along the ray both are in a plane; there it is the distance of the origin from a segment.
        let flat = |p: DVec3| (p - o) - d * (p - o).dot(d);
        let (a, b) = (flat(a), flat(b));
        let along = (b - a).length_squared();
        let t = if along > 0.0 { (-a.dot(b - a) / along).clamp(0.0, 1.0) } else { 0.0 };
        (a + (b - a) * t).length()
    };
    let [a, b, c] = triangle;
    to_segment(a, b).min(to_segment(b, c)).min(to_segment(c, a))
}

/// The share of rays that meet different triangles on the two machines, each of which must be a ray through an edge.
fn disagreement(optix: &Device, what: &str, rays: &[ProbeRay]) -> f64 {
    let triangles = Triangles::of_default_scene();
    let on_cpu = triangles.tracer(&Device::cpu().unwrap()).trace(rays).unwrap();
    let on_gpu = triangles.tracer(optix).trace(rays).unwrap();
    let (mut disagree, mut worst, mut t_ulps) = (0, 0.0f64, 0);
    for ((ray, cpu), gpu) in rays.iter().zip(&on_cpu).zip(&on_gpu) {
        if (cpu.instance, cpu.primitive) == (gpu.instance, gpu.primitive) {
            t_ulps = t_ulps.max(cpu.t.to_bits().abs_diff(gpu.t.to_bits()));
            continue;
        }
        disagree += 1;
        let met = [cpu, gpu].into_iter().filter(|hit| hit.instance != !0);
        let nearest = met.clone().map(|hit| distance_to_edges(ray, triangles.triangle(hit))).fold(f64::MAX, f64::min);
        // An ulp of the largest coordinate that enters the test: the distance from the camera.
        let reach = met.map(|hit| hit.t.abs()).fold(0.0, f32::max);
        let ulp = f64::from(f32::EPSILON) * f64::from(reach);
        worst = worst.max(nearest / ulp);
    }
    let pixels = rays.len();
    println!(
        "primary hits {what}: {disagree} of {pixels} pixels disagree, at most {worst:.3} ulp from an edge; \
         t differs by at most {t_ulps} ulp elsewhere"
    );
    assert!(worst <= 2.0, "a disagreement is {worst} ulp from an edge");
    f64::from(disagree) / pixels as f64
}

#[test]
fn primary_hits_agree() {
    let Some(optix) = devices::optix("primary_hits_agree") else { return };
    let share = disagreement(&optix, "of a picture", &camera_rays(1024, 1024, true));
    assert!(share <= 1e-4, "{share} of the pixels disagree");
    // Through pixel centres a symmetric camera aims rays exactly along the walls' diagonals, where either triangle is
    // right: how many disagree says nothing, but all must be on an edge.
    disagreement(&optix, "through pixel centres", &camera_rays(1024, 1024, false));
}

fn render(device: &Device, samples: u64, seed: u64, size: u32) -> Moments {
    let cornell = Cornell::new(device, &scene::knot(), 1.0).unwrap();
    let mut render = Render::new(device, &cornell, Settings { size: [size, size], bounces: 8, seed }).unwrap();
    for _ in 0..samples / u64::from(LARGEST_PASS) {
        render.pass(LARGEST_PASS).unwrap();
    }
    render.moments().clone()
}

#[test]
fn pictures_agree() {
    let Some(optix) = devices::optix("pictures_agree") else { return };
    let size = 128;
    let cpu = render(&Device::cpu().unwrap(), 1024, 1, size);
    let gpu = render(&optix, 1024, 2, size);
    let mut worst = 0.0f64;
    for tile in 0..(size / 16) * (size / 16) {
        let (left, top) = (tile % (size / 16) * 16, tile / (size / 16) * 16);
        let pixels = || (0..256).map(|i| ((top + i / 16) * size + left + i % 16) as usize);
        let (a, b) = (cpu.estimate_over(pixels()), gpu.estimate_over(pixels()));
        let error = a.mean_error.unwrap().hypot(b.mean_error.unwrap());
        if error > 0.0 {
            worst = worst.max((a.mean_radiance - b.mean_radiance).abs() / error);
        } else {
            assert_eq!(a.mean_radiance, b.mean_radiance);
        }
    }
    println!("pictures: the worst of {} tiles differs by {worst:.2} standard errors", (size / 16) * (size / 16));
    assert!(worst < 5.0, "a tile differs by {worst} standard errors");
}

/// The driver says which loads of a bound parameter became constants, or that it had the module in its cache.
#[test]
fn loads_of_bound_parameters_are_reported() {
    let Some(optix) = devices::optix("loads_of_bound_parameters_are_reported") else { return };
    let cornell = Cornell::new(&optix, &scene::knot(), 1.0).unwrap();
    // A number of bounces that no other test binds: the module is not in the cache the first time.
    let settings = Settings { size: [16, 16], bounces: 37, seed: 1 };
    let explanation = Render::new(&optix, &cornell, settings).unwrap().explain();
    let said = explanation.device.iter().find(|line| line.starts_with("bound value max_bounces:"));
    let said = said.expect("no line about the bound value");
    println!("{said}");
    assert!(!said.contains("found no load"), "{explanation}");
}

#[test]
fn validation_mode_reports_nothing() {
    let Some(optix) = devices::optix_with("validation_mode_reports_nothing", &OptixOptions { validation: true }) else {
        return;
    };
    let moments = render(&optix, 64, 1, 64);
    assert!(moments.estimate().mean_radiance > 0.0);
    let triangles = Triangles::of_default_scene();
    let tracer = triangles.tracer(&optix);
    tracer.trace(&camera_rays(64, 64, true)).unwrap();
    tracer.respawn(&camera_rays(64, 64, true), 4, 1.0).unwrap();
    assert_eq!(optix.take_messages(), Vec::<String>::new());
}

#[test]
fn pictures_do_not_depend_on_the_number_of_threads() {
    let picture = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| render(&Device::cpu().unwrap(), 64, 7, 24)).mean_image()
    };
    let one = picture(1);
    assert!(one.iter().flatten().any(|&x| x > 0.0));
    for threads in [2, 3, 5] {
        assert!(picture(threads) == one, "{threads} threads give another picture");
    }
}
