//! Every way by which values go from program to program, with views on it: payloads in registers and in memory, attributes,
//! callables, exceptions; launches inside of programs; programs that catch what ends them.
#![forbid(unsafe_code)]

use optix_device_rs::prelude::*;
use optix_host::{Aabb, CustomPrimitives, Device, Error, Pipeline, Scene, TriangleMesh, glam::Affine3A};
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What the table of callables takes and returns.
type Pick = fn(u32, f64) -> (u32, bool);

#[launch_params]
pub struct Frame {
    pub out: SliceMut<u32>,
    pub world: Traversable,
    pub twice: Callable<fn(Slice<u32>) -> u32>,
    pub table: Callables<Pick>,
    pub mode: u32,
}

/// In registers.
#[derive(Payload)]
pub struct Near {
    #[payload(write(caller, closesthit, miss), read(closesthit, miss, caller))]
    pub out: SliceMut<u32>,
    #[payload(write(closesthit, miss), read(caller))]
    pub seen: Option<(u32, bool)>,
}

/// In memory.
#[derive(Payload)]
#[payload(transport = pointer)]
pub struct Far {
    #[payload(write(caller), read(closesthit, miss))]
    pub table: [f64; 20],
    #[payload(write(closesthit, miss), read(caller))]
    pub sum: f64,
}

#[derive(Clone, Copy, Attributes)]
pub struct Spot {
    pub ids: Slice<u32>,
    pub t: f32,
}

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Ball {
    pub ids: Slice<u32>,
}

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Paint {
    pub id: u32,
}

#[derive(Clone, Copy, UserException)]
pub enum Fault {
    View { at: Slice<u32>, index: u32 },
    Plain,
}

type Inner = Box<dyn Fn() -> Result<(), Error>>;

thread_local! {
    /// A launch that a program makes.
    static INNER: RefCell<Option<Inner>> = const { RefCell::new(None) };
}

const DOWN: Vec3 = Vec3::NEG_Z;

#[raygen]
fn go(rg: &RayGen<Ways>) {
    let frame = rg.params();
    let out = frame.out();
    let at = |x: f32| Ray::new(Vec3::new(x, 0.1, 5.0), DOWN);
    match frame.mode() {
        // A triangle at x = 0, a ball at 10, nothing at 20.
        0 => {
            for (i, x) in [0.1, 10.0, 20.0].into_iter().enumerate() {
                let near = rg.trace::<Near>(frame.world(), at(x), NearFromCaller { out });
                near.out.set(i as u32, near.seen.map_or(0, |(id, even)| id * 2 + u32::from(even)));
                let far = rg.trace::<Far>(frame.world(), at(x), FarFromCaller { table: [0.5; 20] });
                near.out.set(3 + i as u32, far.sum as u32);
            }
        }
        1 => {
            let (id, yes) = frame.table().get(1).call(rg, 20, 0.5);
            out.set(0, id + u32::from(yes));
        }
        2 => rg.throw(Fault::Plain),
        3 => {
            let _ = catch_unwind(AssertUnwindSafe(|| out.set(1000, 1)));
            out.set(0, 77);
        }
        4 => {
            let inner = INNER.with_borrow(|inner| inner.as_ref().map(|launch| launch().is_ok()));
            out.set(0, inner.map_or(9, u32::from));
        }
        5 => {
            struct Late<'a>(&'a RayGen<Ways>);
            impl Drop for Late<'_> {
                fn drop(&mut self) {
                    let frame = self.0.params();
                    let near = self.0.trace::<Near>(
                        frame.world(),
                        Ray::new(Vec3::Z, DOWN),
                        NearFromCaller { out: frame.out() },
                    );
                    let _ = near.seen;
                }
            }
            let _late = Late(rg);
            rg.throw(Fault::Plain);
        }
        _ => panic!("a program's own words"),
    }
}

#[closesthit]
fn paint_near(_: &ClosestHit<Ways, Triangles>, record: &Paint, ray: NearAtClosestHit) -> NearFromClosestHit {
    NearFromClosestHit { out: ray.out, seen: Some((record.id, false)) }
}

#[closesthit]
fn paint_far(_: &ClosestHit<Ways, Triangles>, _: &Paint, ray: FarAtClosestHit) -> FarFromClosestHit {
    FarFromClosestHit { sum: ray.table.iter().sum() }
}

#[intersection]
fn ball(is: &Intersection<Ways, Spot>, record: &Ball) {
    is.report(4.5, 3, Spot { ids: record.ids, t: 4.5 });
}

#[closesthit]
fn ball_near(hit: &ClosestHit<Ways, Spot>, _: &Ball, ray: NearAtClosestHit) -> NearFromClosestHit {
    let Spot { ids, t } = hit.attributes();
    NearFromClosestHit { out: ray.out, seen: Some((hit.params().twice().call(hit, ids), t == 4.5)) }
}

#[closesthit]
fn ball_far(hit: &ClosestHit<Ways, Spot>, _: &Ball, ray: FarAtClosestHit) -> FarFromClosestHit {
    hit.throw(Fault::View { at: hit.attributes().ids, index: ray.table[3] as u32 })
}

#[miss]
fn none_near(_: &Miss<Ways>, ray: NearAtMiss) -> NearFromMiss {
    NearFromMiss { out: ray.out, seen: None }
}

#[miss]
fn none_far(_: &Miss<Ways>, ray: FarAtMiss) -> FarFromMiss {
    FarFromMiss { sum: -ray.table[0] }
}

#[direct_callable]
fn twice(_: &DirectCallable<Ways>, ids: Slice<u32>) -> u32 {
    2 * ids.get(0)
}

#[direct_callable]
fn pick(_: &DirectCallable<Ways>, record: &Paint, id: u32, scale: f64) -> (u32, bool) {
    ((f64::from(id) * scale) as u32 + record.id, true)
}

#[exception]
fn told(ex: &Exception<Ways>) {
    let told = match ex.raised() {
        Raised::User(Fault::View { at, index }) => at.get(index),
        Raised::User(Fault::Plain) => 5,
        _ => 6,
    };
    ex.params().out().set(7, told);
}

pipeline! {
    pub struct Ways {
        params: Frame,
        raygen: [go],
        rays: { Near { miss: none_near }, Far { miss: none_far } },
        hitgroups: {
            Paint on Triangles => { Near { closesthit: paint_near }, Far { closesthit: paint_far } },
            Ball on Custom => { Near { intersection: ball, closesthit: ball_near }, Far { intersection: ball, closesthit: ball_far } },
        },
        direct_callables: [twice, pick],
        throws: Fault,
        exception: told,
    }
}

struct Made {
    _scene: Scene<Ways>,
    pipeline: Pipeline<Ways>,
    frame: FrameHost,
}

fn made(device: &Device) -> Made {
    let mut scene = Scene::<Ways>::new(device);
    let paint = scene.material(Paint { id: 21 }).unwrap();
    let glass = scene.material(BallHost { ids: device.buffer(&[10u32]).unwrap() }).unwrap();
    let triangle = scene.geometry(TriangleMesh::new(&[Vec3::ZERO, Vec3::X, Vec3::Y])).unwrap();
    let shape = scene.geometry(CustomPrimitives::new(&[Aabb { min: Vec3::NEG_ONE, max: Vec3::ONE }])).unwrap();
    let (flat, round) =
        (scene.gas([triangle.with(&paint)]).build().unwrap(), scene.gas([shape.with(&glass)]).build().unwrap());
    let instances = [flat.at(Affine3A::IDENTITY), round.at(Affine3A::from_translation(10.0 * Vec3::X))];
    let world = scene.ias(instances).build().unwrap().world().unwrap();
    let twice = scene.callable::<twice>(()).unwrap();
    let picks: Vec<_> = [100, 200].map(|id| scene.callable::<pick>(Paint { id }).unwrap()).into();
    let table = scene.callables(&picks).unwrap();
    let pipeline = Pipeline::for_scene(&scene).build().unwrap();
    let out = device.zeroed(8).unwrap();
    Made { _scene: scene, pipeline, frame: FrameHost { out, world, twice, table, mode: 0 } }
}

impl Made {
    fn launch(&self, mode: u32) -> Result<Vec<u32>, Error> {
        self.pipeline.launch(&FrameHost { mode, ..self.frame.clone() }, [1, 1, 1])?.wait()?;
        Ok(self.frame.out.read()?)
    }
}

#[test]
fn values_arrive_on_every_way() {
    for device in [Device::cpu().unwrap(), Device::cpu_checked().unwrap()] {
        let made = made(&device);
        let out = made.launch(0).unwrap();
        // The ball's second ray throws a view of its record: the index ends there.
        assert_eq!(out, [42, 41, 0, 10, 0, 0, 0, 10], "{}", device.name());
        assert_eq!(made.launch(1).unwrap()[0], 211);
        assert_eq!(made.launch(2).unwrap()[7], 5);
        assert_eq!(made.launch(5).unwrap()[7], 5);
    }
}

#[test]
fn what_ends_a_program_ends_it() {
    let made = made(&Device::cpu().unwrap());
    for (mode, words) in [(3, "out of range"), (6, "a program's own words")] {
        let error = made.launch(mode).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
}

#[test]
fn programs_launch() {
    let inner = made(&Device::cpu().unwrap());
    rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(move || {
        let outer = made(&Device::cpu().unwrap());
        INNER.set(Some(Box::new(move || inner.launch(0).map(drop))));
        assert_eq!(outer.launch(4).unwrap()[0], 1);
        INNER.set(None);
    });
}
