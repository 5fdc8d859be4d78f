//! What programs tell the traversal: a hit, and what becomes of it (guide 13.4, 13.13).

use super::Cx;
use crate::words::WordBuffer;
use core::arch::asm;

impl Cx {
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
