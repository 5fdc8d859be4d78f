//! What the macros make: layouts, semantics, twins, words, and programs that run on a frame.

use optix_device_rs::host::{DeviceId, HostData, KeepAlive, World};
use optix_device_rs::payload::{Part, semantics::*};
use optix_device_rs::pipeline::{HasHitGroup, HasRay, HasRayGen};
use optix_device_rs::prelude::*;
use optix_device_rs::primitive::PrimitiveType;
use optix_device_rs::words::WordBuffer;
use std::sync::Arc;

#[derive(Clone, Copy, Debug, PartialEq, DeviceData)]
#[repr(C)]
pub struct Pinhole {
    pub flags: u8,
    pub eye: Vec3,
}

#[launch_params]
#[derive(Debug, PartialEq)]
pub struct Settings {
    pub on: bool,
    #[bound]
    pub r#type: u32,
    pub camera: Pinhole,
    pub table: [u16; 3],
    #[bound]
    pub scale: f32,
}

#[launch_params]
pub struct Frame {
    pub on: bool,
    pub worlds: [Traversable; 2],
    #[bound]
    pub depth: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Words)]
pub struct Spectrum {
    pub bands: [f32; 3],
    pub first: u16,
    pub id: u64,
    pub valid: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Words)]
pub struct Pair(pub f64, pub Spectrum);

#[derive(Clone, Copy, Debug, PartialEq, Words)]
pub struct Nothing;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub seed: u64,
    #[payload(write(caller, anyhit, intersection), read(anyhit, intersection, miss, caller))]
    pub r#mod: u16,
}

/// All of the registers.
#[derive(Payload)]
pub struct Full {
    #[payload(write(caller), read(closesthit))]
    pub words: [u32; 32],
}

/// None of them.
#[derive(Payload)]
pub struct Probe {}

#[derive(Clone, Copy, Debug, PartialEq, Attributes)]
pub struct BallHit {
    pub normal: Vec3,
    pub uv: Vec2,
    pub part: u8,
}

#[derive(Clone, Copy, Element, Debug, PartialEq)]
#[repr(C)]
pub struct Vertex {
    pub position: Vec3,
    pub weights: [f32; 2],
    pub id: u32,
}

#[derive(Clone, Copy, SbtRecord, Debug, PartialEq)]
#[repr(C)]
pub struct Paint {
    pub glossy: bool,
    pub colour: Vec3,
    pub vertex: Vertex,
}

#[derive(Clone, Copy, DeviceData)]
#[repr(C)]
pub struct Portal {
    pub into: Traversable,
    pub tint: Vec3,
}

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Window {
    pub opacity: f32,
    #[view]
    pub portal: Portal,
    pub both: [Traversable; 2],
}

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Marker;

fn bytes_of<T: DeviceData>(value: &T) -> Vec<u8> {
    let mut bytes = vec![0; size_of::<T>()];
    value.write_to(&mut bytes);
    bytes
}

fn keep_alive() -> KeepAlive {
    // SAFETY: nothing is read through the views of these tests.
    unsafe { KeepAlive::new() }
}

fn world(handle: u64) -> World {
    // SAFETY: no launch sees it.
    unsafe { World::new(handle, DeviceId(7), Arc::new(()), Arc::new(())) }
}

#[test]
fn parameter_fields_have_c_offsets() {
    let fields: Vec<_> = Settings::FIELDS.iter().map(|f| (f.name, f.offset, f.size, f.bound)).collect();
    assert_eq!(
        fields,
        [
            ("on", 0, 1, false),
            ("type", 4, 4, true),
            ("camera", 8, 16, false),
            ("table", 24, 6, false),
            ("scale", 32, 4, true)
        ]
    );
    assert_eq!(Settings::TYPE.field(), Settings::FIELDS[1]);
    assert_eq!(Settings::SCALE.field(), Settings::FIELDS[4]);
    assert_eq!(Settings::NAME, "Settings");
    assert_eq!(size_of::<Settings>(), 36);
    assert!(Settings::SYMBOL.starts_with("optix_params_Settings_"));
    assert_ne!(Settings::SYMBOL, Frame::SYMBOL);
}

#[test]
fn a_second_module_may_use_the_same_names() {
    mod other {
        use optix_device_rs::prelude::*;
        #[launch_params]
        pub struct Frame {
            pub depth: u32,
        }
    }
    assert_ne!(other::Frame::SYMBOL, Frame::SYMBOL);
}

#[test]
fn data_is_written_at_its_offsets_with_zero_padding() {
    let settings = Settings {
        on: true,
        r#type: 0x01020304,
        camera: Pinhole { flags: 9, eye: Vec3::new(1.0, 2.0, 3.0) },
        table: [1, 2, 0xffff],
        scale: -0.5,
    };
    let mut expected = vec![1, 0, 0, 0, 4, 3, 2, 1, 9, 0, 0, 0];
    for value in [1.0f32, 2.0, 3.0] {
        expected.extend(value.to_le_bytes());
    }
    expected.extend([1, 0, 2, 0, 0xff, 0xff, 0, 0]);
    expected.extend((-0.5f32).to_le_bytes());
    assert_eq!(bytes_of(&settings), expected);
    assert_eq!(settings.lower(&mut keep_alive()), settings);
}

#[test]
fn twins_lower_to_views_and_keep_their_owners() {
    let host = WindowHost {
        opacity: 0.25,
        portal: PortalHost { into: world(11), tint: Vec3::Y },
        both: [world(12), world(13)],
    };
    let mut keep = keep_alive();
    let device = host.clone().lower(&mut keep);
    assert_eq!(device.opacity, 0.25);
    assert_eq!(device.portal.into.to_raw(), 11);
    assert_eq!(device.portal.tint, Vec3::Y);
    assert_eq!(device.both.map(Traversable::to_raw), [12, 13]);
    assert!(keep.foreign(DeviceId(7)).is_none());
    assert!(keep.foreign(DeviceId(8)).is_some());
    assert_eq!(keep.kept().len(), 3);

    let frame = FrameHost { on: true, worlds: [world(1), world(2)], depth: 5 };
    let device = frame.lower(&mut keep_alive());
    assert_eq!((device.on, device.depth), (true, 5));
    assert_eq!(bytes_of(&device)[..16], [1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0]);
    assert_eq!((Window::NAME, Paint::NAME, Marker::NAME), ("Window", "Paint", "Marker"));
    assert!(bytes_of(&Marker).is_empty());
}

#[test]
fn semantics_are_one_word_per_register() {
    let light = CALLER_READ | CLOSESTHIT_WRITE | MISS_WRITE;
    let seed = CALLER_READ | CALLER_WRITE | CLOSESTHIT_READ | CLOSESTHIT_WRITE;
    let mode =
        CALLER_READ | CALLER_WRITE | ANYHIT_READ | ANYHIT_WRITE | INTERSECTION_READ | INTERSECTION_WRITE | MISS_READ;
    assert_eq!(Radiance::SEMANTICS, [light, light, light, seed, seed, mode]);
    assert_eq!((Radiance::WORDS, Full::WORDS, Probe::WORDS), (6, 32, 0));
    assert_eq!(Full::SEMANTICS, [CALLER_WRITE | CLOSESTHIT_READ; 32]);
    assert_eq!(Probe::SEMANTICS, [0u32; 0]);
}

#[test]
fn parts_cover_their_fields() {
    assert_eq!(RadianceFromCaller::MASK, 0b111000);
    assert_eq!(RadianceAtCaller::MASK, 0b111111);
    assert_eq!(RadianceAtClosestHit::MASK, 0b011000);
    assert_eq!(RadianceFromClosestHit::MASK, 0b011111);
    assert_eq!(RadianceAtMiss::MASK, 0b100000);
    assert_eq!(RadianceFromMiss::MASK, 0b000111);
    assert_eq!(RadianceAtAnyHit::MASK, 0b100000);
    assert_eq!(RadianceFromIntersection::MASK, 0b100000);
    assert_eq!(FullFromCaller::MASK, u32::MAX);
    assert_eq!(<<Full as Payload>::AtMiss as Part>::MASK, 0);
    let mut words = WordBuffer([7; 32]);
    RadianceFromClosestHit { light: Vec3::new(1.0, 2.0, 3.0), seed: 1 << 40 | 5 }.store(&mut words.0);
    assert_eq!(words.0[..7], [0x3f80_0000, 0x4000_0000, 0x4040_0000, 5, 256, 7, 7]);
    // SAFETY: the field was stored with the other part.
    let at = unsafe { RadianceAtClosestHit::load(&words.0) };
    assert_eq!(at.seed, 1 << 40 | 5);
}

/// The guide's two rules (8.4.2.1), and its silence about intersection programs, for each combination of a word's bits.
#[test]
fn semantics_widen_where_the_caller_comes_between() {
    for word in 0..1 << 10 {
        let read = word & (CLOSESTHIT_READ | MISS_READ) != 0;
        let [at_traverse] = at_traverse([word]);
        assert_eq!(at_traverse, if read { word | CALLER_READ } else { word });
        let written = word & (ANYHIT_WRITE | INTERSECTION_WRITE) != 0;
        let [at_invoke] = at_invoke([word]);
        assert_eq!(at_invoke, if written { word | CALLER_WRITE } else { word });
    }
    let light = CLOSESTHIT_WRITE | MISS_WRITE | CALLER_READ;
    assert_eq!(Radiance::SEMANTICS_AT_TRAVERSE[0], light);
    assert_eq!(Radiance::SEMANTICS_AT_TRAVERSE[3], Radiance::SEMANTICS[3] | CALLER_READ);
    assert_eq!(Radiance::SEMANTICS_AT_INVOKE[5], Radiance::SEMANTICS[5] | CALLER_WRITE);
}

/// Too many words for registers, of which the parties get the address.
#[derive(Payload)]
#[payload(transport = pointer)]
pub struct Wide {
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub matrices: [Mat4; 3],
    #[payload(write(closesthit, miss), read(caller))]
    pub frame: [f64; 4],
    #[payload(write(caller), read(anyhit))]
    pub seed: u32,
}

#[test]
fn a_payload_in_memory_has_two_registers() {
    assert_eq!((Wide::WORDS, Wide::SEMANTICS.len(), Wide::FIELDS[1].at), (57, 2, 48));
    assert_eq!(Wide::SEMANTICS, [CALLER_WRITE | CLOSESTHIT_READ | MISS_READ | ANYHIT_READ; 2]);
    let description = Wide::DESCRIPTION;
    assert_eq!((description.memory_words, description.fields.len()), (57, 3));
    assert_eq!(Radiance::DESCRIPTION.memory_words, 0);
}

/// A deterministic stream of bits, which also has the awkward values.
fn bits() -> impl Iterator<Item = u64> {
    let mut rng = optix_device_rs::rng::Pcg32::new(3, 5);
    [0, u64::MAX, 0x7fc0_0001_7fc0_0001, 0x8000_0000_8000_0000, 1]
        .into_iter()
        .chain((0..2000).map(move |_| (rng.next_u32() as u64) << 32 | rng.next_u32() as u64))
}

#[test]
fn words_round_trip_bit_for_bit_and_touch_nothing_else() {
    assert_eq!((Spectrum::COUNT, Pair::COUNT, Nothing::COUNT), (7, 9, 0));
    for (i, b) in bits().enumerate() {
        let float = f32::from_bits(b as u32);
        let value = Pair(
            f64::from_bits(b),
            Spectrum { bands: [float, 1.0, -float], first: b as u16, id: b.rotate_left(17), valid: b & 1 == 1 },
        );
        let at = i % (32 - Pair::COUNT);
        let mut words = WordBuffer([0xdead_beef; 32]);
        let place = at..at + Pair::COUNT;
        value.store(&mut words.0[place.clone()]);
        // SAFETY: stored in the line above.
        let back = unsafe { Pair::load(&words.0[place]) };
        assert_eq!(back.0.to_bits(), value.0.to_bits());
        assert_eq!(back.1.bands.map(f32::to_bits), value.1.bands.map(f32::to_bits));
        assert_eq!((back.1.first, back.1.id, back.1.valid), (value.1.first, value.1.id, value.1.valid));
        let outside = words.0.iter().enumerate().filter(|(j, _)| !(at..at + Pair::COUNT).contains(j));
        assert!(outside.into_iter().all(|(_, w)| *w == 0xdead_beef));
    }
}

#[test]
fn attributes_round_trip() {
    assert_eq!((BallHit::WORDS, BallHit::NAME), (6, "BallHit"));
    for b in bits() {
        let f = (b >> 40) as f32;
        let hit = BallHit { normal: Vec3::new(f, -f, 0.5), uv: Vec2::splat(f), part: b as u8 };
        let mut words = WordBuffer::ZERO;
        hit.store(&mut words.0);
        // SAFETY: stored in the line above.
        assert_eq!(unsafe { BallHit::load(&words.0) }, hit);
        assert!(words.0[6..].iter().all(|w| *w == 0));
    }
}

// ---- Programs -----------------------------------------------------------------------------------------------------

mod library {
    //! Programs for other people's pipelines.
    use super::*;

    #[closesthit]
    pub fn paint<P, A>(hit: &ClosestHit<P, A>, record: &Paint, ray: RadianceAtClosestHit) -> RadianceFromClosestHit
    where
        P: Pipeline<Params = Settings>,
        A: Attributes,
    {
        RadianceFromClosestHit { light: record.colour * hit.params().scale(), seed: ray.seed + 1 }
    }

    #[anyhit]
    pub fn never<P: Pipeline, A: Attributes>(_: &AnyHit<P, A>) -> (Decision, RadianceFromAnyHit) {
        (Decision::Ignore, RadianceFromAnyHit { r#mod: 77 })
    }

    #[anyhit]
    pub fn always<P: Pipeline, A: Attributes>(_: &AnyHit<P, A>) -> (Decision, ()) {
        (Decision::Accept, ())
    }

    #[miss]
    pub fn count<P: Pipeline>(_: &Miss<P>, ray: RadianceAtMiss) -> RadianceFromMiss {
        RadianceFromMiss { light: Vec3::splat(ray.r#mod as f32) }
    }
}

#[raygen]
fn camera(rg: &RayGen<Tracer>, record: &Paint) {
    assert!(rg.params().on() && record.glossy);
    assert_eq!(rg.params().r#type(), 3);
    assert_eq!(rg.params().table(), [1, 2, 3]);
    assert_eq!(rg.params().camera().eye, Vec3::Z);
}

#[raygen]
fn r#loop(rg: &RayGen<Tracer>) {
    let ray = Ray::new(Vec3::ZERO, Vec3::X);
    let _ = rg.trace::<Radiance>(Traversable::NULL, ray, RadianceFromCaller { seed: 41, r#mod: 5 });
}

#[intersection]
fn ball(_: &Intersection<Tracer, BallHit>, _: &Marker, ray: RadianceAtIntersection) -> RadianceFromIntersection {
    RadianceFromIntersection { r#mod: ray.r#mod + 1 }
}

#[intersection]
fn ball_of_probe(_: &Intersection<Tracer, BallHit>) {}

#[closesthit]
fn full(_: &ClosestHit<Tracer, Triangles>, ray: FullAtClosestHit) {
    assert_eq!(ray.words[31], 31);
}

#[closesthit]
fn any_ray(_: &ClosestHit<Tracer, BallHit>) {}

pipeline! {
    /// All that the grammar has.
    pub struct Tracer {
        params: Settings,
        raygen: [camera, r#loop],
        rays: { Radiance { miss: library::count }, Full {}, Probe {} },
        hitgroups: {
            Paint on Triangles => {
                Probe {},
                Full { closesthit: full },
                Radiance { closesthit: self::library::paint, anyhit: library::never },
            },
            Paint on Custom => {
                Radiance { intersection: ball_any, closesthit: library::paint },
                Full { intersection: ball_of_probe },
                Probe { intersection: ball_of_probe, closesthit: any_ray, anyhit: library::always },
            },
            Marker on Custom => {
                Radiance { intersection: ball, closesthit: shade_marker },
                Full { intersection: ball_of_probe },
                Probe { intersection: ball_of_probe },
            },
        },
        trace_depth: 4,
    }
}

#[intersection]
fn ball_any(_: &Intersection<Tracer, BallHit>, ray: RadianceAtIntersection) -> RadianceFromIntersection {
    RadianceFromIntersection { r#mod: ray.r#mod }
}

#[closesthit]
fn shade_marker(_: &ClosestHit<Tracer, BallHit>, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
    RadianceFromClosestHit { light: Vec3::ZERO, seed: ray.seed }
}

#[test]
fn a_pipeline_describes_itself() {
    let description = Tracer::DESCRIPTION;
    assert_eq!((description.name, Tracer::RAY_TYPES, description.trace_depth), ("Tracer", 3, Some(4)));
    assert_eq!(description.params.symbol, Settings::SYMBOL);
    assert_eq!(<Tracer as HasRay<Full>>::INDEX, 1);
    assert_eq!(<Tracer as HasRay<Probe>>::PAYLOAD_TYPE, 4);
    assert_eq!(<Tracer as HasHitGroup<Marker, Custom>>::INDEX, 2);
    assert_eq!(<Tracer as HasRayGen<r#loop>>::INDEX, 1);
    let _: fn(<Tracer as HasRayGen<camera>>::Record) -> Paint = |record| record;

    assert_eq!(description.raygen[0].record.size, size_of::<Paint>());
    assert_eq!(description.raygen[1].record.size, 0);
    assert!(description.rays[0].miss.is_some() && description.rays[1].miss.is_none());
    assert_eq!(description.rays[0].payload.semantics, Radiance::SEMANTICS);
    let groups = description.hitgroups;
    assert_eq!(groups[0].geometry, PrimitiveType::Triangle);
    assert_eq!((groups[0].attribute_words, groups[1].attribute_words), (2, 6));
    // In the order of `rays`, not in the order written.
    let functions =
        |i: usize| groups[i].rays.iter().map(|r| r.closesthit.map_or("", |e| e.function)).collect::<Vec<_>>();
    assert_eq!(functions(0), ["self::library::paint", "full", ""]);
    assert_eq!(functions(1), ["library::paint", "", "any_ray"]);

    let mut names: Vec<_> = description.raygen.iter().map(|p| p.entry.name).collect();
    names.extend(description.rays.iter().filter_map(|r| r.miss).map(|p| p.entry.name));
    for ray in groups.iter().flat_map(|g| g.rays) {
        names.extend([ray.closesthit, ray.anyhit, ray.intersection].into_iter().flatten().map(|e| e.name));
    }
    assert_eq!(names.len(), 16);
    assert!(names.iter().all(|n| n.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_')));
    assert!(names[0].starts_with("__raygen__Tracer_camera_"));
    assert!(names[1].starts_with("__raygen__Tracer_loop_"));
    names.sort();
    names.dedup();
    assert_eq!(names.len(), 16);
}

/// Runs an entry on a frame; gives its decision and the payload, or with what it traced a ray.
fn run(entry: optix_device_rs::host::Entry, record: &Paint, payload: WordBuffer) -> (Decision, WordBuffer) {
    use optix_device_rs::host::{ExceptionState, Executor, Frame, HitState, Turn};
    use optix_device_rs::intrinsics::TraceCall;

    struct Alone<'a>(&'a std::cell::Cell<WordBuffer>);
    impl Executor for Alone<'_> {
        fn trace(&self, _: &TraceCall, payload: &mut WordBuffer) {
            self.0.set(*payload);
        }
    }

    let settings =
        Settings { on: true, r#type: 3, camera: Pinhole { flags: 0, eye: Vec3::Z }, table: [1, 2, 3], scale: 2.0 };
    let payload = std::cell::Cell::new(payload);
    let frame = Frame {
        executor: &Alone(&payload),
        launch_index: UVec3::ZERO,
        launch_dimensions: UVec3::ONE,
        params: std::ptr::NonNull::from(&settings).cast(),
        record: std::ptr::NonNull::from(record).cast(),
        payload: &payload,
        watch: None,
        ray: Ray::new(Vec3::ZERO, Vec3::X),
        object_ray: (Vec3::ZERO, Vec3::X),
        hit: HitState::NONE,
        exception: &ExceptionState::NONE,
        turn: Turn::default(),
    };
    // SAFETY: the frame's parameters are the pipeline's, and its record is a `Paint` wherever the program reads one.
    let decision = unsafe { entry.run(&frame) };
    (decision, frame.payload.get())
}

#[test]
fn entries_move_the_payload_in_and_out() {
    let description = Tracer::DESCRIPTION;
    let paint = Paint {
        glossy: true,
        colour: Vec3::new(1.0, 2.0, 3.0),
        vertex: Vertex { position: Vec3::ZERO, weights: [0.0; 2], id: 0 },
    };
    let mut payload = WordBuffer([9; 32]);
    RadianceFromCaller { seed: 41, r#mod: 5 }.store(&mut payload.0);
    // SAFETY: all of its fields are numbers, which any words are.
    let at_caller = |words: &WordBuffer| unsafe { RadianceAtCaller::load(&words.0) };

    let radiance = description.hitgroups[0].rays[0];
    let (decision, out) = run(radiance.closesthit.unwrap(), &paint, payload);
    let out_parts = at_caller(&out);
    assert_eq!((decision, out_parts.seed, out_parts.r#mod), (Decision::Accept, 42, 5));
    assert_eq!(out_parts.light, Vec3::new(2.0, 4.0, 6.0));
    assert!(out.0[6..].iter().all(|w| *w == 9));

    let (decision, out) = run(radiance.anyhit.unwrap(), &paint, payload);
    assert_eq!((decision, at_caller(&out).r#mod), (Decision::Ignore, 77));

    let marker = description.hitgroups[2].rays[0];
    let (_, out) = run(marker.intersection.unwrap(), &paint, payload);
    assert_eq!(at_caller(&out).r#mod, 6);

    let (_, out) = run(description.rays[0].miss.unwrap().entry, &paint, payload);
    assert_eq!(at_caller(&out).light, Vec3::splat(5.0));

    let (_, sent) = run(description.raygen[1].entry, &paint, payload);
    let written = RadianceFromCaller::MASK;
    for (i, word) in sent.0.into_iter().enumerate() {
        let poison = word == 0xffcd_cdcd;
        assert_eq!(poison, written >> i & 1 == 0, "word {i} is {word:#x}");
    }

    let words = std::array::from_fn(|i| i as u32);
    let _ = run(description.hitgroups[0].rays[1].closesthit.unwrap(), &paint, WordBuffer(words));
    let _ = run(description.raygen[0].entry, &paint, payload);
}

/// Has no `Debug`.
#[derive(Clone, Copy, Words)]
pub struct Opaque(u32);

#[derive(Payload)]
pub struct Shown {
    #[payload(write(caller), read(closesthit))]
    pub seed: u32,
    #[payload(write(caller), read(closesthit))]
    pub opaque: Opaque,
}

#[test]
fn parts_show_what_they_can() {
    let part = ShownFromCaller { seed: 7, opaque: Opaque(8) };
    assert_eq!(format!("{part:?}"), "ShownFromCaller { seed: 7, opaque: .. }");
}

macro_rules! several {
    ($($module:ident)*) => {$(
        mod $module {
            use optix_device_rs::prelude::*;

            #[launch_params]
            pub struct Only {
                pub film: SliceMut<u32>,
            }

            #[raygen]
            fn camera(_: &RayGen<Flat>) {}

            pipeline! {
                pub struct Flat {
                    params: Only,
                    raygen: [camera],
                }
            }
        }
    )*};
}
several! { first second third }

#[test]
fn what_a_macro_makes_several_times_has_names_of_its_own() {
    let of = [
        <first::Flat as Pipeline>::DESCRIPTION,
        <second::Flat as Pipeline>::DESCRIPTION,
        <third::Flat as Pipeline>::DESCRIPTION,
    ];
    for (i, one) in of.iter().enumerate() {
        for other in &of[..i] {
            assert_ne!(one.raygen[0].entry.name, other.raygen[0].entry.name);
            assert_ne!(one.params.symbol, other.params.symbol);
            assert_ne!(one.layouts, other.layouts);
        }
    }
}
