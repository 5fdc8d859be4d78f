//! Secondary rays don't meet the triangle they left, moved by the bound that `SurfacePoint` derives.

use glam::{Affine3A, Quat, Vec3};
use optix_tests::devices;
use optix_tests::meshes;
use optix_tests::probe::{Part, ProbeRay, Tracer, ray};
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
