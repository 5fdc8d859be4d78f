//! Generated functions (see `build.rs`): the same on the CPU, and in a kernel that both code generators compile.
#![no_std]

mod functions {
    #![allow(warnings, clippy::all, reason = "written by a program")]

    use super::result;
    use glam::Vec3;

    include!(concat!(env!("OUT_DIR"), "/functions.rs"));
}

pub use functions::{FUNCTIONS, call};

/// Any value as 64 bits.
trait Bits {
    fn bits(self) -> u64;
}

macro_rules! integers {
    ($($ty:ident)+) => {$(
        impl Bits for $ty {
            fn bits(self) -> u64 {
                self as u64 ^ (self as u128 >> 64) as u64
            }
        }
    )+};
}

integers!(u8 i8 u16 i16 u32 i32 u64 i64 u128 i128);

// Which of many NaNs comes out, no machine promises.
impl Bits for f32 {
    fn bits(self) -> u64 {
        if self.is_nan() { u64::MAX } else { self.to_bits().into() }
    }
}

impl Bits for f64 {
    fn bits(self) -> u64 {
        if self.is_nan() { u64::MAX } else { self.to_bits() }
    }
}

fn result(value: impl Bits) -> u64 {
    value.bits()
}

#[cfg(target_arch = "nvptx64")]
mod device {
    use core::arch::asm;

    /// One function (the block's second index) of one input (the thread) after the other.
    #[unsafe(no_mangle)]
    pub unsafe extern "ptx-kernel" fn differential(inputs: *const [u64; 4], outputs: *mut u64, count: u32) {
        let (thread, block, threads, function): (u32, u32, u32, u32);
        // SAFETY: these read registers of the machine.
        unsafe {
            asm!("mov.u32 {}, %tid.x;", out(reg32) thread, options(pure, nomem, nostack));
            asm!("mov.u32 {}, %ctaid.x;", out(reg32) block, options(pure, nomem, nostack));
            asm!("mov.u32 {}, %ntid.x;", out(reg32) threads, options(pure, nomem, nostack));
            asm!("mov.u32 {}, %ctaid.y;", out(reg32) function, options(pure, nomem, nostack));
        }
        let at = block * threads + thread;
        if at < count {
            // SAFETY: the host passes `count` inputs, and as many outputs for each function.
            unsafe {
                *outputs.add((function * count + at) as usize) = crate::call(function, &*inputs.add(at as usize));
            }
        }
    }

    #[panic_handler]
    fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
        loop {}
    }
}
