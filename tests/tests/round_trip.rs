//! Values of every type that can travel arrive bit for bit, whichever way they go: launch parameters, records, payloads in
//! registers and by pointer, attributes. On the CPU, and on OptiX where it is there.

use glam::*;
use optix_device_rs::prelude::Words;
use optix_device_rs::rng::Pcg32;
use optix_host::{Aabb, Buffer, Buffer2d, CustomPrimitives, Device, Pipeline, Scene, World};
use optix_tests::devices;
use round_trip_shaders::cargo::*;
use round_trip_shaders::hits::{self, HITS, Hits};
use round_trip_shaders::rays::{self, STATIONS, There, WAYS};
use round_trip_shaders::{ROW, TripHost};

const PTX: &str = optix_host::ptx!(round_trip_shaders);

/// What the views show, and what the programs write to.
struct Memory {
    slice: Buffer<u32>,
    slice_mut: Buffer<u32>,
    film: Buffer2d<f32>,
    out: Buffer<u32>,
}

impl Memory {
    fn new(device: &Device, rows: usize) -> Self {
        Self {
            slice: device.buffer(&[1, 2, 3]).unwrap(),
            slice_mut: device.zeroed(5).unwrap(),
            film: device.zeroed_2d([3, 2]).unwrap(),
            // What nobody writes stands out.
            out: device.buffer(&vec![0xdead_beef; rows * ROW]).unwrap(),
        }
    }
}

/// Any bits, and every so often those that are easily lost: not-a-numbers with a payload, signs of zero, subnormals.
struct Bits(Pcg32);

impl Bits {
    fn word(&mut self) -> u32 {
        match self.0.next_u32() % 4 {
            0 => [0, !0, 0x8000_0000, 0x7fc0_1234, 0xff80_0001, 1, 0x8000, 0x00ff_ff00][self.0.next_u32() as usize % 8],
            _ => self.0.next_u32(),
        }
    }
    fn u64(&mut self) -> u64 {
        u64::from(self.word()) << 32 | u64::from(self.word())
    }
    fn u16s<const N: usize>(&mut self) -> [u16; N] {
        std::array::from_fn(|_| self.word() as u16)
    }
    fn i16s<const N: usize>(&mut self) -> [i16; N] {
        std::array::from_fn(|_| self.word() as i16)
    }
    fn u32s<const N: usize>(&mut self) -> [u32; N] {
        std::array::from_fn(|_| self.word())
    }
    fn i32s<const N: usize>(&mut self) -> [i32; N] {
        self.u32s().map(u32::cast_signed)
    }
    fn f32s<const N: usize>(&mut self) -> [f32; N] {
        self.u32s().map(f32::from_bits)
    }
    fn f64s<const N: usize>(&mut self) -> [f64; N] {
        std::array::from_fn(|_| f64::from_bits(self.u64()))
    }
    fn bool(&mut self) -> bool {
        self.word() & 1 == 1
    }
    fn inner(&mut self) -> Inner {
        Inner { half: self.word() as u16, whole: f64::from_bits(self.u64()), last: self.word() as u8 }
    }

    fn cargo(&mut self, memory: &Memory) -> CargoHost {
        let views =
            ViewsHost { slice: memory.slice.clone(), slice_mut: memory.slice_mut.clone(), film: memory.film.clone() };
        CargoHost {
            numbers: Numbers {
                u8: self.word() as u8,
                f64: f64::from_bits(self.u64()),
                u16: self.word() as u16,
                u64: self.u64(),
                i8: self.word() as i8,
                i64: self.u64().cast_signed(),
                i16: self.word() as i16,
                char: char::from_u32(self.word() % 0x11_0000).unwrap_or('\u{10ffff}'),
                bool: self.bool(),
                f32: f32::from_bits(self.word()),
                u32: self.word(),
                i32: self.word().cast_signed(),
            },
            nested: Nested {
                half: self.word() as i16,
                inner: self.inner(),
                flags: [self.bool(), self.bool(), self.bool()],
                inners: [self.inner(), self.inner()],
            },
            floats: Floats {
                vec2: Vec2::from_array(self.f32s()),
                vec3: Vec3::from_array(self.f32s()),
                vec3a: Vec3A::from_array(self.f32s()),
                vec4: Vec4::from_array(self.f32s()),
                quat: Quat::from_array(self.f32s()),
                mat2: Mat2::from_cols_array(&self.f32s()),
                affine2: Affine2::from_cols_array(&self.f32s()),
            },
            matrices: Matrices {
                mat3: Mat3::from_cols_array(&self.f32s()),
                mat3a: Mat3A::from_cols_array(&self.f32s()),
                affine3a: Affine3A::from_cols_array(&self.f32s()),
            },
            doubles: Doubles {
                vec2: DVec2::from_array(self.f64s()),
                vec3: DVec3::from_array(self.f64s()),
                vec4: DVec4::from_array(self.f64s()),
                quat: DQuat::from_array(self.f64s()),
            },
            integers: Integers {
                uvec2: UVec2::from_array(self.u32s()),
                uvec3: UVec3::from_array(self.u32s()),
                uvec4: UVec4::from_array(self.u32s()),
                ivec2: IVec2::from_array(self.i32s()),
                ivec3: IVec3::from_array(self.i32s()),
                ivec4: IVec4::from_array(self.i32s()),
                u16vec2: U16Vec2::from_array(self.u16s()),
                u16vec3: U16Vec3::from_array(self.u16s()),
                u16vec4: U16Vec4::from_array(self.u16s()),
                i16vec4: I16Vec4::from_array(self.i16s()),
            },
            large: Large {
                mat4: Mat4::from_cols_array(&self.f32s()),
                dmat2: DMat2::from_cols_array(&self.f64s()),
                dmat3: DMat3::from_cols_array(&self.f64s()),
                dmat4: DMat4::from_cols_array(&self.f64s()),
                daffine2: DAffine2::from_cols_array(&self.f64s()),
                daffine3: DAffine3::from_cols_array(&self.f64s()),
                i16vec2: I16Vec2::from_array(self.i16s()),
                i16vec3: I16Vec3::from_array(self.i16s()),
                array: [self.u16s(), self.u16s(), self.u16s(), self.u16s(), self.u16s()],
            },
            views,
        }
    }
}

fn frame(memory: &Memory, world: &World, cargo: &CargoHost) -> TripHost {
    let CargoHost { numbers, nested, floats, matrices, doubles, integers, large, views } = cargo.clone();
    let (out, world) = (memory.out.clone(), world.clone());
    TripHost { out, world, numbers, nested, floats, matrices, doubles, integers, large, views }
}

fn words<T: Words>(value: T) -> Vec<u32> {
    let mut words = vec![0; T::COUNT];
    value.store(&mut words);
    words
}

/// A box around the origin of each of these places.
fn boxes(places: impl Iterator<Item = Vec3>) -> Vec<Aabb> {
    places.map(|at| Aabb { min: at - 1.0, max: at + 1.0 }).collect()
}

/// Sends a cargo on every way of the payloads.
fn by_payload(device: &Device, bits: &mut Bits) {
    let memory = Memory::new(device, WAYS * STATIONS);
    let mut scene = Scene::<There>::new(device);
    let boxes = scene.geometry(CustomPrimitives::new(&boxes([Vec3::ZERO].into_iter()))).unwrap();
    let cargo = bits.cargo(&memory);
    let material = scene.material(cargo.clone()).unwrap();
    let world = scene.gas([boxes.with(&material)]).build().unwrap().world().unwrap();
    let pipeline = Pipeline::for_scene(&scene).ptx(PTX).build().unwrap();
    let frame = frame(&memory, &world, &cargo);
    macro_rules! launch {
        ($($way:ident)*) => {$(
            pipeline.launch_program::<rays::$way::start>(&frame, [1, 1, 1]).unwrap().wait().unwrap();
        )*};
    }
    launch!(small floats matrices doubles integers optional addresses everything);

    let out = memory.out.read().unwrap();
    let rows: Vec<&[u32]> = out.chunks_exact(ROW).collect();
    let name = device.name();
    for (way, rows) in rows.chunks_exact(STATIONS).enumerate() {
        for (station, row) in rows.iter().enumerate() {
            assert_eq!(*row, rows[0], "way {way}, station {station}, {name}");
        }
    }
    // What the parameters said, against what the host said.
    let said = [
        words((cargo.numbers, cargo.nested)),
        words(cargo.floats),
        words(cargo.matrices),
        words(cargo.doubles),
        words(cargo.integers),
    ];
    for (way, words) in said.iter().enumerate() {
        assert_eq!(rows[way * STATIONS][..words.len()], **words, "way {way}, {name}");
    }
    let all = [said.concat(), words(cargo.large)].concat();
    assert_eq!(rows[7 * STATIONS][..all.len()], *all, "{name}");
}

/// Sends a cargo through attributes of all kinds.
fn by_attributes(device: &Device, bits: &mut Bits) {
    let memory = Memory::new(device, HITS * hits::STATIONS);
    let mut scene = Scene::<Hits>::new(device);
    let mut parts = Vec::new();
    macro_rules! materials {
        ($($hit:ident)*) => {$(
            let material = scene.material(hits::$hit::Material {}).unwrap();
            let place = hits::place(parts.len());
            parts.push(scene.geometry(CustomPrimitives::new(&boxes([place].into_iter()))).unwrap().with(&material));
        )*};
    }
    materials!(numbers wide nested floats quats maps doubles triples quadruples dquats integers signed halves
        more_halves options views more_views);
    assert_eq!(parts.len(), HITS);
    let world = scene.gas(parts).build().unwrap().world().unwrap();
    let cargo = bits.cargo(&memory);
    let pipeline = Pipeline::for_scene(&scene).ptx(PTX).build().unwrap();
    pipeline.launch(&frame(&memory, &world, &cargo), [HITS as u32, 1, 1]).unwrap().wait().unwrap();

    let out = memory.out.read().unwrap();
    let rows: Vec<&[u32]> = out.chunks_exact(ROW).collect();
    for (hit, rows) in rows.chunks_exact(hits::STATIONS).enumerate() {
        assert_ne!(rows[0][..8], [0xdead_beef; 8], "hit {hit}");
        for (station, row) in rows.iter().enumerate() {
            assert_eq!(row[..8], rows[0][..8], "hit {hit}, station {station}, {}", device.name());
        }
    }
    // What was reported, against what the host said.
    let Numbers { f32, u32, i32, u16, i16, u8, i8, bool, .. } = cargo.numbers;
    assert_eq!(rows[0][..8], *words((((f32, u32), (i32, u16)), ((i16, u8), (i8, bool)))));
    let dquats = rows[9 * hits::STATIONS];
    assert_eq!(dquats[..8], *words(cargo.doubles.quat));
}

/// How often: a pipeline on OptiX takes seconds to build.
fn times(device: &Device, cpu: usize) -> usize {
    if device.kind() == optix_host::BackendKind::Optix { 2 } else { cpu }
}

#[test]
fn payloads_records_and_parameters() {
    for device in devices::all("payloads_records_and_parameters") {
        let mut bits = Bits(Pcg32::new(1, 2));
        (0..times(&device, 64)).for_each(|_| by_payload(&device, &mut bits));
    }
}

#[test]
fn attributes() {
    for device in devices::all("attributes") {
        let mut bits = Bits(Pcg32::new(3, 4));
        (0..times(&device, 64)).for_each(|_| by_attributes(&device, &mut bits));
    }
}

#[test]
fn checked_mode_finds_nothing() {
    let device = Device::cpu_checked().unwrap();
    let mut bits = Bits(Pcg32::new(5, 6));
    by_payload(&device, &mut bits);
    by_attributes(&device, &mut bits);
}
