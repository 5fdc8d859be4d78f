//! Tables of callables and exceptions of every kind of program: the same on the CPU and on OptiX.

use glam::{Affine3A, UVec2, Vec3};
use optix_device_rs::host::{CallableRecord, CallableTable};
use optix_device_rs::prelude::{Continuation, Direct};
use optix_host::{Aabb, BackendKind, Buffer, CustomPrimitives, Device, Error, Pipeline, Scene, TriangleMesh, World};
use optix_tests::devices;
use optix_tests::probe::PTX;
use probe_shaders::callables::{
    ANYHIT, CLOSESTHIT, CONTINUATION, CallFrameHost, Calls, DIRECT, FloorHost, INTERSECTION, MISS, Mirror, NOBODY,
    RAYGEN, RoundHost, Scale, Shader, SumHost, Texture, Unheard, UnheardFrameHost, flat, mirror, scale, sum,
};

const INDICES: u32 = 30;
/// Factors of the two `scale` records. All numbers here are exact in `f32`, whatever is fused.
const BY: [Vec3; 2] = [Vec3::new(2.0, 3.0, 0.5), Vec3::new(-1.0, 0.25, 4.0)];
const MIRROR: Mirror = Mirror { origin: Vec3::new(0.0, 0.0, 4.0), share: 0.5 };
/// No exception.
const NONE: [u32; 9] = [!0; 9];

struct Machine {
    device: Device,
    scene: Scene<Calls>,
    pipeline: Pipeline<Calls>,
    world: World,
    textures: CallableTable<Texture, Direct>,
    shaders: CallableTable<Shader, Continuation>,
}

fn scaled(scene: &mut Scene<Calls>, by: Vec3) -> CallableRecord<Texture, Direct> {
    scene.callable::<scale>(Scale { by }).unwrap()
}

impl Machine {
    fn new(device: &Device) -> Self {
        let mut scene = Scene::<Calls>::new(device);
        let [a, b] = BY.map(|by| scaled(&mut scene, by));
        let both = scene.callable::<sum>(SumHost { of: [a.clone(), b.clone()] }).unwrap();
        // A sum in a sum: three levels.
        let more = scene.callable::<sum>(SumHost { of: [both.clone(), a.clone()] }).unwrap();
        let textures = scene.callables(&[a, b.clone(), both, more.clone()]).unwrap();
        let reflect = scene.callable::<mirror>(MIRROR).unwrap();
        let plain = scene.callable::<flat>(()).unwrap();
        let shaders = scene.callables(&[reflect, plain]).unwrap();

        let floor = scene.material(FloorHost { shader: 0, texture: more }).unwrap();
        let corners = [Vec3::new(-2.0, -2.0, 0.0), Vec3::new(2.0, -2.0, 0.0), Vec3::new(0.0, 2.0, 0.0)];
        let triangle = scene.geometry(TriangleMesh::new(&corners)).unwrap();
        let floor = scene.gas([triangle.with(&floor)]).build().unwrap();
        let round = scene.material(RoundHost { texture: b }).unwrap();
        let at = Vec3::new(8.0, 0.0, 0.0);
        let boxes = scene.geometry(CustomPrimitives::new(&[Aabb { min: at - 1.0, max: at + 1.0 }])).unwrap();
        let ball = scene.gas([boxes.with(&round)]).build().unwrap();
        let here = Affine3A::IDENTITY;
        let world = scene.ias([floor.at(here), ball.at(here)]).build().unwrap().world().unwrap();
        let pipeline = Pipeline::for_scene(&scene).ptx(PTX).build().unwrap();
        Self { device: device.clone(), scene, pipeline, world, textures, shaders }
    }

    fn frame(&self, bounces: u32, thrower: u32) -> (CallFrameHost, Buffer<[f32; 4]>, Buffer<[u32; 9]>) {
        let found = self.device.zeroed(INDICES as usize).unwrap();
        let thrown = self.device.buffer(&[NONE; INDICES as usize]).unwrap();
        let frame = CallFrameHost {
            found: found.clone(),
            thrown: thrown.clone(),
            textures: self.textures.clone(),
            shaders: self.shaders.clone(),
            world: self.world.clone(),
            bounces,
            thrower,
        };
        (frame, found, thrown)
    }

    /// What was found, and what was thrown.
    fn launch(&self, bounces: u32, thrower: u32) -> (Vec<[f32; 4]>, Vec<[u32; 9]>) {
        let (frame, found, thrown) = self.frame(bounces, thrower);
        self.pipeline.launch(&frame, [INDICES, 1, 1]).unwrap().wait().unwrap();
        (found.read().unwrap(), thrown.read().unwrap())
    }
}

/// Texture number `which` of the table.
fn texture(which: u32, index: u32, x: f32, at: UVec2) -> Vec3 {
    let on = |which, x| texture(which, index, x, at);
    match which {
        0 | 1 => BY[which as usize] * x + at.as_vec2().extend(index as f32),
        2 => on(0, x) + on(1, x + 1.0),
        _ => on(2, x) + on(0, x + 1.0),
    }
}

/// Shader number `which` of the table.
fn shader(which: u32, index: u32, towards: Vec3, left: u32) -> f32 {
    if which == 1 {
        return towards.y + left as f32;
    }
    let seen = match index % 3 {
        0 => texture(1, index, 2.0, UVec2::ZERO).x,
        1 => {
            let colour = texture(3, index, 1.0, UVec2::splat(left));
            if left == 0 { colour.y } else { shader(0, index, colour, left - 1) }
        }
        _ => texture(0, index, 5.0, UVec2::ZERO).z,
    };
    MIRROR.share * seen + towards.x * 0.125
}

fn expected(index: u32, bounces: u32) -> [f32; 4] {
    let colour = texture(index % 4, index, index as f32, UVec2::new(index, 0));
    colour.extend(shader(index % 2, index, colour, bounces)).to_array()
}

/// What the exception program notes of a fault.
fn note(thrower: u32, index: u32) -> [u32; 9] {
    match index % 3 {
        0 => [1, 0, 0, 0, 0, 0, 0, 0, 0],
        1 => [3, (thrower as f32).to_bits(), (index as f32).to_bits(), 0, 0, 0, 0, 0, 0],
        _ => {
            let double = (-1.0 / f64::from(index)).to_bits();
            let single = (0.5 + index as f32).to_bits();
            [2, thrower, index, 0, 0, single, double as u32, (double >> 32) as u32, index & 1]
        }
    }
}

#[track_caller]
fn close(found: [f32; 4], expected: [f32; 4], what: &str) {
    for (a, b) in found.into_iter().zip(expected) {
        assert!((a - b).abs() <= 1e-5 * b.abs().max(1.0), "{what}: {found:?} in place of {expected:?}");
    }
}

#[test]
fn tables_of_callables() {
    for device in devices::all("tables_of_callables") {
        let machine = Machine::new(&device);
        for bounces in 0..4 {
            let (found, thrown) = machine.launch(bounces, NOBODY);
            for (index, found) in (0..).zip(found) {
                close(
                    found,
                    expected(index, bounces),
                    &format!("index {index}, {bounces} bounces on {}", device.name()),
                );
            }
            assert!(thrown.iter().all(|note| *note == NONE));
        }
        println!("{}", machine.pipeline.explain());
    }
}

#[test]
fn every_kind_of_program_throws() {
    for device in devices::all("every_kind_of_program_throws") {
        let machine = Machine::new(&device);
        for thrower in [RAYGEN, CLOSESTHIT, MISS, ANYHIT, INTERSECTION, DIRECT, CONTINUATION] {
            let (found, thrown) = machine.launch(2, thrower);
            for (index, (found, thrown)) in (0..).zip(found.into_iter().zip(thrown)) {
                let reaches = match thrower {
                    INTERSECTION => index % 3 == 0,
                    CLOSESTHIT | ANYHIT => index % 3 == 1,
                    MISS => index % 3 == 2,
                    _ => true,
                };
                let what = format!("index {index}, thrower {thrower} on {}", device.name());
                if reaches && index % 2 == 0 {
                    assert_eq!(thrown, note(thrower, index), "{what}");
                    assert_eq!(found, [0.0; 4], "{what}: it went on after it threw");
                } else {
                    assert_eq!(thrown, NONE, "{what}");
                    close(found, expected(index, 2), &what);
                }
            }
        }
    }
}

#[test]
fn trace_depth_is_an_exception() {
    for device in devices::all("trace_depth_is_an_exception") {
        let machine = Machine::new(&device);
        // The pipeline says 4 trace calls deep; a floor that sees itself makes one more.
        let (found, thrown) = machine.launch(4, NOBODY);
        for (index, (found, thrown)) in (0..).zip(found.into_iter().zip(thrown)) {
            let what = format!("index {index} on {}", device.name());
            if index % 6 == 4 {
                assert_eq!(thrown[0], 4, "{what}");
                assert_eq!(found, [0.0; 4], "{what}");
            } else {
                assert_eq!(thrown, NONE, "{what}");
                close(found, expected(index, 4), &what);
            }
        }
    }
}

#[test]
fn without_an_exception_program() {
    for device in devices::all("without_an_exception_program") {
        let scene = Scene::<Unheard>::new(&device);
        let pipeline = Pipeline::for_scene(&scene).ptx(PTX).build().unwrap();
        let found = device.zeroed(INDICES as usize).unwrap();
        pipeline.launch(&UnheardFrameHost { found: found.clone() }, [INDICES, 1, 1]).unwrap().wait().unwrap();
        assert_eq!(found.read().unwrap(), std::array::from_fn::<u32, { INDICES as usize }, _>(|i| u32::from(i < 3)));
        // OptiX prints them; the CPU's device has messages.
        if device.kind() == BackendKind::Cpu {
            let messages = device.take_messages();
            assert_eq!(messages.len(), 5);
            for (i, message) in (3..).zip(messages) {
                for part in ["Fault::Part", "code 1073741809", &format!("[{i}, 0, 0]"), "__raygen__", "callables.rs:"] {
                    assert!(message.contains(part), "no `{part}` in: {message}");
                }
            }
            assert!(device.take_messages().is_empty());
        }
        let notes = pipeline.explain().to_string();
        assert!(notes.contains("user exceptions"), "{notes}");
    }
}

#[test]
fn callables_of_scenes_do_not_mix() {
    let device = Device::cpu().unwrap();
    let (mut a, b) = (Machine::new(&device), Machine::new(&device));
    let mut frame = a.frame(0, NOBODY).0;
    frame.textures = b.textures.clone();
    says(a.pipeline.launch(&frame, [1, 1, 1]), &["callable of another scene"]);
    let foreign = scaled(&mut a.scene, Vec3::ONE);
    let mut other = Scene::<Calls>::new(&device);
    says(other.callable::<sum>(SumHost { of: [foreign.clone(), foreign.clone()] }), &["callable of another scene"]);
    says(other.callables(std::slice::from_ref(&foreign)), &["another scene"]);
    let mut frame = a.frame(0, NOBODY).0;
    frame.textures = a.scene.callables(&[foreign]).unwrap();
    says(
        a.pipeline.launch(&frame, [1, 1, 1]),
        &["a callable whose records the scene got after the pipeline was built"],
    );
    let mut elsewhere = Scene::<Calls>::new(&Device::cpu().unwrap());
    says(
        elsewhere.callable::<sum>(SumHost { of: std::array::from_fn(|_| scaled(&mut a.scene, Vec3::ONE)) }),
        &["another device"],
    );
}

/// A view's index out of range, and a table's, end the launch; nothing is written.
#[test]
fn indices_out_of_range_end_launches() {
    const TEST: &str = "indices_out_of_range_end_launches";
    const CHILD: &str = "OPTIX_TEST_OUT_OF_RANGE";
    let launch = |device: &Device, short: bool| {
        let mut machine = Machine::new(device);
        let mut frame = machine.frame(0, NOBODY).0;
        match short {
            true => frame.found = device.zeroed(INDICES as usize - 1).unwrap(),
            false => {
                machine.shaders = machine.scene.callables(&[]).unwrap();
                machine.pipeline = Pipeline::for_scene(&machine.scene).ptx(PTX).build().unwrap();
                frame = machine.frame(0, NOBODY).0;
            }
        }
        machine.pipeline.launch(&frame, [INDICES, 1, 1]).and_then(|launch| launch.wait())
    };
    if let Ok(short) = std::env::var(CHILD) {
        let error = launch(&devices::optix(TEST).unwrap(), short == "view").expect_err("it ran to its end");
        println!("{short}: {error}");
        return;
    }
    let cpu = Device::cpu().unwrap();
    says(
        launch(&cpu, true),
        &["__raygen__", "index 29 is out of range", "29 elements, at ", "shaders/src/callables.rs:"],
    );
    says(
        launch(&cpu, false),
        &["__raygen__", "callable 0 is out of range: the table has 0, at ", "shaders/src/callables.rs:"],
    );
    if devices::optix(TEST).is_some() {
        // A failed launch takes its process's GPU context with it.
        for short in ["view", "table"] {
            let mut child = std::process::Command::new(std::env::current_exe().unwrap());
            let output = child.args([TEST, "--exact", "--nocapture"]).env(CHILD, short).output().unwrap();
            let text = String::from_utf8_lossy(&output.stdout);
            assert!(output.status.success() && text.contains(&format!("{short}: ")), "{text}");
            print!("{text}");
        }
    }
}

/// The error's text, which is to be one that names what is wrong.
fn says<T>(result: Result<T, Error>, words: &[&str]) {
    let text = result.err().expect("it was accepted").to_string();
    for word in words {
        assert!(text.contains(word), "`{word}` is not in: {text}");
    }
}
