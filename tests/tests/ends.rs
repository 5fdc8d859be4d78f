//! How launch indices end on the CPU: what ends one can't be taken back by its programs, whatever they catch or drop.

use glam::Vec3;
use optix_device_rs::prelude::*;
use optix_host::{Device, Error, Pipeline, Scene};
use std::panic::{AssertUnwindSafe, catch_unwind, panic_any};

#[launch_params]
pub struct Frame {
    pub out: SliceMut<u32>,
    pub seen: SliceMut<u32>,
    /// How the program ends, as a [`Way`].
    pub way: u32,
    /// What it does about that, as a [`Catch`].
    pub catch: u32,
}

#[derive(Clone, Copy, UserException)]
pub enum Fault {
    A,
    B { detail: u32 },
}

/// Of types that don't take every word.
#[derive(Payload)]
pub struct Narrow {
    #[payload(write(closesthit, miss), read(caller))]
    pub letter: char,
    #[payload(write(closesthit, miss), read(caller))]
    pub flag: bool,
    #[payload(write(closesthit, miss), read(caller))]
    pub list: Option<Slice<u32>>,
}

/// The same in memory of the caller.
#[derive(Payload)]
#[payload(transport = pointer)]
pub struct Stored {
    #[payload(write(closesthit, miss), read(caller))]
    pub letter: char,
    #[payload(write(closesthit, miss), read(caller))]
    pub flags: [bool; 40],
}

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Calls {
    pub inner: Callable<fn(u32) -> char>,
}

fn down() -> Ray {
    Ray::new(Vec3::ZERO, Vec3::NEG_Z)
}

/// A destructor that uses device functions, and says what came back.
struct Uses<'a>(&'a RayGen<Ends>, Callable<fn(u32) -> char>);

impl Drop for Uses<'_> {
    fn drop(&mut self) {
        let seen = self.0.params().seen();
        let narrow = self.0.trace::<Narrow>(Traversable::NULL, down(), ());
        seen.set(0, narrow.letter as u32 + u32::from(narrow.flag) + u32::from(narrow.list.is_some()));
        let stored = self.0.trace::<Stored>(Traversable::NULL, down(), ());
        seen.set(1, stored.letter as u32 + stored.flags.map(u32::from).iter().sum::<u32>());
        seen.set(2, self.1.call(self.0, 1) as u32);
    }
}

/// What unwinds with it panics when it is dropped.
struct Bomb;

impl Drop for Bomb {
    fn drop(&mut self) {
        panic!("in drop");
    }
}

/// As [`Bomb`], with another inside.
struct Bombs(Bomb);

impl Drop for Bombs {
    fn drop(&mut self) {
        panic_any(Bomb);
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    Throw,
    ThrowInCallable,
    CallableCatches,
    OutOfRange,
    TraceDepth,
    NotFinite,
    Panic,
    PanicWithBomb,
    PanicWithBombs,
    Return,
}
use Way::*;
const WAYS: [Way; 10] = [
    Throw,
    ThrowInCallable,
    CallableCatches,
    OutOfRange,
    TraceDepth,
    NotFinite,
    Panic,
    PanicWithBomb,
    PanicWithBombs,
    Return,
];

#[derive(Clone, Copy, Debug, PartialEq)]
enum Catch {
    Nothing,
    AndReturns,
    AndWrites,
    AndTraces,
    AndCalls,
    AndThrows,
    AndFailsAnew,
    DestructorUses,
}
use Catch::*;
const CATCHES: [Catch; 8] =
    [Nothing, AndReturns, AndWrites, AndTraces, AndCalls, AndThrows, AndFailsAnew, DestructorUses];

fn end(rg: &RayGen<Ends>, record: &Calls) {
    match WAYS[rg.params().way() as usize] {
        Throw => rg.throw(Fault::A),
        ThrowInCallable => drop(record.inner.call(rg, 0)),
        CallableCatches => {
            record.inner.call(rg, 2);
            rg.params().out().set(0, 77);
        }
        OutOfRange => rg.params().out().set(99, 1),
        TraceDepth => drop(rg.trace::<Narrow>(Traversable::NULL, down(), ())),
        NotFinite => drop(rg.trace::<Stored>(Traversable::NULL, Ray::new(Vec3::NAN, Vec3::Z), ())),
        Panic => panic!("of its own"),
        PanicWithBomb => panic_any(Bomb),
        PanicWithBombs => panic_any(Bombs(Bomb)),
        Return => {}
    }
}

#[raygen]
fn go(rg: &RayGen<Ends>, record: &Calls) {
    let caught = |run: &dyn Fn()| match catch_unwind(AssertUnwindSafe(run)) {
        Ok(()) => {}
        Err(panic) => std::mem::forget(panic),
    };
    let after = || rg.params().out().set(0, 77);
    match CATCHES[rg.params().catch() as usize] {
        Nothing => end(rg, record),
        DestructorUses => {
            let _uses = Uses(rg, record.inner);
            end(rg, record);
        }
        AndReturns => caught(&|| end(rg, record)),
        AndWrites => {
            caught(&|| end(rg, record));
            after();
        }
        AndTraces => {
            caught(&|| end(rg, record));
            rg.trace::<Narrow>(Traversable::NULL, down(), ());
            after();
        }
        AndCalls => {
            caught(&|| end(rg, record));
            record.inner.call(rg, 1);
            after();
        }
        AndThrows => {
            caught(&|| end(rg, record));
            caught(&|| rg.throw(Fault::B { detail: 1 }));
            caught(&|| rg.throw(Fault::B { detail: 2 }));
        }
        AndFailsAnew => {
            caught(&|| end(rg, record));
            caught(&|| rg.params().out().set(98, 1));
            panic!("a later one");
        }
    }
}

#[direct_callable]
fn inner(dc: &DirectCallable<Ends>, returns: u32) -> char {
    if returns == 0 {
        dc.throw(Fault::B { detail: 5 });
    }
    if returns == 2 {
        let _ = catch_unwind(AssertUnwindSafe(|| dc.throw(Fault::B { detail: 6 })));
    }
    'c'
}

/// Traces deeper than the pipeline says where that is the way to end.
#[miss]
fn letters(ms: &Miss<Ends>) -> NarrowFromMiss {
    if WAYS[ms.params().way() as usize] == TraceDepth && ms.params().catch() != 7 {
        ms.trace::<Narrow>(Traversable::NULL, down(), ());
    }
    NarrowFromMiss { letter: 'n', flag: true, list: None }
}

#[miss]
fn stored(_: &Miss<Ends>) -> StoredFromMiss {
    StoredFromMiss { letter: 's', flags: [true; 40] }
}

pipeline! {
    pub struct Ends {
        params: Frame,
        raygen: [go],
        rays: { Narrow { miss: letters }, Stored { miss: stored } },
        hitgroups: {},
        direct_callables: [inner],
        throws: Fault,
        trace_depth: 1,
    }
}

/// What a launch says, what it wrote, and what its destructor saw.
struct Said {
    failed: Option<String>,
    messages: Vec<String>,
    out: u32,
    seen: Vec<u32>,
}

fn run(device: &Device, way: usize, catch: usize) -> Said {
    let mut scene = Scene::<Ends>::new(device);
    let inner = scene.callable::<inner>(()).unwrap();
    scene.raygen::<go>(CallsHost { inner }).unwrap();
    let pipeline = Pipeline::for_scene(&scene).build().unwrap();
    let (out, seen) = (device.zeroed(1).unwrap(), device.buffer(&[9; 3]).unwrap());
    let frame = FrameHost { out: out.clone(), seen: seen.clone(), way: way as u32, catch: catch as u32 };
    let failed = match pipeline.launch(&frame, [1, 1, 1]) {
        Ok(launch) => launch.wait().err(),
        Err(error) => Some(error),
    };
    let failed = failed.map(|error| match error {
        Error::Program { what, program, index, .. } => format!("{program} {index:?} {what}"),
        other => panic!("{other}"),
    });
    let messages = device.take_messages();
    Said { failed, messages, out: out.read().unwrap()[0], seen: seen.read().unwrap() }
}

#[test]
fn what_ends_a_launch_index_is_not_taken_back() {
    let device = Device::cpu_checked().unwrap();
    for (w, way) in WAYS.into_iter().enumerate() {
        for (c, catch) in CATCHES.into_iter().enumerate() {
            let case = format!("{way:?}, {catch:?}");
            // A destructor's trace call would be the second; and a panic is the program's own to catch.
            let (deep, own) =
                (way == TraceDepth && catch == DestructorUses, matches!(way, Panic | PanicWithBomb | PanicWithBombs));
            let said = run(&device, w, c);
            let (failed, message) = (said.failed.as_deref(), said.messages.first().map(String::as_str));
            let expected = match way {
                Throw => Err("Fault::A"),
                ThrowInCallable => Err("Fault::B (code 1, details [5"),
                CallableCatches => Err("Fault::B (code 1, details [6"),
                OutOfRange => Ok("index 99 is out of range"),
                TraceDepth if !deep => Err("trace depth exceeded"),
                NotFinite => Ok("is not finite"),
                _ if catch == AndThrows => Err("Fault::B (code 1, details [1"),
                _ if catch == AndFailsAnew => Ok("index 98 is out of range"),
                Panic if matches!(catch, Nothing | DestructorUses) => Ok("of its own"),
                PanicWithBomb | PanicWithBombs if matches!(catch, Nothing | DestructorUses) => Ok("it panicked"),
                _ => Ok(""),
            };
            match expected {
                Ok("") => assert_eq!((failed, message), (None, None), "{case}"),
                Ok(what) => {
                    assert!(failed.is_some_and(|f| f.contains(what) && f.contains("[0, 0, 0]")), "{case}: {failed:?}")
                }
                Err(what) => {
                    assert_eq!(failed, None, "{case}");
                    assert!(message.is_some_and(|c| c.contains(what)), "{case}: {message:?}");
                }
            }
            let goes_on = matches!(expected, Ok(""))
                && (own || way == Return)
                && matches!(catch, AndWrites | AndTraces | AndCalls);
            assert_eq!(said.out, if goes_on { 77 } else { 0 }, "{case}");
            let seen = match (catch, way) {
                (DestructorUses, Return | TraceDepth) => ['n' as u32 + 1, 's' as u32 + 40, 'c' as u32],
                (DestructorUses, _) => [0; 3],
                _ => [9; 3],
            };
            assert_eq!(said.seen, seen, "{case}");
        }
    }
}

/// A launch inside of a program, and programs of other indices that a waiting thread runs meanwhile, keep ends of their own.
#[test]
fn ends_belong_to_their_launch_index() {
    let device = Device::cpu().unwrap();
    let outer = catch_unwind(AssertUnwindSafe(|| {
        struct Launches<'a>(&'a Device);
        impl Drop for Launches<'_> {
            fn drop(&mut self) {
                // While this thread unwinds.
                let said = run(self.0, 0, 0);
                assert!(said.messages[0].contains("Fault::A"));
                let said = run(self.0, 9, 3);
                assert_eq!((said.failed, said.out), (None, 77));
            }
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        pool.install(|| {
            let _launches = Launches(&device);
            panic!("outer");
        });
    }));
    assert_eq!(outer.unwrap_err().downcast_ref::<&str>(), Some(&"outer"));
}
