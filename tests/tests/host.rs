//! What the host refuses, and how it says so; and that launches see the records and parameters they were given.

use glam::{Affine3A, Vec3};
use optix_host::scene::{Accel, GeometryError, InstanceFlags};
use optix_host::{Aabb, BackendKind, CustomPrimitives, Device, Error, Pipeline, Scene, TriangleMesh};
use optix_tests::devices;
use optix_tests::probe::{PTX, Part, ProbeRay, Tracer, ray};
use path_tracer::shaders::{AreaLight, Lambert, PathTracer};
use probe_shaders::{Probe, ProbeFrameHost, Surface};

const TRIANGLE: [Vec3; 3] = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];

fn scene(device: &Device) -> Scene<Probe> {
    Scene::new(device)
}

/// The error's text, which is to be one that names what is wrong.
fn says<T>(result: Result<T, Error>, words: &[&str]) {
    let text = result.err().expect("it was accepted").to_string();
    for word in words {
        assert!(text.contains(word), "`{word}` is not in: {text}");
    }
}

#[test]
fn bad_geometry_is_named() {
    let device = Device::cpu().unwrap();
    let mut scene = scene(&device);
    says(scene.geometry(TriangleMesh::new(&[])), &["triangle mesh", "no primitives"]);
    says(scene.geometry(TriangleMesh::new(&TRIANGLE[..2])), &["2 positions"]);
    let out = scene.geometry(TriangleMesh::new(&TRIANGLE).indices(&[[0, 1, 2], [0, 3, 1]]));
    assert!(matches!(out, Err(Error::Geometry(GeometryError::IndexOutOfRange { triangle: 1, index: 3, vertices: 3 }))));
    let mut broken = TRIANGLE;
    broken[1].y = f32::NAN;
    says(scene.geometry(TriangleMesh::new(&broken)), &["vertex 1", "NaN"]);
    let inverted = Aabb { min: Vec3::ONE, max: Vec3::ZERO };
    says(scene.geometry(CustomPrimitives::new(&[inverted])), &["box 0", "min <= max"]);
    says(scene.gas::<optix_device_rs::primitive::Triangles>([]).build(), &["at least one geometry"]);
    let (paint, triangle) =
        (scene.material(Surface {}).unwrap(), scene.geometry(TriangleMesh::new(&TRIANGLE)).unwrap());
    let [good, long, high] = [vec![0], vec![0, 0], vec![1]].map(|which| triangle.with_each(&[paint], which));
    says(scene.gas([good, long]).build(), &["geometry 1", "1 primitives", "2 material numbers"]);
    says(scene.gas([high]).build(), &["geometry 0", "primitive 0", "material number 1", "1 materials"]);
    says(scene.ias([]).build(), &["at least one instance"]);
}

#[test]
fn scenes_and_devices_do_not_mix() {
    let (device, other) = (Device::cpu().unwrap(), Device::cpu().unwrap());
    let (mut a, mut b) = (scene(&device), scene(&device));
    let paint = a.material(Surface {}).unwrap();
    let geometry = a.geometry(TriangleMesh::new(&TRIANGLE)).unwrap();
    says(b.gas([geometry.with(&paint)]).build(), &["another scene"]);
    let gas = a.gas([geometry.with(&paint)]).build().unwrap();
    says(b.ias([gas.at(Affine3A::IDENTITY)]).build(), &["another scene"]);
    says(a.ias([gas.at(Affine3A::from_scale(Vec3::ZERO))]).build(), &["can't be inverted", "left out"]);
    says(a.ias([gas.at(Affine3A::from_scale(Vec3::NAN))]).build(), &["not finite"]);
    let both = InstanceFlags::DISABLE_ANYHIT | InstanceFlags::ENFORCE_ANYHIT;
    for more in [InstanceFlags::NONE, InstanceFlags::FLIP_TRIANGLE_FACING] {
        let flags = [gas.at(Affine3A::IDENTITY), gas.at(Affine3A::IDENTITY).flags(both | more)];
        says(a.ias(flags).build(), &["instance 1", "DISABLE_ANYHIT and ENFORCE_ANYHIT", "leave one out"]);
    }
    says(a.ias([gas.at(Affine3A::IDENTITY).id(1 << 28)]).build(), &["28 bits"]);

    let pipeline = Pipeline::for_scene(&a).ptx(PTX).build().unwrap();
    let frame = |device: &Device, world| ProbeFrameHost {
        rays: device.buffer(&[ray(Vec3::Z, Vec3::NEG_Z)]).unwrap(),
        hits: device.zeroed(1).unwrap(),
        tallies: device.zeroed(0).unwrap(),
        world,
        secondary: 0,
        offset: 1.0,
    };
    let world = gas.world().unwrap();
    says(pipeline.launch(&frame(&other, world.clone()), [1, 1, 1]), &["another device"]);
    says(pipeline.launch(&frame(&device, world.clone()), [0, 1, 1]), &["empty"]);
    says(pipeline.launch(&frame(&device, world.clone()), [1 << 20, 1 << 11, 1]), &["2^30"]);
    // Products that are 0, 1 or small in 32 or 64 bits.
    for dimensions in [
        [1 << 31, 2, 1],
        [1 << 22, 1_632_737, 2_693_665],
        [1 << 31, 1 << 31, 4],
        [u32::MAX; 3],
        [1 << 16, 1 << 16, 1 << 31],
    ] {
        says(pipeline.launch(&frame(&device, world.clone()), dimensions), &["2^30"]);
    }
    pipeline.launch(&frame(&device, world), [1, 1, 1]).unwrap().wait().unwrap();
    // A graph that the pipeline was not specialised to.
    let deeper = a.ias([gas.at(Affine3A::IDENTITY)]).build().unwrap().world().unwrap();
    says(pipeline.launch(&frame(&device, deeper), [1, 1, 1]), &["specialised", "a single GAS"]);
}

/// A pipeline traces what it was specialised to: one level of instances is neither less nor more, deeper graphs are what the
/// scene had.
#[test]
fn graphs_that_a_pipeline_traces() {
    let device = Device::cpu().unwrap();
    let mut scene = scene(&device);
    let paint = scene.material(Surface {}).unwrap();
    let geometry = scene.geometry(TriangleMesh::new(&TRIANGLE)).unwrap();
    let gas = scene.gas([geometry.with(&paint)]).build().unwrap();
    let nested = |scene: &mut Scene<Probe>, of: &Accel<Probe>| scene.ias([of.at(Affine3A::IDENTITY)]).build().unwrap();
    let launch = |pipeline: &Pipeline<Probe>, graph: &Accel<Probe>| {
        let frame = ProbeFrameHost {
            rays: device.buffer(&[ray(Vec3::Z, Vec3::NEG_Z)]).unwrap(),
            hits: device.zeroed(1).unwrap(),
            tallies: device.zeroed(0).unwrap(),
            world: graph.world().unwrap(),
            secondary: 0,
            offset: 1.0,
        };
        pipeline.launch(&frame, [1, 1, 1]).and_then(|launch| launch.wait())
    };
    let one = nested(&mut scene, &gas);
    let pipeline = Pipeline::for_scene(&scene).ptx(PTX).build().unwrap();
    launch(&pipeline, &one).unwrap();
    says(launch(&pipeline, &gas), &["a GAS", "put the GAS into one"]);
    // Its `world()` was taken, so this one traces either.
    let either = Pipeline::for_scene(&scene).ptx(PTX).build().unwrap();
    launch(&either, &one).unwrap();
    launch(&either, &gas).unwrap();
    let two = nested(&mut scene, &one);
    says(launch(&pipeline, &two), &["2 levels", "one level of instances"]);
    says(launch(&either, &two), &["2 levels", "any graph", "(1)"]);
    let graphs = [gas, one, two.clone(), nested(&mut scene, &two)];
    for pipeline in
        [Pipeline::for_scene(&scene).ptx(PTX).build().unwrap(), Pipeline::for_scene(&scene).build().unwrap()]
    {
        for graph in &graphs {
            launch(&pipeline, graph).unwrap();
        }
        says(launch(&pipeline, &nested(&mut scene, &graphs[3])), &["4 levels", "any graph", "(3)"]);
    }
}

#[test]
fn an_index_out_of_range_ends_the_launch_with_its_index() {
    let device = Device::cpu().unwrap();
    let mut scene = scene(&device);
    let paint = scene.material(Surface {}).unwrap();
    let geometry = scene.geometry(TriangleMesh::new(&TRIANGLE)).unwrap();
    let gas = scene.gas([geometry.with(&paint)]).build().unwrap();
    let pipeline = Pipeline::for_scene(&scene).build().unwrap();
    let frame = ProbeFrameHost {
        rays: device.buffer(&[ray(Vec3::Z, Vec3::NEG_Z); 3]).unwrap(),
        hits: device.zeroed(3).unwrap(),
        tallies: device.zeroed(0).unwrap(),
        world: gas.world().unwrap(),
        secondary: 0,
        offset: 1.0,
    };
    let launch = pipeline.launch(&frame, [4, 1, 1]).and_then(|launch| launch.wait());
    let wanted = ["__raygen__", "[3, 0, 0]", "index 3 is out of range", "3 elements, at ", "shaders/src/lib.rs:"];
    says(launch, &[&wanted[..], &["(launch parameter `rays`)"]].concat());
}

#[test]
fn a_bound_parameter_that_differs_is_refused() {
    let device = Device::cpu().unwrap();
    let mut scene = Scene::<PathTracer>::new(&device);
    let white = scene.material(Lambert { albedo: Vec3::ONE }).unwrap();
    let geometry = scene.geometry(TriangleMesh::new(&TRIANGLE)).unwrap();
    let gas = scene.gas([geometry.with(&white)]).build().unwrap();
    let pipeline = Pipeline::for_scene(&scene).bind(path_tracer::shaders::Frame::MAX_BOUNCES, 3).build().unwrap();
    let film = || device.zeroed_2d([4, 4]).unwrap();
    let camera = path_tracer::shaders::Pinhole::look_at(Vec3::Z * 3.0, Vec3::ZERO, Vec3::Y, 0.7, 1.0);
    let light = AreaLight::new(Vec3::Z, Vec3::X, Vec3::Y, Vec3::ONE);
    let mut frame = path_tracer::shaders::FrameHost {
        sum: film(),
        squares: film(),
        world: gas.world().unwrap(),
        camera,
        light,
        first_sample: 0,
        samples: 1,
        seed: 0,
        max_bounces: 4,
    };
    says(pipeline.launch(&frame, [4, 4, 1]), &["max_bounces", "= 4", "= 3"]);
    frame.max_bounces = 3;
    pipeline.launch(&frame, [4, 4, 1]).unwrap().wait().unwrap();
    let explained = pipeline.explain().to_string();
    for word in ["a single GAS", "1 of 5", "Ball", "max_bounces: the CPU loads it", "disabled on Lambert"] {
        assert!(explained.contains(word), "`{word}` is not in:\n{explained}");
    }
}

/// Two levels of instances: ids, masks and flips, on every machine.
#[test]
fn instances_over_two_levels() {
    for device in devices::all("instances_over_two_levels") {
        let mut scene = scene(&device);
        let paint = scene.material(Surface {}).unwrap();
        let geometry = scene.geometry(TriangleMesh::new(&TRIANGLE)).unwrap();
        let gas = scene.gas([geometry.with(&paint)]).compact().build().unwrap();
        let left = Affine3A::from_translation(Vec3::new(-4.0, 0.0, 0.0));
        let right = Affine3A::from_translation(Vec3::new(4.0, 0.0, 0.0));
        let pair = scene.ias([gas.at(left).id(7), gas.at(right).id(8).flags(InstanceFlags::FLIP_TRIANGLE_FACING)]);
        let pair = pair.build().unwrap();
        let up = Affine3A::from_translation(Vec3::new(0.0, 10.0, 0.0));
        let both = scene.ias([pair.at(Affine3A::IDENTITY).id(1), pair.at(up).id(2).mask(2)]).build().unwrap();
        let pipeline = Pipeline::for_scene(&scene).ptx(PTX).build().unwrap();
        let towards = |x: f32, y: f32| ray(Vec3::new(x, y, 5.0), Vec3::NEG_Z);
        let rays = [towards(-4.0, 0.0), towards(4.0, 0.0), towards(4.0, 10.0), towards(0.0, 0.0)];
        let hits = device.zeroed(rays.len()).unwrap();
        let frame = ProbeFrameHost {
            rays: device.buffer(&rays).unwrap(),
            hits: hits.clone(),
            tallies: device.zeroed(0).unwrap(),
            world: both.world().unwrap(),
            secondary: 0,
            offset: 1.0,
        };
        pipeline.launch(&frame, [rays.len() as u32, 1, 1]).unwrap().wait().unwrap();
        let hits = hits.read().unwrap();
        let seen: Vec<_> = hits.iter().map(|hit| (hit.instance, hit.kind, hit.t)).collect();
        let expected = [(7, 254, 5.0), (8, 255, 5.0), (8, 255, 5.0), (!0, 0, 0.0)];
        assert_eq!(seen, expected, "{}", device.description());
    }
}

/// A launch over no structure only runs the miss program; a ray that starts behind `tmax` misses.
#[test]
fn intervals_are_closed() {
    for device in devices::all("intervals_are_closed") {
        let part = Part { positions: &TRIANGLE, indices: None, transform: Affine3A::IDENTITY };
        let tracer = Tracer::new(&device, &[part]).unwrap();
        let at = |tmin, tmax| ProbeRay { tmin, tmax, ..ray(Vec3::Z * 2.0, Vec3::NEG_Z) };
        let rays = [at(0.0, 10.0), at(0.0, 1.9), at(2.1, 10.0), at(1.9, 2.1)];
        let met: Vec<_> = tracer.trace(&rays).unwrap().iter().map(|hit| hit.instance == 0).collect();
        assert_eq!(met, [true, false, false, true], "{}", device.description());
    }
}

/// An instance whose scale goes to 0, as in an animation, is met as long as there are numbers for it, on every machine.
#[test]
fn instances_shrink_as_far_as_numbers_go() {
    for device in devices::all("tiny instances") {
        let mut scene = scene(&device);
        let paint = scene.material(Surface {}).unwrap();
        let geometry = scene.geometry(TriangleMesh::new(&TRIANGLE)).unwrap();
        let gas = scene.gas([geometry.with(&paint)]).build().unwrap();
        let mut worlds = Vec::new();
        for e in 0..38 {
            let x: f32 = format!("1e-{e}").parse().unwrap();
            for scale in [Vec3::splat(x), Vec3::new(x, x, 1.0), Vec3::new(x, 1.0, 1.0)] {
                worlds
                    .push((scale, scene.ias([gas.at(Affine3A::from_scale(scale))]).build().unwrap().world().unwrap()));
            }
        }
        let pipeline = Pipeline::for_scene(&scene).ptx(PTX).build().unwrap();
        for (scale, world) in worlds {
            let hits = device.zeroed(1).unwrap();
            let frame = ProbeFrameHost {
                rays: device.buffer(&[ray(Vec3::Z, Vec3::NEG_Z)]).unwrap(),
                hits: hits.clone(),
                tallies: device.zeroed(0).unwrap(),
                world,
                secondary: 0,
                offset: 1.0,
            };
            pipeline.launch(&frame, [1, 1, 1]).unwrap().wait().unwrap();
            // What OptiX does with object space beyond 2^64 is its own.
            if device.kind() == BackendKind::Cpu || scale.min_element() > 1e-15 {
                assert_eq!(
                    (hits.read().unwrap()[0].instance, hits.read().unwrap()[0].t),
                    (0, 1.0),
                    "{scale} on {}",
                    device.description()
                );
            }
        }
    }
}
