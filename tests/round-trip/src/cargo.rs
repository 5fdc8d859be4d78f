//! The values that travel.

use glam::*;
use optix_device_rs::prelude::{DeviceData, SbtRecord, Slice, SliceMut, SliceMut2d, Traversable, Words};

/// Numbers of every size, the halves before the wholes, so that there is padding.
#[derive(Clone, Copy, Debug, PartialEq, Words, DeviceData)]
#[repr(C)]
#[expect(missing_docs)]
pub struct Numbers {
    pub u8: u8,
    pub f64: f64,
    pub u16: u16,
    pub u64: u64,
    pub i8: i8,
    pub i64: i64,
    pub i16: i16,
    pub char: char,
    pub bool: bool,
    pub f32: f32,
    pub u32: u32,
    pub i32: i32,
}

/// A struct in a struct in a struct.
#[derive(Clone, Copy, Debug, PartialEq, Words, DeviceData)]
#[repr(C)]
#[expect(missing_docs)]
pub struct Nested {
    pub half: i16,
    pub inner: Inner,
    pub flags: [bool; 3],
    pub inners: [Inner; 2],
}

/// Half, padding, whole.
#[derive(Clone, Copy, Debug, PartialEq, Words, DeviceData)]
#[repr(C)]
#[expect(missing_docs)]
pub struct Inner {
    pub half: u16,
    pub whole: f64,
    pub last: u8,
}

/// Vectors and small matrices of `f32`.
#[derive(Clone, Copy, Debug, PartialEq, Words, DeviceData)]
#[repr(C)]
#[expect(missing_docs)]
pub struct Floats {
    pub vec2: Vec2,
    pub vec3: Vec3,
    pub vec3a: Vec3A,
    pub vec4: Vec4,
    pub quat: Quat,
    pub mat2: Mat2,
    pub affine2: Affine2,
}

/// Matrices of `f32`.
#[derive(Clone, Copy, Debug, PartialEq, Words, DeviceData)]
#[repr(C)]
#[expect(missing_docs)]
pub struct Matrices {
    pub mat3: Mat3,
    pub mat3a: Mat3A,
    pub affine3a: Affine3A,
}

/// Vectors of `f64`.
#[derive(Clone, Copy, Debug, PartialEq, Words, DeviceData)]
#[repr(C)]
#[expect(missing_docs)]
pub struct Doubles {
    pub vec2: DVec2,
    pub vec3: DVec3,
    pub vec4: DVec4,
    pub quat: DQuat,
}

/// Vectors of integers.
#[derive(Clone, Copy, Debug, PartialEq, Words, DeviceData)]
#[repr(C)]
#[expect(missing_docs)]
pub struct Integers {
    pub uvec2: UVec2,
    pub uvec3: UVec3,
    pub uvec4: UVec4,
    pub ivec2: IVec2,
    pub ivec3: IVec3,
    pub ivec4: IVec4,
    pub u16vec2: U16Vec2,
    pub u16vec3: U16Vec3,
    pub u16vec4: U16Vec4,
    pub i16vec4: I16Vec4,
}

/// What is too large to go with others.
#[derive(Clone, Copy, Debug, PartialEq, Words, DeviceData)]
#[repr(C)]
#[expect(missing_docs)]
pub struct Large {
    pub mat4: Mat4,
    pub dmat2: DMat2,
    pub dmat3: DMat3,
    pub dmat4: DMat4,
    pub daffine2: DAffine2,
    pub daffine3: DAffine3,
    pub i16vec2: I16Vec2,
    pub i16vec3: I16Vec3,
    pub array: [[u16; 3]; 5],
}

/// Views of device memory.
#[derive(Clone, Copy, Debug, Words, DeviceData)]
#[repr(C)]
#[expect(missing_docs)]
pub struct Views {
    pub slice: Slice<u32>,
    pub slice_mut: SliceMut<u32>,
    pub film: SliceMut2d<f32>,
}

/// All of these: what a parameter struct and a record hold.
#[derive(Clone, Copy, Debug, Words, SbtRecord)]
#[repr(C)]
#[expect(missing_docs)]
pub struct Cargo {
    pub numbers: Numbers,
    pub nested: Nested,
    pub floats: Floats,
    pub matrices: Matrices,
    pub doubles: Doubles,
    pub integers: Integers,
    pub large: Large,
    #[view]
    pub views: Views,
}

/// Values that have no layout in memory, only words.
#[derive(Clone, Copy, Debug, PartialEq, Words)]
#[expect(missing_docs)]
pub struct Optional {
    pub some: Option<u64>,
    pub none: Option<Vec3>,
    pub pair: (u8, f64),
    pub list: [Option<u8>; 3],
    pub deep: Option<(i16, [Option<f32>; 2])>,
    pub nothing: (),
}

/// Views, raw pointers, and a traversable, which a record can't hold of its own scene: that is built after it.
#[derive(Clone, Copy, Debug, Words)]
#[expect(missing_docs)]
pub struct Addresses {
    pub views: Views,
    pub world: Traversable,
    pub read: *const u32,
    pub write: *mut u32,
    pub none: Option<*const Vec3>,
}

/// All there is.
#[derive(Clone, Copy, Debug, Words)]
#[expect(missing_docs)]
pub struct Everything {
    pub cargo: Cargo,
    pub optional: Optional,
    pub addresses: Addresses,
}

impl From<&Cargo> for Optional {
    fn from(cargo: &Cargo) -> Self {
        let Numbers { u8, f64, u64, i16, f32, bool, .. } = cargo.numbers;
        Self {
            some: Some(u64),
            none: None,
            pair: (u8, f64),
            list: [Some(u8), None, bool.then_some(!u8)],
            deep: Some((i16, [None, Some(f32)])),
            nothing: (),
        }
    }
}

impl Addresses {
    /// From what parameters and records hold.
    pub fn new(cargo: &Cargo, world: Traversable) -> Self {
        let address = cargo.numbers.u64 as usize;
        let read = core::ptr::without_provenance(address);
        let write = core::ptr::without_provenance_mut(!address);
        Self { views: cargo.views, world, read, write, none: None }
    }
}

impl Everything {
    /// From what parameters and records hold.
    pub fn new(cargo: &Cargo, world: Traversable) -> Self {
        Self { cargo: *cargo, optional: cargo.into(), addresses: Addresses::new(cargo, world) }
    }
}
