//! Intrinsics by inline assembly, each as a macro that stands for one call.

use core::arch::asm;

/// A load of a launch parameter.
macro_rules! param {
    ($load:literal, $class:ident, $ty:ty, $at:literal) => {{
        let value: $ty;
        // SAFETY: inside of the variable, which does not change.
        unsafe {
            ::core::arch::asm!(
                concat!($load, " {v}, [raw_params+", $at, "];"),
                v = out($class) value,
                options(pure, readonly, nostack, preserves_flags)
            )
        };
        value
    }};
}

/// A query without arguments that gives an integer.
macro_rules! get_u32 {
    ($name:literal) => {{
        let value: u32;
        // SAFETY: a query that the program may make.
        unsafe {
            ::core::arch::asm!(
                concat!("call ({v}), ", $name, ", ();"),
                v = out(reg32) value,
                options(pure, nomem, nostack, preserves_flags)
            )
        };
        value
    }};
}

/// A query without arguments that gives a number: OptiX wants it in an `.f32` register.
macro_rules! get_f32 {
    ($name:literal) => {{
        let value: f32;
        // SAFETY: a query that the program may make.
        unsafe {
            ::core::arch::asm!(
                concat!("{{ .reg .f32 f; call (f), ", $name, ", (); mov.b32 {v}, f; }}"),
                v = out(reg32) value,
                options(pure, nomem, nostack, preserves_flags)
            )
        };
        value
    }};
}

pub(crate) use {get_f32, get_u32, param};

/// The address, or one that no memory has unless `index < len`.
#[inline(always)]
pub fn address_if(index: u32, len: u32, mut address: u64) -> u64 {
    // SAFETY: arithmetic on registers.
    unsafe {
        asm!(
            "{{ .reg .pred p; .reg .b32 low, high; setp.lt.u32 p, {index}, {len}; mov.b64 {{low, high}}, {address}; ",
            "selp.b32 high, high, 0xffffffff, p; mov.b64 {address}, {{low, high}}; }}",
            index = in(reg32) index,
            len = in(reg32) len,
            address = inout(reg64) address,
            options(pure, nomem, nostack, preserves_flags)
        )
    }
    address
}

#[inline(always)]
pub fn trap() -> ! {
    // SAFETY: ends the launch.
    unsafe { asm!("trap; exit;", options(noreturn, nomem)) }
}

#[inline(always)]
pub fn record<T>() -> *const T {
    let address: u64;
    // SAFETY: a query.
    unsafe {
        asm!(
            "call ({a}), _optix_get_sbt_data_ptr_64, ();",
            a = out(reg64) address,
            options(pure, nomem, nostack, preserves_flags)
        )
    };
    address as *const T
}

#[inline(always)]
pub fn set_payload_types(types: u32) {
    // SAFETY: the first call of a program with a payload.
    unsafe { asm!("call _optix_set_payload_types, ({m});", m = in(reg32) types, options(nostack, preserves_flags)) };
}

#[inline(always)]
pub fn get_payload(index: u32) -> u32 {
    let value: u32;
    // SAFETY: the word may be read.
    unsafe {
        asm!(
            "call ({w}), _optix_get_payload, ({i});",
            w = out(reg32) value,
            i = in(reg32) index,
            options(nostack, preserves_flags)
        )
    };
    value
}

#[inline(always)]
pub fn set_payload(index: u32, value: u32) {
    // SAFETY: the word may be written.
    unsafe {
        asm!(
            "call _optix_set_payload, ({i}, {w});",
            w = in(reg32) value,
            i = in(reg32) index,
            options(nostack, preserves_flags)
        )
    };
}

#[inline(always)]
pub fn ignore_intersection() {
    // SAFETY: in an any-hit program.
    unsafe { asm!("call _optix_ignore_intersection, ();", options(nostack, preserves_flags)) };
}

#[inline(always)]
pub fn terminate_ray() {
    // SAFETY: in an any-hit program.
    unsafe { asm!("call _optix_terminate_ray, ();", options(nostack, preserves_flags)) };
}

#[inline(always)]
pub fn barycentrics() -> [f32; 2] {
    let (u, v): (f32, f32);
    // SAFETY: the hit is a triangle's.
    unsafe {
        asm!(
            "{{ .reg .f32 f<2>; call (f0, f1), _optix_get_triangle_barycentrics, ();",
            "mov.b32 {u}, f0; mov.b32 {v}, f1; }}",
            u = out(reg32) u,
            v = out(reg32) v,
            options(pure, nomem, nostack, preserves_flags)
        )
    };
    [u, v]
}

#[inline(always)]
pub fn triangle_vertices() -> [[f32; 3]; 3] {
    let (a, b, c, d, e, f, g, h, i): (f32, f32, f32, f32, f32, f32, f32, f32, f32);
    // SAFETY: the hit is a triangle's.
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
    [[a, b, c], [d, e, f], [g, h, i]]
}

/// Reports a hit with four attribute words.
#[inline(always)]
pub fn report_intersection_4(t: f32, kind: u32, [a0, a1, a2, a3]: [u32; 4]) -> bool {
    let accepted: u32;
    // SAFETY: in an intersection program.
    unsafe {
        asm!(
            "{{ .reg .f32 f; mov.b32 f, {t};",
            "call ({accepted}), _optix_report_intersection_4, (f, {kind}, {a0}, {a1}, {a2}, {a3}); }}",
            t = in(reg32) t,
            kind = in(reg32) kind,
            a0 = in(reg32) a0,
            a1 = in(reg32) a1,
            a2 = in(reg32) a2,
            a3 = in(reg32) a3,
            accepted = lateout(reg32) accepted,
            options(nostack, preserves_flags)
        )
    };
    accepted != 0
}

/// What a trace call takes besides payload words.
pub struct Trace {
    pub types: u32,
    pub handle: u64,
    pub origin: [f32; 3],
    pub direction: [f32; 3],
    pub interval: [f32; 2],
    pub time: f32,
    pub mask: u32,
    pub flags: u32,
    pub sbt_offset: u32,
    pub sbt_stride: u32,
    pub miss_index: u32,
}

/// Traces a ray with five payload words.
#[inline(always)]
pub fn trace_5(call: &Trace, payload: [u32; 5]) -> [u32; 5] {
    let [mut p0, mut p1, mut p2, mut p3, mut p4] = payload;
    // SAFETY: in a program that may trace, with what the pipeline's records are laid out for.
    unsafe {
        asm!(
            "{{ .reg .f32 f<9>; .reg .b32 none;",
            "mov.b32 f0, {ox}; mov.b32 f1, {oy}; mov.b32 f2, {oz};",
            "mov.b32 f3, {dx}; mov.b32 f4, {dy}; mov.b32 f5, {dz};",
            "mov.b32 f6, {tmin}; mov.b32 f7, {tmax}; mov.b32 f8, {time};",
            "mov.b32 none, 0;",
            "call ({p0}, {p1}, {p2}, {p3}, {p4}, none, none, none, none, none, none, none, none, none, none, none, none, \
             none, none, none, none, none, none, none, none, none, none, none, none, none, none, none), \
             _optix_trace_typed_32, ({ty}, {handle}, f0, f1, f2, f3, f4, f5, f6, f7, f8, {mask}, {flags}, {offset}, \
             {stride}, {miss}, {words}, {p0}, {p1}, {p2}, {p3}, {p4}, none, none, none, none, none, none, none, none, \
             none, none, none, none, none, none, none, none, none, none, none, none, none, none, none, none, none, none, \
             none); }}",
            ty = in(reg32) call.types,
            handle = in(reg64) call.handle,
            ox = in(reg32) call.origin[0],
            oy = in(reg32) call.origin[1],
            oz = in(reg32) call.origin[2],
            dx = in(reg32) call.direction[0],
            dy = in(reg32) call.direction[1],
            dz = in(reg32) call.direction[2],
            tmin = in(reg32) call.interval[0],
            tmax = in(reg32) call.interval[1],
            time = in(reg32) call.time,
            mask = in(reg32) call.mask,
            flags = in(reg32) call.flags,
            offset = in(reg32) call.sbt_offset,
            stride = in(reg32) call.sbt_stride,
            miss = in(reg32) call.miss_index,
            words = in(reg32) 5,
            p0 = inlateout(reg32) p0,
            p1 = inlateout(reg32) p1,
            p2 = inlateout(reg32) p2,
            p3 = inlateout(reg32) p3,
            p4 = inlateout(reg32) p4,
            options(nostack, preserves_flags)
        )
    };
    [p0, p1, p2, p3, p4]
}

#[inline(always)]
pub fn direct_callable(index: u32) -> u64 {
    let address: u64;
    // SAFETY: the record is there.
    unsafe {
        asm!(
            "call ({a}), _optix_call_direct_callable, ({i});",
            a = out(reg64) address,
            i = in(reg32) index,
            options(nomem, nostack, preserves_flags)
        )
    };
    address
}
