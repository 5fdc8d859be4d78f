//! What a program keeps for a later launch: in a variable of its thread, since views can't go into statics or to other threads.
#![forbid(unsafe_code)]

use optix_device_rs::prelude::*;
use optix_host::{Device, Error, Pipeline, Rule, Scene, TriangleMesh, glam::Affine3A};
use std::cell::Cell;
use std::panic::catch_unwind;

/// What the first launch keeps and the second one uses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(u32)]
enum What {
    Slice,
    SliceMut,
    SliceMut2d,
    Traversable,
    Instances,
    Triangles,
    /// The view of a record.
    Record,
    Direct,
    Table,
    Continuation,
}

const ALL: [What; 10] = [
    What::Slice,
    What::SliceMut,
    What::SliceMut2d,
    What::Traversable,
    What::Instances,
    What::Triangles,
    What::Record,
    What::Direct,
    What::Table,
    What::Continuation,
];

/// What callables take and return.
type Adds = fn(u32) -> u32;

#[derive(Clone, Copy)]
enum Kept {
    Slice(Slice<u32>),
    SliceMut(SliceMut<u32>),
    SliceMut2d(SliceMut2d<Vec4>),
    Traversable(Traversable),
    Instances(Instances),
    Triangles(TriangleVertices),
    Direct(Callable<Adds>),
    Table(Callables<Adds>),
    Continuation(Callable<Adds, Continuation>),
}

thread_local! {
    static KEPT: Cell<Option<Kept>> = const { Cell::new(None) };
}

#[launch_params]
pub struct Frame {
    pub read: Slice<u32>,
    pub out: SliceMut<u32>,
    pub film: SliceMut2d<Vec4>,
    pub world: Traversable,
    pub instances: Instances,
    pub triangles: TriangleVertices,
    pub direct: Callable<Adds>,
    pub table: Callables<Adds>,
    pub continuation: Callable<Adds, Continuation>,
    pub keep: u32,
    pub what: u32,
}

#[derive(Payload)]
pub struct Found {
    #[payload(write(closesthit, miss), read(caller))]
    pub id: u32,
}

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Paint {
    pub ids: Slice<u32>,
}

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Start {
    pub ids: Slice<u32>,
}

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct More {
    pub by: u32,
}

#[direct_callable]
fn add(_: &DirectCallable<Keeps>, more: &More, to: u32) -> u32 {
    to + more.by
}

#[continuation_callable]
fn add_in_turn(_: &ContinuationCallable<Keeps>, more: &More, to: u32) -> u32 {
    to + more.by
}

fn kept(frame: &FrameView<'_>, start: &Start) -> Kept {
    match ALL[frame.what() as usize] {
        What::Slice => Kept::Slice(frame.read()),
        What::SliceMut => Kept::SliceMut(frame.out()),
        What::SliceMut2d => Kept::SliceMut2d(frame.film()),
        What::Traversable => Kept::Traversable(frame.world()),
        What::Instances => Kept::Instances(frame.instances()),
        What::Triangles => Kept::Triangles(frame.triangles()),
        What::Record => Kept::Slice(start.ids),
        What::Direct => Kept::Direct(frame.direct()),
        What::Table => Kept::Table(frame.table()),
        What::Continuation => Kept::Continuation(frame.continuation()),
    }
}

#[raygen]
fn go(rg: &RayGen<Keeps>, start: &Start) {
    let frame = rg.params();
    if frame.keep() == 1 {
        KEPT.set(Some(kept(&frame, start)));
        return;
    }
    let ray = Ray::new(Vec3::new(0.1, 0.1, 1.0), Vec3::NEG_Z);
    let found = match KEPT.get().unwrap() {
        Kept::Slice(view) => view.get(0),
        Kept::SliceMut(view) => {
            view.set(1, 7);
            view.get(1)
        }
        Kept::SliceMut2d(view) => {
            view.set(UVec2::ZERO, Vec4::splat(7.0));
            view.get(UVec2::ZERO).x as u32
        }
        Kept::Traversable(world) => rg.trace::<Found>(world, ray, ()).id,
        Kept::Instances(instances) => instances.get(rg, 0).id(),
        Kept::Triangles(triangles) => triangles.get(rg, 0, 0)[1].x as u32 * 7,
        Kept::Direct(callable) => callable.call(rg, 5),
        Kept::Table(table) => table.get(1).call(rg, 5),
        Kept::Continuation(callable) => callable.call(rg, 5),
    };
    frame.out().set(0, found);
}

#[closesthit]
fn paint(_: &ClosestHit<Keeps, Triangles>, record: &Paint) -> FoundFromClosestHit {
    FoundFromClosestHit { id: record.ids.get(0) }
}

#[miss]
fn none(_: &Miss<Keeps>) -> FoundFromMiss {
    FoundFromMiss { id: 99 }
}

pipeline! {
    pub struct Keeps {
        params: Frame,
        raygen: [go],
        rays: { Found { miss: none } },
        hitgroups: { Paint on Triangles => { Found { closesthit: paint } } },
        direct_callables: [add],
        continuation_callables: [add_in_turn],
    }
}

/// A scene, its pipeline and all that its launches are given.
struct Made {
    scene: Scene<Keeps>,
    pipeline: Pipeline<Keeps>,
    frame: FrameHost,
}

fn made(device: &Device) -> Made {
    let mut scene = Scene::<Keeps>::new(device);
    let ids = device.buffer(&[7u32]).unwrap();
    let material = scene.material(PaintHost { ids: ids.clone() }).unwrap();
    scene.raygen::<go>(StartHost { ids }).unwrap();
    let geometry = scene.geometry(TriangleMesh::new(&[Vec3::ZERO, Vec3::X, Vec3::Y])).unwrap();
    let (gas, triangles) = scene.gas([geometry.with(&material)]).build_with_triangles().unwrap();
    let (ias, instances) = scene.ias([gas.at(Affine3A::IDENTITY).id(7)]).build_with_instances().unwrap();
    let direct = scene.callable::<add>(More { by: 2 }).unwrap();
    let table = scene.callables(&[direct.clone(), direct.clone()]).unwrap();
    let continuation = scene.callable::<add_in_turn>(More { by: 2 }).unwrap();
    let pipeline = Pipeline::for_scene(&scene).build().unwrap();
    let frame = FrameHost {
        read: device.buffer(&[7u32]).unwrap(),
        out: device.zeroed(2).unwrap(),
        film: device.zeroed_2d([1, 1]).unwrap(),
        world: ias.world().unwrap(),
        instances,
        triangles,
        direct,
        table,
        continuation,
        keep: 0,
        what: 0,
    };
    Made { scene, pipeline, frame }
}

impl Made {
    fn launch(&self, keep: bool, what: What) -> Result<(), Error> {
        let frame = FrameHost { keep: keep.into(), what: what as u32, ..self.frame.clone() };
        self.pipeline.launch(&frame, [1, 1, 1])?.wait()
    }
}

/// On one thread, so that the second launch finds what the first one kept.
fn on_one_thread(test: impl FnOnce() + Send) {
    rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(test);
}

#[track_caller]
fn refused(result: Result<(), Error>) {
    let Err(Error::Program { rule, what, .. }) = result else { panic!("{result:?}") };
    assert!(matches!(rule, Rule::View | Rule::Held | Rule::CallableRecord), "{rule:?}");
    assert!(what.contains("kept from another launch"), "{what}");
}

#[test]
fn a_launch_that_is_given_it_may_use_what_was_kept() {
    on_one_thread(|| {
        let made = made(&Device::cpu().unwrap());
        for what in ALL {
            made.launch(true, what).unwrap();
            made.launch(false, what).unwrap();
            assert_eq!(made.frame.out.read().unwrap()[0], 7, "{what:?}");
        }
    });
}

#[test]
fn any_other_launch_ends() {
    // Miri takes seconds for each scene.
    let devices = if cfg!(miri) { vec![Device::cpu()] } else { vec![Device::cpu(), Device::cpu_checked()] };
    for device in devices.into_iter().map(Result::unwrap) {
        on_one_thread(|| {
            let other = made(&device);
            for what in ALL {
                let first = made(&device);
                first.launch(true, what).unwrap();
                refused(other.launch(false, what)); // while it is alive
                drop(first);
                let _reused: Vec<_> = (0..if cfg!(miri) { 0 } else { 4 }).map(|_| made(&device)).collect();
                refused(other.launch(false, what)); // and after
            }
        });
    }
}

#[test]
fn a_structure_that_is_read_only_is_not_traced_against() {
    on_one_thread(|| {
        let device = Device::cpu().unwrap();
        let (first, mut other) = (made(&device), made(&device));
        // Tables of another scene's structures may be read, but its records are not in this table.
        other.frame.instances = first.frame.instances.clone();
        other.frame.triangles = first.frame.triangles.clone();
        first.launch(true, What::Traversable).unwrap();
        refused(other.launch(false, What::Traversable));
        first.launch(true, What::Instances).unwrap();
        other.launch(false, What::Instances).unwrap();
    });
}

#[test]
fn a_callable_that_was_made_after_the_pipeline_is_not_called() {
    on_one_thread(|| {
        let mut made = made(&Device::cpu().unwrap());
        let direct = made.scene.callable::<add>(More { by: 2 }).unwrap();
        let pipeline = Pipeline::for_scene(&made.scene).build().unwrap();
        let newer = FrameHost { direct, keep: 1, what: What::Direct as u32, ..made.frame.clone() };
        pipeline.launch(&newer, [1, 1, 1]).unwrap().wait().unwrap();
        refused(made.launch(false, What::Direct));
        // The older records are in the newer table, too.
        made.launch(true, What::Direct).unwrap();
        pipeline.launch(&FrameHost { keep: 0, ..newer }, [1, 1, 1]).unwrap().wait().unwrap();
        assert_eq!(made.frame.out.read().unwrap()[0], 7);
    });
}

#[test]
fn outside_of_a_launch_a_view_shows_nothing() {
    on_one_thread(|| {
        let made = made(&Device::cpu().unwrap());
        for what in [What::Slice, What::SliceMut, What::SliceMut2d, What::Record] {
            made.launch(true, what).unwrap();
            let panic = catch_unwind(|| match KEPT.get().unwrap() {
                Kept::Slice(view) => drop(view.get(0)),
                Kept::SliceMut(view) => view.set(0, 1),
                Kept::SliceMut2d(view) => view.set(UVec2::ZERO, Vec4::ONE),
                _ => {}
            });
            let words = panic.unwrap_err().downcast::<String>().unwrap();
            assert!(words.contains("outside of a launch"), "{words}");
        }
    });
}

#[test]
fn empty_views_have_nothing_to_show() {
    let panic = catch_unwind(|| Slice::<u32>::EMPTY.get(0)).unwrap_err();
    assert!(panic.downcast::<String>().unwrap().contains("out of range"));
}
