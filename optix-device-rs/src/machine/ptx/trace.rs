//! Trace calls (guide 13.2).

use super::Cx;
use crate::machine::TraceCall;
use crate::words::WordBuffer;
use core::arch::asm;

impl Cx {
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
}
