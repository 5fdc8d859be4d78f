//! Device functions on the device: OptiX intrinsics, called the way OptiX's PTX reader wants them.
//!
//! OptiX checks the register type of every argument and result, and LLVM keeps `f32` in untyped `.b32` registers; so
//! each asm block declares `.f32` registers of its own and moves the bits across. Names, order, register types and
//! volatility follow the public device headers of OptiX 9.0 as facts.

use super::TraceCall;
use crate::data::DeviceData;
use crate::params::LaunchParams;
use crate::words::WordBuffer;
use core::arch::asm;
use core::marker::PhantomData;
use core::mem::MaybeUninit;
use glam::{UVec3, Vec2, Vec3};

/// Ends the program.
#[inline(always)]
pub fn trap() -> ! {
    // SAFETY: `trap` ends the launch.
    unsafe { asm!("trap; exit;", options(noreturn, nomem)) }
}

/// The running program: no state, the intrinsics know.
#[derive(Clone, Copy)]
pub struct Cx(());

/// The launch's parameters: in constant memory, under a name that `P` knows.
pub struct ParamsBase<'a, P>(PhantomData<&'a P>);

impl<P> Clone for ParamsBase<'_, P> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}
impl<P> Copy for ParamsBase<'_, P> {}

/// The parameter field at byte `OFFSET`, by loads at constant addresses.
///
/// # Safety
/// `P` has a field of type `T` at `OFFSET`.
#[inline(always)]
pub unsafe fn load_param<P: LaunchParams, T: DeviceData, const OFFSET: usize>(_: ParamsBase<'_, P>) -> T {
    let mut value = MaybeUninit::<T>::uninit();
    let most = if T::UNIT >= 4 { 128 } else { 8 };
    if size_of::<T>() > most {
        // Large fields are read through a pointer; such loads can't be specialised.
        // SAFETY: the symbol is a valid `P`, which has a `T` at `OFFSET`.
        return unsafe { P::address().add(OFFSET).cast::<T>().read() };
    }
    macro_rules! load {
        ($unit:ident as $ty:ty: $($i:literal)*) => {
            if T::UNIT == size_of::<$ty>() {
                $(if size_of::<T>() > size_of::<$ty>() * $i {
                    let to = value.as_mut_ptr().cast::<$ty>();
                    // SAFETY: inside of `T`, whose size and alignment are multiples of `UNIT`.
                    unsafe { to.add($i).write(P::$unit::<OFFSET, $i>()) };
                })*
            }
        };
    }
    load!(long as u64: 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15);
    load!(word as u32: 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31);
    load!(half as u16: 0 1 2 3);
    load!(byte as u8: 0 1 2 3 4 5 6 7);
    // SAFETY: all bytes are written, from a valid `T`.
    unsafe { value.assume_init() }
}

/// A pure intrinsic without arguments that gives one 32-bit integer.
macro_rules! get_u32 {
    ($name:expr) => {{
        let value: u32;
        // SAFETY: a pure query of the running program, legal in the programs whose context offers it.
        unsafe {
            asm!(
                concat!("call ({v}), ", $name, ", ();"),
                v = out(reg32) value,
                options(pure, nomem, nostack, preserves_flags)
            )
        };
        value
    }};
}

/// A pure intrinsic without arguments that gives one `f32`.
macro_rules! get_f32 {
    ($name:expr) => {{
        let value: f32;
        // SAFETY: as for `get_u32`; the result register is `.f32`.
        unsafe {
            asm!(
                concat!("{{ .reg .f32 f; call (f), ", $name, ", (); mov.b32 {v}, f; }}"),
                v = out(reg32) value,
                options(pure, nomem, nostack, preserves_flags)
            )
        };
        value
    }};
}

macro_rules! get_vec3 {
    ($name:literal) => {
        Vec3::new(get_f32!(concat!($name, "_x")), get_f32!(concat!($name, "_y")), get_f32!(concat!($name, "_z")))
    };
}

/// Runs `$arm!([used] [unused])` for the number of payload or attribute words, which is a constant at every call.
macro_rules! by_count {
    ($arm:ident, $count:expr, [$($used:ident)*] []) => {
        $arm!($count, [$($used)*] [])
    };
    ($arm:ident, $count:expr, [$($used:ident)*] [$next:ident $($rest:ident)*]) => {
        $arm!($count, [$($used)*] [$next $($rest)*]);
        by_count!($arm, $count, [$($used)* $next] [$($rest)*])
    };
}

macro_rules! count {
    () => { 0 };
    ($first:ident $($rest:ident)*) => { 1 + count!($($rest)*) };
}

impl Cx {
    /// The context of an entry point.
    ///
    /// # Safety
    /// Called in an OptiX program of the kind whose context is made from it.
    #[inline(always)]
    pub unsafe fn new() -> Self {
        Self(())
    }

    #[inline(always)]
    pub fn params<P>(&self) -> ParamsBase<'_, P> {
        ParamsBase(PhantomData)
    }

    #[inline(always)]
    pub fn record(&self) -> *const u8 {
        let address: u64;
        // SAFETY: pure query.
        unsafe {
            asm!(
                "call ({a}), _optix_get_sbt_data_ptr_64, ();",
                a = out(reg64) address,
                options(pure, nomem, nostack, preserves_flags)
            )
        };
        address as *const u8
    }

    #[inline(always)]
    pub fn launch_index(&self) -> UVec3 {
        UVec3::new(
            get_u32!("_optix_get_launch_index_x"),
            get_u32!("_optix_get_launch_index_y"),
            get_u32!("_optix_get_launch_index_z"),
        )
    }

    #[inline(always)]
    pub fn launch_dimensions(&self) -> UVec3 {
        UVec3::new(
            get_u32!("_optix_get_launch_dimension_x"),
            get_u32!("_optix_get_launch_dimension_y"),
            get_u32!("_optix_get_launch_dimension_z"),
        )
    }

    #[inline(always)]
    pub fn trace(&self, call: &TraceCall, payload: WordBuffer) -> WordBuffer {
        let [
            mut p0,
            mut p1,
            mut p2,
            mut p3,
            mut p4,
            mut p5,
            mut p6,
            mut p7,
            mut p8,
            mut p9,
            mut p10,
            mut p11,
            mut p12,
            mut p13,
            mut p14,
            mut p15,
            mut p16,
            mut p17,
            mut p18,
            mut p19,
            mut p20,
            mut p21,
            mut p22,
            mut p23,
            mut p24,
            mut p25,
            mut p26,
            mut p27,
            mut p28,
            mut p29,
            mut p30,
            mut p31,
        ] = payload.0;
        let ray = &call.ray;
        // Registers of words the payload does not have are declared in the block and never read. No brace stands alone on
        // a line: to who reads the PTX, that is the end of an entry.
        macro_rules! arm {
            ($count:expr, [$($used:ident)*] [$($unused:ident)*]) => {
                if $count == count!($($used)*) {
                    // SAFETY: the caller's context may trace; the ray type gives matching type, offset, stride and index.
                    unsafe {
                        asm!(
                            "{{",
                            ".reg .f32 f<9>; .reg .b32 none;",
                            "mov.b32 f0, {ox}; mov.b32 f1, {oy}; mov.b32 f2, {oz};",
                            "mov.b32 f3, {dx}; mov.b32 f4, {dy}; mov.b32 f5, {dz};",
                            "mov.b32 f6, {tmin}; mov.b32 f7, {tmax}; mov.b32 f8, {time};",
                            "mov.b32 none, 0;",
                            concat!(
                                "call (",
                                arm!(@list [$($used)*] [$($unused)*]),
                                "), _optix_trace_typed_32, ({ty}, {handle}, f0, f1, f2, f3, f4, f5, f6, f7, f8, ",
                                "{mask}, {flags}, {offset}, {stride}, {miss}, {words}, ",
                                arm!(@list [$($used)*] [$($unused)*]),
                                "); }}"
                            ),
                            ty = in(reg32) call.payload_type,
                            handle = in(reg64) call.traversable,
                            ox = in(reg32) ray.origin.x,
                            oy = in(reg32) ray.origin.y,
                            oz = in(reg32) ray.origin.z,
                            dx = in(reg32) ray.direction.x,
                            dy = in(reg32) ray.direction.y,
                            dz = in(reg32) ray.direction.z,
                            tmin = in(reg32) ray.tmin,
                            tmax = in(reg32) ray.tmax,
                            time = in(reg32) ray.time,
                            mask = in(reg32) ray.mask as u32,
                            flags = in(reg32) ray.flags.bits(),
                            offset = in(reg32) call.sbt_offset,
                            stride = in(reg32) call.sbt_stride,
                            miss = in(reg32) call.miss_index,
                            words = in(reg32) $count as u32,
                            $($used = inlateout(reg32) $used,)*
                            options(nostack, preserves_flags)
                        )
                    };
                }
            };
            (@list [] [$first:ident $($unused:ident)*]) => {
                concat!("none" $(, arm!(@none $unused))*)
            };
            (@list [$first:ident $($used:ident)*] [$($unused:ident)*]) => {
                concat!("{", stringify!($first), "}" $(, ", {", stringify!($used), "}")* $(, arm!(@none $unused))*)
            };
            (@none $unused:ident) => { ", none" };
        }
        by_count!(arm, call.payload_words, [] [
            p0 p1 p2 p3 p4 p5 p6 p7 p8 p9 p10 p11 p12 p13 p14 p15
            p16 p17 p18 p19 p20 p21 p22 p23 p24 p25 p26 p27 p28 p29 p30 p31
        ]);
        WordBuffer([
            p0, p1, p2, p3, p4, p5, p6, p7, p8, p9, p10, p11, p12, p13, p14, p15, p16, p17, p18, p19, p20, p21, p22,
            p23, p24, p25, p26, p27, p28, p29, p30, p31,
        ])
    }

    #[inline(always)]
    pub fn set_payload_type(&self, mask: u32) {
        // SAFETY: first call of a program that has a payload.
        unsafe {
            asm!(
                "call _optix_set_payload_types, ({m});",
                m = in(reg32) mask,
                options(nostack, preserves_flags)
            )
        };
    }

    /// The payload words in `mask`; the others are zero.
    #[inline(always)]
    pub fn payload(&self, mask: u32) -> WordBuffer {
        let mut words = WordBuffer::ZERO;
        macro_rules! get {
            ($($i:literal)*) => {$(
                if mask & 1 << $i != 0 {
                    // SAFETY: the program's payload type has word `i` with the read semantic (`mask`).
                    unsafe {
                        asm!(
                            "call ({w}), _optix_get_payload, ({i});",
                            w = out(reg32) words.0[$i],
                            i = in(reg32) $i,
                            // Goes if nobody needs the word; stays where it is among calls that set words, which
                            // count as writes to memory.
                            options(pure, readonly, nostack, preserves_flags)
                        )
                    };
                }
            )*};
        }
        get!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31);
        words
    }

    /// Sets the payload words in `mask`.
    #[inline(always)]
    pub fn set_payload(&self, mask: u32, words: &WordBuffer) {
        macro_rules! set {
            ($($i:literal)*) => {$(
                if mask & 1 << $i != 0 {
                    // SAFETY: the program's payload type has word `i` with the write semantic (`mask`).
                    unsafe {
                        asm!(
                            "call _optix_set_payload, ({i}, {w});",
                            w = in(reg32) words.0[$i],
                            i = in(reg32) $i,
                            options(nostack, preserves_flags)
                        )
                    };
                }
            )*};
        }
        set!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31);
    }

    #[inline(always)]
    pub fn world_ray_origin(&self) -> Vec3 {
        get_vec3!("_optix_get_world_ray_origin")
    }
    #[inline(always)]
    pub fn world_ray_direction(&self) -> Vec3 {
        get_vec3!("_optix_get_world_ray_direction")
    }
    #[inline(always)]
    pub fn object_ray_origin(&self) -> Vec3 {
        get_vec3!("_optix_get_object_ray_origin")
    }
    #[inline(always)]
    pub fn object_ray_direction(&self) -> Vec3 {
        get_vec3!("_optix_get_object_ray_direction")
    }
    #[inline(always)]
    pub fn ray_tmin(&self) -> f32 {
        get_f32!("_optix_get_ray_tmin")
    }
    #[inline(always)]
    pub fn ray_tmax(&self) -> f32 {
        get_f32!("_optix_get_ray_tmax")
    }
    /// `ray_tmax` in an intersection program: changes while it reports, so it is not pure.
    #[inline(always)]
    pub fn interval_end(&self) -> f32 {
        let value: f32;
        // SAFETY: a query of the running program.
        unsafe {
            asm!(
                "{{ .reg .f32 f; call (f), _optix_get_ray_tmax, (); mov.b32 {v}, f; }}",
                v = out(reg32) value,
                options(nostack, preserves_flags)
            )
        };
        value
    }
    #[inline(always)]
    pub fn ray_time(&self) -> f32 {
        get_f32!("_optix_get_ray_time")
    }
    #[inline(always)]
    pub fn ray_flags(&self) -> u32 {
        get_u32!("_optix_get_ray_flags")
    }
    #[inline(always)]
    pub fn ray_mask(&self) -> u32 {
        get_u32!("_optix_get_ray_visibility_mask")
    }
    #[inline(always)]
    pub fn primitive_index(&self) -> u32 {
        get_u32!("_optix_read_primitive_idx")
    }
    #[inline(always)]
    pub fn sbt_gas_index(&self) -> u32 {
        get_u32!("_optix_read_sbt_gas_idx")
    }
    #[inline(always)]
    pub fn instance_id(&self) -> u32 {
        get_u32!("_optix_read_instance_id")
    }
    #[inline(always)]
    pub fn instance_index(&self) -> u32 {
        get_u32!("_optix_read_instance_idx")
    }
    #[inline(always)]
    pub fn hit_kind(&self) -> u32 {
        get_u32!("_optix_get_hit_kind")
    }

    #[inline(always)]
    pub fn barycentrics(&self) -> Vec2 {
        let (u, v): (f32, f32);
        // SAFETY: the hit is a triangle's, by the context's type.
        unsafe {
            asm!(
                "{{ .reg .f32 f<2>; call (f0, f1), _optix_get_triangle_barycentrics, ();",
                "mov.b32 {u}, f0; mov.b32 {v}, f1; }}",
                u = out(reg32) u,
                v = out(reg32) v,
                options(pure, nomem, nostack, preserves_flags)
            )
        };
        Vec2::new(u, v)
    }

    #[inline(always)]
    pub fn attributes(&self, count: usize) -> WordBuffer {
        let mut words = WordBuffer::ZERO;
        macro_rules! get {
            ($($i:literal)*) => {$(
                if count > $i {
                    words.0[$i] = get_u32!(concat!("_optix_get_attribute_", $i));
                }
            )*};
        }
        get!(0 1 2 3 4 5 6 7);
        words
    }

    #[inline(always)]
    pub fn triangle_vertices(&self) -> [Vec3; 3] {
        let v: [f32; 9];
        let (a, b, c, d, e, f, g, h, i): (f32, f32, f32, f32, f32, f32, f32, f32, f32);
        // SAFETY: the hit is a triangle's, by the context's type.
        unsafe {
            asm!(
                "{{ .reg .f32 f<9>;",
                "call (f0, f1, f2, f3, f4, f5, f6, f7, f8), _optix_get_triangle_vertex_data_current_hit, ();",
                "mov.b32 {a}, f0; mov.b32 {b}, f1; mov.b32 {c}, f2;",
                "mov.b32 {d}, f3; mov.b32 {e}, f4; mov.b32 {f}, f5;",
                "mov.b32 {g}, f6; mov.b32 {h}, f7; mov.b32 {i}, f8; }}",
                a = out(reg32) a, b = out(reg32) b, c = out(reg32) c,
                d = out(reg32) d, e = out(reg32) e, f = out(reg32) f,
                g = out(reg32) g, h = out(reg32) h, i = out(reg32) i,
                options(pure, nomem, nostack, preserves_flags)
            )
        };
        v = [a, b, c, d, e, f, g, h, i];
        [Vec3::new(v[0], v[1], v[2]), Vec3::new(v[3], v[4], v[5]), Vec3::new(v[6], v[7], v[8])]
    }

    /// Three rows of the object-to-world matrix.
    #[inline(always)]
    pub fn object_to_world(&self) -> [[f32; 4]; 3] {
        transform(Direction::ObjectToWorld)
    }

    /// Three rows of the world-to-object matrix.
    #[inline(always)]
    pub fn world_to_object(&self) -> [[f32; 4]; 3] {
        transform(Direction::WorldToObject)
    }

    #[inline(always)]
    pub fn report(&self, t: f32, kind: u32, count: usize, attributes: &WordBuffer) -> bool {
        let [a0, a1, a2, a3, a4, a5, a6, a7, ..] = attributes.0;
        let kind = kind & 0x7f;
        let mut accepted = 0u32;
        macro_rules! arm {
            ($count:expr, [$($used:ident)*] [$($unused:ident)*]) => {
                if $count == count!($($used)*) {
                    // SAFETY: an intersection program's context; the count is that of its attribute type.
                    unsafe {
                        asm!(
                            "{{ .reg .f32 f; mov.b32 f, {t};",
                            concat!(
                                "call ({accepted}), _optix_report_intersection_", arm!(@n $($used)*), ", (f, {kind}",
                                $(", {", stringify!($used), "}",)*
                                "); }}"
                            ),
                            t = in(reg32) t,
                            kind = in(reg32) kind,
                            $($used = in(reg32) $used,)*
                            accepted = lateout(reg32) accepted,
                            options(nostack, preserves_flags)
                        )
                    };
                }
            };
            (@n) => { "0" };
            (@n a0) => { "1" };
            (@n a0 a1) => { "2" };
            (@n a0 a1 a2) => { "3" };
            (@n a0 a1 a2 a3) => { "4" };
            (@n a0 a1 a2 a3 a4) => { "5" };
            (@n a0 a1 a2 a3 a4 a5) => { "6" };
            (@n a0 a1 a2 a3 a4 a5 a6) => { "7" };
            (@n a0 a1 a2 a3 a4 a5 a6 a7) => { "8" };
        }
        by_count!(arm, count, [] [a0 a1 a2 a3 a4 a5 a6 a7]);
        accepted != 0
    }

    /// Discards the candidate hit and ends the program.
    #[inline(always)]
    pub fn ignore_intersection(&self) {
        // SAFETY: an any-hit program's last act.
        unsafe { asm!("call _optix_ignore_intersection, ();", options(nostack, preserves_flags)) };
    }

    /// Accepts the candidate hit, ends traversal and the program.
    #[inline(always)]
    pub fn terminate_ray(&self) {
        // SAFETY: an any-hit program's last act.
        unsafe { asm!("call _optix_terminate_ray, ();", options(nostack, preserves_flags)) };
    }
}

/// Which way a point goes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Direction {
    ObjectToWorld,
    WorldToObject,
}

/// Three rows of four from memory that does not change during a launch.
///
/// # Safety
/// `rows` is what a transform query returned: 48 bytes, aligned to 16, valid for the launch.
#[inline(always)]
unsafe fn rows(rows: u64) -> [[f32; 4]; 3] {
    let at = rows as *const [f32; 4];
    // SAFETY: the caller's.
    unsafe { [at.read(), at.add(1).read(), at.add(2).read()] }
}

/// `a` after `b`, both affine.
#[inline(always)]
fn concatenate(a: [[f32; 4]; 3], b: [[f32; 4]; 3]) -> [[f32; 4]; 3] {
    a.map(|row| {
        core::array::from_fn(|column| {
            let linear = row[0] * b[0][column] + row[1] * b[1][column] + row[2] * b[2][column];
            if column == 3 { linear + row[3] } else { linear }
        })
    })
}

/// The product of the transform list (guide 13.11). Instances are the only transforms of a static scene.
#[inline(always)]
fn transform(direction: Direction) -> [[f32; 4]; 3] {
    let mut product = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
    let size = get_u32!("_optix_get_transform_list_size");
    let mut i = 0;
    while i < size {
        let (handle, matrix): (u64, u64);
        // SAFETY: `i` is inside the list; the result is the handle of an instance.
        unsafe {
            asm!(
                "call ({h}), _optix_get_transform_list_handle, ({i});",
                h = out(reg64) handle,
                i = in(reg32) i,
                options(pure, nomem, nostack, preserves_flags)
            )
        };
        if direction == Direction::ObjectToWorld {
            // SAFETY: the handle of an instance.
            unsafe {
                asm!(
                    "call ({m}), _optix_get_instance_transform_from_handle, ({h});",
                    m = out(reg64) matrix,
                    h = in(reg64) handle,
                    options(pure, nomem, nostack, preserves_flags)
                )
            };
            // SAFETY: from the query above. Index 0 is nearest the root, so its transform is applied last.
            product = concatenate(product, unsafe { rows(matrix) });
        } else {
            // SAFETY: the handle of an instance.
            unsafe {
                asm!(
                    "call ({m}), _optix_get_instance_inverse_transform_from_handle, ({h});",
                    m = out(reg64) matrix,
                    h = in(reg64) handle,
                    options(pure, nomem, nostack, preserves_flags)
                )
            };
            // SAFETY: from the query above. Index 0 is nearest the root, so its inverse is applied first.
            product = concatenate(unsafe { rows(matrix) }, product);
        }
        i += 1;
    }
    product
}
