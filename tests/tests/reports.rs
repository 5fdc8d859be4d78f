//! What becomes of payload fields that an intersection program and the any-hit program of its reports both write, and the time
//! of rays in a pipeline without motion: on every machine there is.

use glam::Vec3;
use optix_host::{Aabb, CustomPrimitives, Device, Pipeline, Scene};
use optix_tests::{devices, probe::PTX};
use probe_shaders::reports::{ADDED, BEGIN, Cell, ReportFrameHost, Reports};

/// What a launch wrote.
struct Written {
    counts: Vec<[u32; 2]>,
    found: Vec<[u32; 2]>,
    times: Vec<[f32; 4]>,
}

fn run(device: &Device, time: f32) -> Written {
    let mut scene = Scene::<Reports>::new(device);
    let cell = scene.material(Cell {}).unwrap();
    let unit = scene.geometry(CustomPrimitives::new(&[Aabb { min: Vec3::NEG_ONE, max: Vec3::ONE }])).unwrap();
    let world = scene.gas([unit.with(&cell)]).build().unwrap().world().unwrap();
    let pipeline = Pipeline::for_scene(&scene).ptx(PTX).build().unwrap();
    let (counts, found) = (device.zeroed(4).unwrap(), device.zeroed(8).unwrap());
    let times = device.buffer(&[[-1.0; 4]; 4]).unwrap();
    let frame = ReportFrameHost { counts: counts.clone(), found: found.clone(), times: times.clone(), world, time };
    pipeline.launch(&frame, [4, 1, 1]).unwrap().wait().unwrap();
    Written { counts: counts.read().unwrap(), found: found.read().unwrap(), times: times.read().unwrap() }
}

#[test]
fn what_an_intersection_program_returns_is_stored_after_its_reports() {
    for device in devices::all("reports") {
        let Written { counts, found, .. } = run(&device, 0.0);
        // Each report's any-hit program goes on from what the last one left, whether its hit counts or not; the intersection
        // program goes on from what it was given when it began, and its result is stored over theirs.
        assert_eq!(counts, [[BEGIN + ADDED, BEGIN + 2]; 4], "{}", device.description());
        assert_eq!(found, [[BEGIN; 2], [BEGIN + 1; 2]].repeat(4), "{}", device.description());
    }
}

#[test]
fn rays_have_no_time_where_nothing_moves() {
    for device in devices::all("ray times") {
        for time in [0.0, 0.25, -3.0, f32::MAX] {
            let Written { times, .. } = run(&device, time);
            let [hit, missed] = [[0.0, 0.0, 0.0, -1.0], [0.0, 0.0, -1.0, 0.0]];
            assert_eq!(times, [hit, missed, hit, missed], "{time} on {}", device.description());
        }
    }
}
