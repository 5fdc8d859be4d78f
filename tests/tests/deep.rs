//! Traversal of deep structures leaves alone what programs keep.
//!
//! Triangles over many scales make structures of many levels. On a GPU without ray-tracing cores the driver's traversal has a
//! stack beside that of the programs, which is too small for them: without `stack::traversal_reserve` this test fails there.

use glam::{Affine3A, Quat, Vec3};
use optix_host::{Device, Pipeline, Result, Scene, TriangleMesh};
use optix_tests::devices;
use optix_tests::probe::{PTX, ProbeRay, ray};
use optix_tests::spawn::{Dice, Triangle};
use probe_shaders::deep::{Deep, DeepFrameHost, KEPT, Mist};

/// Triangles of sizes that are spread evenly over the exponents of two, as large as `wide` times their distance from the origin.
fn triangles(shape: Shape, exponents: [f32; 2], wide: f32, count: usize, dice: &mut Dice) -> Vec<Triangle> {
    let [low, high] = exponents;
    (0..count)
        .map(|_| {
            let size = dice.power(low, high);
            let middle = match shape {
                Shape::Around => dice.sphere(),
                Shape::Line => Vec3::X,
                Shape::Diagonal => Vec3::ONE,
            };
            [(); 3].map(|()| (middle + dice.cube() * wide) * size)
        })
        .collect()
}

/// Where triangles lie, seen from the origin.
#[derive(Clone, Copy, Debug)]
enum Shape {
    Around,
    Line,
    Diagonal,
}

/// Instances that are as far away as they are large, or nearly.
fn instances(exponents: [f32; 2], count: usize, dice: &mut Dice) -> Vec<Affine3A> {
    let [low, high] = exponents;
    (0..count)
        .map(|_| {
            let size = dice.power(low, high);
            let turn = Quat::from_axis_angle(dice.sphere(), dice.signed() * 3.0);
            Affine3A::from_scale_rotation_translation(Vec3::splat(size), turn, dice.sphere() * size)
        })
        .collect()
}

/// After how many of the rays something had changed, and how many triangles the rays passed.
fn changed(
    device: &Device,
    triangles: &[Triangle],
    levels: &[Vec<Affine3A>],
    rays: &[ProbeRay],
) -> Result<(usize, u64)> {
    let mut scene = Scene::<Deep>::new(device);
    let mist = scene.material(Mist {})?;
    let geometry = scene.geometry(TriangleMesh::new(triangles.as_flattened()))?;
    let mut accel = scene.gas([geometry.with(&mist)]).build()?;
    for level in levels {
        let instances: Vec<_> = level.iter().map(|&place| accel.at(place)).collect();
        accel = scene.ias(instances).build()?;
    }
    let world = accel.world()?;
    let pipeline = Pipeline::for_scene(&scene).ptx(PTX).build()?;
    let before: Vec<f32> = (0..rays.len() as u32 * KEPT).map(|i| i as f32).collect();
    let (kept, met) = (device.buffer(&before)?, device.zeroed(rays.len())?);
    let frame = DeepFrameHost { rays: device.buffer(rays)?, kept: kept.clone(), met: met.clone(), world };
    pipeline.launch(&frame, [rays.len() as u32, 1, 1])?.wait()?;
    let after = kept.read()?;
    let each = before.chunks(KEPT as usize).zip(after.chunks(KEPT as usize));
    let changed = each.filter(|(before, after)| before != after).count();
    Ok((changed, met.read()?.iter().copied().map(u64::from).sum()))
}

#[test]
fn what_a_program_keeps_is_left_alone() {
    for device in devices::all("what_a_program_keeps_is_left_alone") {
        println!("words kept across traces, on {}:", device.description());
        let mut dice = Dice::new(1);
        let mut check = |name: String, triangles: &[Triangle], levels: &[Vec<Affine3A>], rays: usize| {
            let rays: Vec<_> = (0..rays)
                .map(|i| {
                    let inside = |dice: &mut Dice| {
                        let [a, b, c] = dice.pick(triangles);
                        a * 0.3 + b * 0.3 + c * 0.4
                    };
                    let from = inside(&mut dice);
                    // Through the middle, or to any of them; to an end, or to none.
                    let to = if i % 2 == 0 { -from } else { inside(&mut dice) };
                    let way = ray(from - (to - from) * dice.unit(), to - from);
                    ProbeRay { tmax: if i % 4 < 2 { 64.0 } else { f32::MAX }, ..way }
                })
                .collect();
            let (changed, passed) = changed(&device, triangles, levels, &rays).unwrap();
            println!("  {name}: {changed} of {} changed, {passed} triangles passed", rays.len());
            assert!(passed > rays.len() as u64, "{name}");
            assert_eq!(changed, 0, "{name}");
        };
        let mut shapes = Dice::new(2);
        for half in [5.0, 20.0, 30.0, 60.0] {
            for (shape, wide) in [
                (Shape::Around, 1.0),
                (Shape::Around, 3.0),
                (Shape::Line, 1.0),
                (Shape::Line, 3.0),
                (Shape::Diagonal, 3.0),
            ] {
                for count in [300, 4_000, 20_000] {
                    let name = format!("{count} {shape:?}, {wide} wide, 2^-{half} to 2^{half}");
                    let triangles = triangles(shape, [-half, half], wide, count, &mut shapes);
                    check(name, &triangles, &[], if count > 4_000 { 128 } else { 512 });
                }
            }
        }
        for (depth, count) in [(1, 60), (2, 10), (3, 4)] {
            for half in [8.0, 20.0] {
                let levels: Vec<_> = (0..depth).map(|_| instances([-half, half], count, &mut shapes)).collect();
                let triangles = triangles(Shape::Line, [-28.0, 30.0], 1.0, 300, &mut shapes);
                check(format!("{depth} levels of {count} instances, 2^-{half} to 2^{half}"), &triangles, &levels, 64);
            }
        }
    }
}
