//! Contexts that a program lends further than to the functions that it calls, by scoped thread-locals, and launches that launch.
#![forbid(unsafe_code)]

use optix_device_rs::prelude::*;
use optix_host::{Aabb, CustomPrimitives, Device, Error, Pipeline, Rule, Scene};
use scoped_tls::scoped_thread_local;
use std::cell::{Cell, RefCell};
use std::rc::Rc;

scoped_thread_local!(static RAYGEN: RayGen<Lends>);
scoped_thread_local!(static INTERSECTION: Intersection<Lends, Spot>);

#[launch_params]
pub struct Frame {
    pub out: SliceMut<u32>,
    pub world: Traversable,
    pub mode: u32,
}

/// Parameters without a structure.
#[launch_params]
pub struct Few {
    pub out: SliceMut<u32>,
    pub mode: u32,
}

#[derive(Payload)]
pub struct Ping {
    #[payload(write(caller, closesthit, miss), read(caller))]
    pub id: u32,
}

#[derive(Clone, Copy, Attributes)]
pub struct Spot {
    pub id: u32,
}

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Ball {}

/// Four words.
#[derive(Clone, Copy, UserException)]
pub enum Words {
    Four { words: [u32; 4] },
}

/// The same code, and as many words, which mean a view.
#[derive(Clone, Copy, UserException)]
pub enum Views {
    One { view: Slice<u32> },
}

type Inner = Box<dyn Fn() -> Result<(), Error>>;

thread_local! {
    /// A launch that a program makes.
    static INNER: RefCell<Option<Inner>> = const { RefCell::new(None) };
}

fn ray() -> Ray {
    Ray::new(Vec3::new(0.0, 0.0, 5.0), Vec3::NEG_Z)
}

#[raygen]
fn lend(rg: &RayGen<Lends>) {
    let frame = rg.params();
    RAYGEN.set(rg, || match frame.mode() {
        0 => {
            let inner = INNER.with_borrow(|inner| inner.as_ref().map(|launch| launch().unwrap_err().to_string()));
            let refused = inner.is_some_and(|words| words.contains("another program runs"));
            frame.out().set(0, u32::from(refused));
        }
        _ => {
            let seen = rg.trace::<Ping>(frame.world(), ray(), PingFromCaller { id: 0 });
            // After the programs that it waited for, it may use its context again, also where it was lent.
            RAYGEN.with(|rg| rg.params().out().set(0, seen.id));
        }
    });
}

#[intersection]
fn ball(is: &Intersection<Lends, Spot>, _: &Ball) {
    INTERSECTION.set(is, || is.report(4.0, 3, Spot { id: 5 }));
}

#[anyhit]
fn asks(hit: &AnyHit<Lends, Spot>) -> Decision {
    match hit.params().mode() {
        1 => drop(INTERSECTION.with(|is| is.report(3.0, 3, Spot { id: 6 }))),
        2 => drop(INTERSECTION.with(|is| is.ray_tmax())),
        3 => drop(RAYGEN.with(|rg| rg.trace::<Ping>(rg.params().world(), ray(), PingFromCaller { id: 0 }).id)),
        4 => drop(RAYGEN.with(|rg| rg.launch_index())),
        _ => {}
    }
    Decision::Accept
}

#[closesthit]
fn seen(hit: &ClosestHit<Lends, Spot>, _: &Ball) -> PingFromClosestHit {
    PingFromClosestHit { id: hit.attributes().id }
}

#[miss]
fn none(_: &Miss<Lends>) -> PingFromMiss {
    PingFromMiss { id: 1 }
}

#[exception]
fn told(ex: &Exception<Lends>) {
    ex.params().out().set(1, 1);
}

pipeline! {
    pub struct Lends {
        params: Frame,
        raygen: [lend],
        rays: { Ping { miss: none } },
        hitgroups: { Ball on Custom => { Ping { intersection: ball, closesthit: seen, anyhit: asks } } },
        throws: Words,
        exception: told,
    }
}

#[raygen]
fn borrow(rg: &RayGen<Borrows>) {
    match rg.params().mode() {
        0 => RAYGEN.with(|lent| lent.throw(Words::Four { words: [1, 0, 1 << 20, 0] })),
        1 => {
            let launched = INNER.with_borrow(|inner| inner.as_ref().map(|launch| launch()));
            assert!(matches!(launched, Some(Ok(()))));
        }
        _ => {}
    }
}

#[exception]
fn reads(ex: &Exception<Borrows>) {
    let told = match ex.raised() {
        Raised::User(Views::One { view }) => view.get(1000),
        Raised::StackOverflow => 9,
        _ => 1,
    };
    ex.params().out().set(1, told);
}

pipeline! {
    pub struct Borrows {
        params: Few,
        raygen: [borrow],
        rays: {},
        hitgroups: {},
        throws: Views,
        exception: reads,
    }
}

fn lends(device: &Device) -> (Pipeline<Lends>, FrameHost) {
    let mut scene = Scene::<Lends>::new(device);
    let ball = scene.material(Ball {}).unwrap();
    let shape = scene.geometry(CustomPrimitives::new(&[Aabb { min: Vec3::NEG_ONE, max: Vec3::ONE }])).unwrap();
    let world = scene.gas([shape.with(&ball)]).build().unwrap().world().unwrap();
    let pipeline = Pipeline::for_scene(&scene).build().unwrap();
    (pipeline, FrameHost { out: device.zeroed(2).unwrap(), world, mode: 0 })
}

fn borrows(device: &Device, mode: u32) -> (Pipeline<Borrows>, FewHost) {
    let pipeline = Pipeline::for_scene(&Scene::<Borrows>::new(device)).build().unwrap();
    (pipeline, FewHost { out: device.zeroed(2).unwrap(), mode })
}

/// On one thread, which runs the programs of all launches.
fn on_one_thread(run: impl FnOnce() + Send) {
    rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(run);
}

#[test]
fn only_the_program_that_runs_uses_its_context() {
    for device in [Device::cpu().unwrap(), Device::cpu_checked().unwrap()] {
        let (pipeline, frame) = lends(&device);
        for mode in 1..=5 {
            let result = pipeline.launch(&FrameHost { mode, ..frame.clone() }, [1, 1, 1]).and_then(|l| l.wait());
            if mode == 5 {
                result.unwrap();
                assert_eq!(frame.out.read().unwrap(), [5, 0]);
            } else {
                let error = result.unwrap_err();
                assert!(matches!(error, Error::Program { rule: Rule::Context, .. }), "{mode}: {error}");
                assert!(error.to_string().contains("another program runs"), "{mode}: {error}");
            }
        }
    }
}

#[test]
fn a_throw_is_told_to_the_pipeline_of_the_program_that_runs() {
    let device = Device::cpu().unwrap();
    let (outer, frame) = lends(&device);
    let (inner, its_frame) = borrows(&device, 0);
    on_one_thread(move || {
        INNER.set(Some(Box::new(move || inner.launch(&its_frame, [1, 1, 1])?.wait().map(drop))));
        outer.launch(&frame, [1, 1, 1]).unwrap().wait().unwrap();
        assert_eq!(frame.out.read().unwrap(), [1, 0]);
        INNER.set(None);
    });
}

#[test]
fn launches_that_launch_without_end_are_a_stack_overflow() {
    // Under Miri, whose stack has no end, a few levels show that nothing is undefined.
    let most = if cfg!(miri) { 3 } else { u32::MAX };
    on_one_thread(move || {
        let (pipeline, frame) = borrows(&Device::cpu().unwrap(), 1);
        let (pipeline, left) = (Rc::new(pipeline), Cell::new(most));
        let (again, its_frame) = (pipeline.clone(), frame.clone());
        INNER.set(Some(Box::new(move || {
            left.set(left.get() - 1);
            let mode = if left.get() == 0 { 2 } else { 1 };
            again.launch(&FewHost { mode, ..its_frame.clone() }, [1, 1, 1])?.wait().map(drop)
        })));
        pipeline.launch(&frame, [1, 1, 1]).unwrap().wait().unwrap();
        assert_eq!(frame.out.read().unwrap(), [0, if cfg!(miri) { 0 } else { 9 }]);
        INNER.set(None);
    });
}
