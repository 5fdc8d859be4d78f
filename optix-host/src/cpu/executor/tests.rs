//! What the checked mode traps, one test a rule. The typed API can't say most of this, so the programs are written by
//! hand, on the frame.

use super::*;
use crate::cpu::traversal::{Accel, Gas, Ias, Instance};
use crate::geometry::{Aabb, BuildInput, CustomPrimitiveArray, GeometryFlags, Records, TriangleArray};
use crate::sbt::HitProgram;
use glam::Vec3;
use optix_device_rs::callable::Direct;
use optix_device_rs::host::{
    CallableDescription, Entry, ExceptionsDescription, Frame, Handle, HitGroupDescription, ParamsDescription,
    PayloadDescription, PrimitiveType, ProgramDescription, RayDescription, RecordLayout, TraceCall,
};
use optix_device_rs::intrinsics::Invocation;
use optix_device_rs::payload::Field;
use optix_device_rs::prelude::{AnyHitMode, CullFaces, Decision, Ray, RayFlags, Slice};
use optix_device_rs::words::WordBuffer;

/// What the programs do. Fields are of the payload.
#[derive(Clone, Copy)]
struct Script {
    call: TraceCall,
    /// The transform of an instance that the structure is under, as a scale; 1 for none.
    scale: f32,
    /// Trace calls that the closest-hit program makes, one in the other.
    nested: u32,
    anyhit_gives: &'static [usize],
    closesthit_takes: &'static [usize],
    closesthit_gives: &'static [usize],
    miss_gives: &'static [usize],
    report: (f32, u32),
    callable: Called,
    /// What the ray-generation program asks, of the structure with this handle.
    asks: Asks,
}

/// Given the program's frame, whose executor it asks, and the structure's handle.
type Asks = fn(&Frame<'_>, u64);

/// What the ray-generation program calls.
#[derive(Clone, Copy, PartialEq)]
enum Called {
    Nothing,
    /// A record, by a signature that is or is not the callable's.
    Record(u32, bool),
    /// A callable that calls itself so often.
    Nested(u32),
}

/// By which programs know the only callable.
const CALLABLE: u32 = 5;

/// What the pipeline's plan says.
#[derive(Clone, Copy)]
struct Planned {
    depths: Depths,
    exceptions: Exceptions,
}

const PLANNED: Planned = Planned {
    depths: Depths {
        trace: 2,
        trace_is_stated: false,
        continuation: 0,
        direct_from_traversal: 0,
        direct_from_state: 3,
    },
    exceptions: Exceptions { stack_overflow: false, trace_depth: false, user: false },
};

/// What becomes of a launch index.
#[derive(Debug, PartialEq)]
enum Outcome {
    Done,
    Trapped(Rule, String),
    /// By an exception that no program is told of.
    Thrown(Vec<String>),
}

thread_local! {
    static SCRIPT: Cell<Option<Script>> = const { Cell::new(None) };
}

fn script() -> Script {
    SCRIPT.get().unwrap()
}

/// What a hand-written program asks by.
fn invocation(frame: &Frame<'_>) -> Invocation {
    // SAFETY: it does not outlive the program call, and these programs read neither parameters nor record.
    unsafe { Invocation::new(frame) }
}

macro_rules! programs {
    ($($name:ident: |$frame:tt, $at:ident| $body:expr;)*) => {$(
        unsafe fn $name(frame: &Frame<'_>) -> Decision {
            let ($frame, $at) = (frame, invocation(frame));
            $body;
            Decision::Accept
        }
    )*};
}
programs! {
    raygen: |frame, at| {
        call(at);
        (script().asks)(frame, script().call.traversable);
        at.trace(&script().call, WordBuffer::ZERO)
    };
    direct: |_, at| {
        if let Called::Nested(deeper) = script().callable && deeper > 0 {
            SCRIPT.set(Some(Script { callable: Called::Nested(deeper - 1), ..script() }));
            call(at);
        }
        at.set_payload(1, &WordBuffer([7; 32]));
    };
    anyhit: |_, at| at.gives(script().anyhit_gives);
    closesthit: |_, at| {
        at.takes(script().closesthit_takes);
        if let Some(nested) = script().nested.checked_sub(1) {
            SCRIPT.set(Some(Script { nested, ..script() }));
            at.trace(&script().call, WordBuffer::ZERO);
        }
        at.gives(script().closesthit_gives);
    };
    miss: |_, at| at.gives(script().miss_gives);
    intersection: |_, at| at.report(script().report.0, script().report.1, 0, &WordBuffer::ZERO);
}

/// Makes the script's call.
fn call(at: Invocation) {
    // SAFETY: none is needed on the host.
    unsafe {
        match script().callable {
            Called::Nothing => {}
            Called::Record(number, true) => assert_eq!(at.call_direct::<fn(f32) -> u32>(number, (1.0,)), 7),
            Called::Record(number, false) => drop(at.call_direct::<fn(u32) -> u32>(number, (1,))),
            Called::Nested(_) => drop(at.call_direct::<fn(f32) -> u32>(CALLABLE, (1.0,))),
        }
    }
}

const fn entry(name: &'static str, run: unsafe fn(&Frame<'_>) -> Decision) -> Entry {
    Entry { name, function: name, body: run }
}
const RECORD: RecordLayout = RecordLayout { name: "()", size: 0, align: 1 };
const fn word(name: &'static str, at: usize) -> Field {
    Field { name, at, count: 1 }
}
const fn group(geometry: PrimitiveType, rays: &'static [HitPrograms]) -> HitGroupDescription {
    HitGroupDescription { record: RECORD, geometry, attribute_words: 0, rays }
}
const HIT: HitPrograms = HitPrograms {
    closesthit: Some(entry("__closesthit__test", closesthit)),
    anyhit: Some(entry("__anyhit__test", anyhit)),
    intersection: None,
};
static PIPELINE: PipelineDescription = PipelineDescription {
    name: "Test",
    params: ParamsDescription { name: "()", symbol: "", size: 0, align: 1, fields: &[] },
    raygen: &[ProgramDescription { entry: entry("__raygen__test", raygen), record: RECORD }],
    rays: &[RayDescription {
        payload: PayloadDescription {
            name: "Radiance",
            semantics: &[0; 5],
            fields: &[word("seed", 0), word("depth", 1), word("hits", 2), Field { name: "light", at: 3, count: 2 }],
            memory_words: 0,
        },
        miss: Some(ProgramDescription { entry: entry("__miss__test", miss), record: RECORD }),
    }],
    hitgroups: &[
        group(PrimitiveType::Triangle, &[HIT]),
        group(
            PrimitiveType::Custom,
            &[HitPrograms { intersection: Some(entry("__intersection__test", intersection)), ..HIT }],
        ),
    ],
    callables: &[CallableDescription::of::<(), fn(f32) -> u32, Direct>(entry("__direct_callable__test", direct))],
    exceptions: ExceptionsDescription { throws: None, variants: &[], program: None },
    trace_depth: None,
    callable_depth: None,
    crossings: &[],
    layouts: "",
};

/// A ray down on a triangle, or on a box, and a call that breaks no rule: field 0 goes in and comes back.
fn lawful(custom: bool) -> Script {
    let call = TraceCall {
        payload_type: 1,
        payload_words: 5,
        traversable: 0,
        ray: Ray::new(Vec3::new(0.25, 0.25, 2.0), Vec3::NEG_Z),
        sbt_offset: u32::from(custom),
        sbt_stride: 1,
        miss_index: 0,
        caller_writes: &[0],
        caller_reads: &[0],
    };
    let report = (1.5, 127);
    Script {
        call,
        scale: 1.0,
        nested: 0,
        anyhit_gives: &[],
        closesthit_takes: &[0],
        closesthit_gives: &[],
        miss_gives: &[],
        report,
        callable: Called::Nothing,
        asks: |_, _| {},
    }
}

/// Runs launch index (3, 1, 0) of a launch by the script; the broken rule and the message if it is trapped.
fn run(custom: bool, checked: bool, script: Script) -> Option<(Rule, String)> {
    match run_planned(custom, checked, script, PLANNED) {
        Outcome::Done => None,
        Outcome::Trapped(rule, message) => Some((rule, message)),
        Outcome::Thrown(what) => panic!("{what:?}"),
    }
}

fn run_planned(custom: bool, checked: bool, mut script: Script, planned: Planned) -> Outcome {
    let records = Records::one(GeometryFlags::NONE);
    let gas = if custom {
        let array = CustomPrimitiveArray::new(vec![Aabb { min: Vec3::ZERO, max: Vec3::ONE }]).unwrap();
        Gas::new(vec![BuildInput::new(array, records).unwrap()])
    } else {
        let array = TriangleArray::new(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], None).unwrap();
        Gas::new(vec![BuildInput::new(array, records).unwrap()])
    };
    let mut accel = Accel::from(gas.unwrap());
    if script.scale != 1.0 {
        let s = script.scale;
        let transform = [s, 0.0, 0.0, 0.0, 0.0, s, 0.0, 0.0, 0.0, 0.0, s, 0.0];
        let instance = Instance { transform, id: 17, ..Instance::new(Arc::new(accel)) };
        accel = Ias::new(vec![instance]).unwrap().into();
    }
    let handle = Handle::issue();
    let mut reached = Reached::default();
    reached.traced.insert(&handle, &accel);
    reached.read.insert(&handle, &accel);
    if script.call.traversable == 0 {
        script.call.traversable = handle.number();
    }
    SCRIPT.set(Some(script));
    let none: &[u8] = &[];
    let callables = Section::new([(CallableProgram { program: 0, number: CALLABLE }, none)]);
    reached.callables = Callables::of(&callables);
    let sbt = ShaderBindingTable {
        raygen: Section::new([(0, none)]),
        miss: Section::new([(0, none)]),
        hit: Section::new([0, 1].map(|group| (HitProgram { group, ray: 0 }, none))),
        callables,
        exception: Section::new([]),
    };
    let launch = Launch {
        description: &PIPELINE,
        depths: planned.depths,
        exceptions: planned.exceptions,
        sbt: &sbt,
        params: vec![0],
        reached,
        raygen: 0,
        dimensions: UVec3::new(4, 2, 1),
        checked,
        unhandled: Unhandled::default(),
    };
    match run_index(&launch, UVec3::new(3, 1, 0)) {
        Err(error) => match error {
            Error::Program { rule, .. } => Outcome::Trapped(rule, error.to_string()),
            _ => panic!("{error}"),
        },
        Ok(()) => match launch.unhandled.reports() {
            reports if reports.is_empty() => Outcome::Done,
            reports => Outcome::Thrown(reports),
        },
    }
}

/// The call, changed, is trapped in checked mode, with all of these words in the message, and not otherwise.
#[track_caller]
fn traps(custom: bool, change: impl FnOnce(&mut Script), program: &str, rule: Rule, words: &[&str]) {
    assert_eq!(run(custom, true, lawful(custom)), None);
    let mut script = lawful(custom);
    change(&mut script);
    assert_eq!(run(custom, false, script), None);
    let (broken, message) = run(custom, true, script).expect("the checked mode says nothing");
    assert_eq!(broken, rule, "{message}");
    let guide = format!("(guide {})", rule.guide());
    for part in [program, "[3, 1, 0]", &guide, rule.remedy()].iter().chain(words) {
        assert!(message.contains(part), "no `{part}` in: {message}");
    }
}

#[test]
fn rays_that_are_not_finite() {
    let raygen = "__raygen__test";
    traps(false, |s| s.call.ray.origin.y = f32::NAN, raygen, Rule::Ray, &["origin [0.25, NaN, 2] is not finite"]);
    traps(false, |s| s.call.ray.direction.z = f32::INFINITY, raygen, Rule::Ray, &["direction", "not finite"]);
    traps(false, |s| s.call.ray.direction = Vec3::ZERO, raygen, Rule::Ray, &["no direction"]);
}

#[test]
fn rays_that_are_none_in_object_space() {
    let at = |scale: f32, origin: Vec3, direction: Vec3| {
        move |s: &mut Script| {
            s.scale = scale;
            s.call.ray = Ray::new(origin, direction);
        }
    };
    let trapped = |change: &dyn Fn(&mut Script), words: &[&str]| {
        let words = [&["the instance with ID 17, at [0] from the root"], words].concat();
        traps(false, change, "__raygen__test", Rule::ObjectRay, &words);
    };
    let over = Vec3::new(0.0, 0.0, 2.0);
    trapped(&at(3e-39, over, Vec3::NEG_Z), &["its origin becomes [0, 0, inf]"]);
    trapped(&at(0.5, over, Vec3::NEG_Z * f32::MAX), &["its direction becomes [0, 0, -inf]"]);
    trapped(&at(1e30, over, Vec3::NEG_Z * 1e-30), &["all elements of its direction become 0"]);
    for lawful_change in [at(1e-38, over, Vec3::NEG_Z), at(1e30, over, Vec3::NEG_Z), at(3e-39, Vec3::ONE, Vec3::Z)] {
        let mut script = lawful(false);
        lawful_change(&mut script);
        assert_eq!(run(false, true, script), None);
    }
}

#[test]
fn intervals() {
    let raygen = "__raygen__test";
    traps(false, |s| s.call.ray.tmin = -1e-3, raygen, Rule::Interval, &["tmin is negative: -0.001"]);
    traps(false, |s| s.call.ray.tmin = f32::NAN, raygen, Rule::Interval, &["tmin is NaN"]);
    traps(false, |s| s.call.ray.tmin = f32::INFINITY, raygen, Rule::Interval, &["tmin is inf"]);
    traps(false, |s| s.call.ray.tmax = f32::NAN, raygen, Rule::Interval, &["tmax is NaN"]);
    let mut endless = lawful(false);
    endless.call.ray.tmax = f32::INFINITY;
    assert_eq!(run(false, true, endless), None);
}

#[test]
fn flags_that_exclude_each_other() {
    // SAFETY: on the CPU, which refuses those that exclude each other.
    let flags = |bits: u32| unsafe { RayFlags::from_bits(bits) };
    for (rule, group) in [(Rule::AnyHitFlags, &[1, 2, 64, 128][..]), (Rule::CullFlags, &[16, 32])] {
        for (i, one) in group.iter().enumerate() {
            for other in &group[..i] {
                let words = ["exclude", &format!("{:#x}", one | other)];
                let all = |s: &mut Script| s.call.ray.flags = flags(one | other | 4);
                let both = |s: &mut Script| s.call.ray.flags = flags(one | other);
                traps(false, both, "__raygen__test", rule, &words);
                traps(false, all, "__raygen__test", rule, &words[..1]);
            }
        }
    }
    for anyhit in [AnyHitMode::Default, AnyHitMode::Disable, AnyHitMode::Enforce] {
        for faces in [CullFaces::None, CullFaces::Back] {
            let mut lawful = lawful(false);
            lawful.call.ray.flags = RayFlags::NONE.any_hit(anyhit).cull(faces);
            assert_eq!(run(false, true, lawful), None);
        }
    }
}

/// The record or the miss index of another ray type than the call's payload.
#[test]
fn programs_of_another_payload_type() {
    let other = |s: &mut Script| s.call.payload_type = 2;
    for (custom, program) in [(false, "__raygen__test"), (true, "__raygen__test")] {
        traps(custom, other, program, Rule::PayloadType, &["payload type 0x2 is traced", "for 0x1"]);
    }
    let missing = |s: &mut Script| (s.call.payload_type, s.call.ray.direction) = (4, Vec3::Z);
    traps(false, missing, "__raygen__test", Rule::PayloadType, &["payload type 0x4"]);
}

/// No typed program can ask these; they are trapped in either mode, since there is no answer.
#[test]
fn questions_without_an_answer() {
    for checked in [false, true] {
        for (i, (rule, asks)) in unsafe_asks().into_iter().enumerate() {
            let (broken, message) =
                run(false, checked, Script { asks, ..lawful(false) }).unwrap_or_else(|| panic!("question {i}"));
            assert_eq!(broken, rule, "{message}");
            assert!(message.contains("__raygen__test"), "{message}");
        }
        let mut elsewhere = lawful(false);
        elsewhere.call.traversable = u64::MAX;
        let (rule, message) = run(false, checked, elsewhere).unwrap();
        assert!(rule == Rule::Held && message.contains("kept from another launch"), "{message}");
        // The triangle that is there.
        // SAFETY: as above.
        let asks: Asks = |frame, gas| unsafe {
            frame.executor.triangle_vertices_from_handle(gas, 0, 0);
        };
        assert_eq!(run(false, checked, Script { asks, ..lawful(false) }), None);
    }
}

/// Questions of a ray-generation program, and the rules that they break.
fn unsafe_asks() -> [(Rule, Asks); 12] {
    // SAFETY: the executor answers none of these, and says why.
    unsafe {
        [
            (Rule::Kind, |frame, _| {
                frame.executor.report(1.0, 0, 0, &WordBuffer::ZERO);
            }),
            (Rule::Kind, |frame, _| {
                frame.executor.interval_end();
            }),
            (Rule::Kind, |frame, _| {
                frame.executor.triangle_vertices();
            }),
            (Rule::Kind, |frame, _| {
                frame.executor.gas_traversable_handle();
            }),
            (Rule::Kind, |frame, _| {
                frame.executor.transform_list_size();
            }),
            (Rule::Kind, |frame, _| {
                frame.executor.object_to_world();
            }),
            (Rule::Held, |frame, gas| {
                frame.executor.instance_traversable_from_ias(gas, 0);
            }),
            (Rule::InstanceHandle, |frame, _| {
                frame.executor.instance(0);
            }),
            (Rule::TriangleIndex, |frame, gas| {
                frame.executor.triangle_vertices_from_handle(gas, 1, 0);
            }),
            (Rule::Held, |frame, _| {
                frame.executor.triangle_vertices_from_handle(u64::MAX, 0, 0);
            }),
            (Rule::Index, |_, _| {
                Slice::<u32>::EMPTY.get(0);
            }),
            (Rule::Panic, |_, _| std::panic::resume_unwind(Box::new("out of rays"))),
        ]
    }
}

#[test]
fn reported_hits() {
    let program = "__intersection__test";
    traps(true, |s| s.report.1 = 128, program, Rule::HitKind, &["hit kind 128"]);
    traps(true, |s| s.report.0 = f32::NAN, program, Rule::HitNan, &["t = NaN"]);
    traps(true, |s| s.report.0 = 0.5, program, Rule::OutsideBox, &["t = 0.5, outside of the primitive's box"]);
    // Outside of the interval it is no hit.
    let mut behind = lawful(true);
    (behind.report.0, behind.call.ray.tmin) = (0.5, 1.0);
    assert_eq!(run(true, true, behind), None);
}

#[test]
fn payload_fields_that_nobody_wrote() {
    // The closest-hit program takes a field that only any-hit gives, and any-hit is off.
    let change = |s: &mut Script| {
        s.anyhit_gives = &[2];
        s.closesthit_takes = &[0, 2];
        s.call.ray.flags = RayFlags::NONE.any_hit(AnyHitMode::Disable);
    };
    traps(
        false,
        change,
        "__closesthit__test",
        Rule::PayloadUnwritten,
        &["payload field `Radiance::hits` (word 2) is read"],
    );
    // With any-hit it is lawful.
    let mut given = lawful(false);
    (given.anyhit_gives, given.closesthit_takes) = (&[2], &[2]);
    assert_eq!(run(false, true, given), None);
}

#[test]
fn payload_fields_that_come_back_unwritten() {
    // Closest-hit and miss give the field, and the ray runs neither.
    let change = |s: &mut Script| {
        (s.closesthit_gives, s.miss_gives, s.call.caller_reads) = (&[3], &[3], &[3]);
        // SAFETY: one flag excludes none.
        s.call.ray.flags = unsafe { RayFlags::from_bits(8) };
    };
    traps(
        false,
        change,
        "__raygen__test",
        Rule::PayloadUnwritten,
        &["payload field `Radiance::light` (words 3 to 4)", "comes back"],
    );
    for towards in [Vec3::NEG_Z, Vec3::Z] {
        let mut given = lawful(false);
        change(&mut given);
        given.call.ray = Ray::new(given.call.ray.origin, towards);
        assert_eq!(run(false, true, given), None);
    }
}

/// These would read outside of tables, so they are trapped in either mode.
#[test]
fn records_and_depth() {
    for checked in [false, true] {
        let mut outside = lawful(false);
        outside.call.sbt_offset = 2;
        let (rule, message) = run(false, checked, outside).unwrap();
        assert!(message.contains("record 2 of the hit-group table, which has 2"), "{message}");
        assert_eq!(rule, Rule::HitRecord);

        let mut deep = lawful(false);
        deep.nested = 1;
        assert_eq!(run(false, checked, deep), None);
        deep.nested = 2;
        let (rule, message) = run(false, checked, deep).unwrap();
        assert!(rule == Rule::TraceDepth && message.contains("trace depth of 2"), "{message}");
        assert!(message.contains("__closesthit__test"), "{message}");

        let mut nowhere = lawful(false);
        nowhere.call.ray.direction = Vec3::Z;
        nowhere.call.miss_index = 1;
        let (rule, message) = run(false, checked, nowhere).unwrap();
        assert!(rule == Rule::MissRecord && message.contains("no miss record 1: the pipeline has 1"), "{message}");
    }
}

/// So are these: a call of another function than the caller means, or calls without end.
#[test]
fn callables() {
    for checked in [false, true] {
        let run = |callable| run(false, checked, Script { callable, ..lawful(false) });
        assert_eq!(run(Called::Record(CALLABLE, true)), None);
        // The index of its record is not its number.
        let (rule, message) = run(Called::Record(0, true)).unwrap();
        assert!(rule == Rule::CallableRecord && message.contains("kept from another launch"), "{message}");
        let (rule, message) = run(Called::Record(CALLABLE, false)).unwrap();
        assert!(rule == Rule::CallableSignature && message.contains("__direct_callable__test"), "{message}");
        assert_eq!(run(Called::Nested(2)), None);
        let (rule, message) = run(Called::Nested(3)).unwrap();
        assert_eq!(rule, Rule::CallableDepth);
        assert!(message.contains("3 levels") && message.contains("callable_depth"), "{message}");
    }
}

/// Deeper than the thread's stack, whatever the plan allows.
#[test]
fn stacks_that_are_used_up() {
    let depths = Depths { trace: u32::MAX, direct_from_state: u32::MAX, ..PLANNED.depths };
    let endless = Planned { depths, ..PLANNED };
    let in_thread = |script, planned| {
        let run = move || run_planned(false, false, script, planned);
        std::thread::Builder::new().stack_size(512 << 10).spawn(run).unwrap().join().unwrap()
    };
    let mut traces = lawful(false);
    traces.nested = 1_000_000;
    let calls = Script { callable: Called::Nested(1_000_000), ..lawful(false) };
    for (script, program) in [(traces, "__closesthit__test"), (calls, "__direct_callable__test")] {
        let Outcome::Trapped(rule, message) = in_thread(script, endless) else { panic!("there is no such stack") };
        assert_eq!(rule, Rule::Stack);
        assert!(message.contains("stack") && message.contains(program) && message.contains("[3, 1, 0]"), "{message}");
        let exceptions = Exceptions { stack_overflow: true, ..PLANNED.exceptions };
        let Outcome::Thrown(what) = in_thread(script, Planned { exceptions, ..endless }) else {
            panic!("no exception")
        };
        assert!(what[0].contains("stack overflow (code -1)") && what[0].contains(program), "{what:?}");
    }
    // The declared depth fits into a small stack.
    traces.nested = 30;
    let declared = Depths { trace: 31, ..PLANNED.depths };
    assert_eq!(in_thread(traces, Planned { depths: declared, ..PLANNED }), Outcome::Done);
}
