//! What programs tell the traversal: a hit, and what becomes of it (guide 13.4, 13.13).

use super::Invocation;
use crate::check::{DecidesByCall, MayReport};
#[cfg(not(target_arch = "nvptx64"))]
use crate::host::end;
use crate::primitive::Attributes;
use crate::words::{WordBuffer, part_mut};
#[cfg(target_arch = "nvptx64")]
use core::arch::asm;

methods! {
    in intersection {
        /// Whether the ray's interval shrinks while the program runs.
        pub(super) const REPORTS: bool = true;

        /// Reports a hit at `t` (guide 13.4).
        ///
        /// True if it was accepted: inside the current interval and not ignored by the any-hit program. `kind` is 0 to 127;
        /// its eighth bit is left out, on both machines, and ends the launch on [`Device::cpu_checked`].
        ///
        /// [`Device::cpu_checked`]: https://docs.rs/optix-host/latest/optix_host/struct.Device.html#method.cpu_checked
        ///
        /// The any-hit program runs meanwhile, on the ray's payload as the trace call, earlier reports and earlier intersection
        /// programs left it. What this program returns is stored when it returns: over what the any-hit programs of its reports
        /// wrote to the same fields. To count both, use two fields, or leave the field to the any-hit program.
        #[inline(always)]
        pub fn report(&self, t: f32, kind: u8, attributes: A) -> bool
        where
            A: Attributes,
        {
            let mut words = WordBuffer::ZERO;
            attributes.store(part_mut(&mut words.0, 0, A::WORDS));
            self.invocation.report(t, kind as u32, A::WORDS, &words)
        }
    }
    others {
        #[allow(dead_code, reason = "only programs that run for a ray have an interval")]
        pub(super) const REPORTS: bool = false;

        #[doc(hidden)]
        pub fn report<T: Attributes>(&self, _: f32, _: u8, _: T) -> bool
        where
            Self: MayReport,
        {
            unreachable!()
        }
    }
}

// What becomes of a hit is what an any-hit program returns.
methods! {
    in anywhere {
        #[doc(hidden)]
        pub fn ignore_intersection(&self)
        where
            Self: DecidesByCall,
        {
            unreachable!()
        }

        #[doc(hidden)]
        pub fn terminate_ray(&self)
        where
            Self: DecidesByCall,
        {
            unreachable!()
        }
    }
    others {}
}

impl Invocation {
    /// Reports a hit. `count` is a constant at every call.
    #[inline(always)]
    pub fn report(&self, t: f32, kind: u32, count: usize, attributes: &WordBuffer) -> bool {
        body! {
            ptx {
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
            host { end::goes_on() && self.frame().executor.report(t, kind as u8, count, attributes) }
        }
    }

    /// Discards the candidate hit and ends the program.
    #[cfg(target_arch = "nvptx64")]
    #[inline(always)]
    pub fn ignore_intersection(&self) {
        // SAFETY: an any-hit program's last act.
        unsafe { asm!("call _optix_ignore_intersection, ();", options(nostack, preserves_flags)) };
    }

    /// Accepts the candidate hit, ends traversal and the program.
    #[cfg(target_arch = "nvptx64")]
    #[inline(always)]
    pub fn terminate_ray(&self) {
        // SAFETY: an any-hit program's last act.
        unsafe { asm!("call _optix_terminate_ray, ();", options(nostack, preserves_flags)) };
    }
}
