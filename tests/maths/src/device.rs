//! The functions that are measured, a kernel each.

use core::arch::asm;

use optix_device_rs::math::fast;
use optix_device_rs::prelude::Math;

/// Has this thread do its share of `count` pieces of work. Gives its number.
pub fn share(count: u32, mut work: impl FnMut(usize)) -> usize {
    let (thread, block, threads, blocks): (u32, u32, u32, u32);
    // SAFETY: these read registers of the machine.
    unsafe {
        asm!("mov.u32 {}, %tid.x;", out(reg32) thread, options(pure, nomem, nostack));
        asm!("mov.u32 {}, %ctaid.x;", out(reg32) block, options(pure, nomem, nostack));
        asm!("mov.u32 {}, %ntid.x;", out(reg32) threads, options(pure, nomem, nostack));
        asm!("mov.u32 {}, %nctaid.x;", out(reg32) blocks, options(pure, nomem, nostack));
    }
    let number = block * threads + thread;
    let mut i = number;
    while i < count {
        work(i as usize);
        i += threads * blocks;
    }
    number as usize
}

/// Kernels which compute a value of each pair of arguments.
macro_rules! kernels {
    ($value:ident: $($name:literal $function:expr;)*) => {$(
        const _: () = {
            /// `count` arguments are at the first address, and room for as many values at the second.
            #[unsafe(export_name = $name)]
            unsafe extern "ptx-kernel" fn kernel(arguments: *const [f32; 2], values: *mut $value, count: u32) {
                let function: fn(f32, f32) -> $value = $function;
                $crate::device::share(count, |i| {
                    // SAFETY: both have `count` elements, as the host promises.
                    unsafe {
                        let [x, y] = *arguments.add(i);
                        *values.add(i) = function(x, y);
                    }
                });
            }
        };
    )*};
}
pub(crate) use kernels;

kernels! {
    f32:
    "ours_sin" |x, _| x.sin();
    "ours_cos" |x, _| x.cos();
    "ours_tan" |x, _| x.tan();
    "ours_asin" |x, _| x.asin();
    "ours_acos" |x, _| x.acos();
    "ours_atan" |x, _| x.atan();
    "ours_sinh" |x, _| x.sinh();
    "ours_cosh" |x, _| x.cosh();
    "ours_tanh" |x, _| x.tanh();
    "ours_asinh" |x, _| libm::asinhf(x);
    "ours_acosh" |x, _| libm::acoshf(x);
    "ours_atanh" |x, _| libm::atanhf(x);
    "ours_exp" |x, _| x.exp();
    "ours_exp2" |x, _| x.exp2();
    "ours_exp10" |x, _| libm::exp10f(x);
    "ours_expm1" |x, _| libm::expm1f(x);
    "ours_log" |x, _| x.ln();
    "ours_log2" |x, _| x.log2();
    "ours_log10" |x, _| x.log10();
    "ours_log1p" |x, _| libm::log1pf(x);
    "ours_cbrt" |x, _| x.cbrt();
    "ours_sqrt" |x, _| x.sqrt();
    "ours_pow" |x, y| x.powf(y);
    "ours_atan2" |y, x| y.atan2(x);
    "ours_hypot" |x, y| x.hypot(y);
    "ours_fmod" |x, y| libm::fmodf(x, y);
    "fast_sin" |x, _| fast::sin(x);
    "fast_cos" |x, _| fast::cos(x);
    "fast_tan" |x, _| fast::tan(x);
    "fast_exp" |x, _| fast::exp(x);
    "fast_exp2" |x, _| fast::exp2(x);
    "fast_log" |x, _| fast::ln(x);
    "fast_log2" |x, _| fast::log2(x);
    "fast_log10" |x, _| fast::log10(x);
    "fast_tanh" |x, _| fast::tanh(x);
    "fast_recip" |x, _| fast::recip(x);
    "fast_sqrt" |x, _| fast::sqrt(x);
    "fast_rsqrt" |x, _| fast::rsqrt(x);
    "fast_pow_2_4" |x, _| fast::powf(x, 2.4);
}

#[cfg(feature = "libdevice")]
mod libdevice {
    /// Declares functions of C, which libNVVM takes from libdevice, and makes kernels of them.
    macro_rules! libdevice {
        ($($name:literal $function:ident($($arg:ident),+);)*) => {
            unsafe extern "C" {$(
                safe fn $function($($arg: f32),+) -> f32;
            )*}
            kernels! { f32: $($name libdevice!(@closure $function($($arg),+));)* }
        };
        (@closure $function:ident($x:ident)) => { |x, _| $function(x) };
        (@closure $function:ident($x:ident, $y:ident)) => { |x, y| $function(x, y) };
    }

    libdevice! {
        "libdevice_sin" sinf(x);
        "libdevice_cos" cosf(x);
        "libdevice_tan" tanf(x);
        "libdevice_asin" asinf(x);
        "libdevice_acos" acosf(x);
        "libdevice_atan" atanf(x);
        "libdevice_sinh" sinhf(x);
        "libdevice_cosh" coshf(x);
        "libdevice_tanh" tanhf(x);
        "libdevice_asinh" asinhf(x);
        "libdevice_acosh" acoshf(x);
        "libdevice_atanh" atanhf(x);
        "libdevice_exp" expf(x);
        "libdevice_exp2" exp2f(x);
        "libdevice_exp10" exp10f(x);
        "libdevice_expm1" expm1f(x);
        "libdevice_log" logf(x);
        "libdevice_log2" log2f(x);
        "libdevice_log10" log10f(x);
        "libdevice_log1p" log1pf(x);
        "libdevice_cbrt" cbrtf(x);
        "libdevice_pow" powf(x, y);
        "libdevice_atan2" atan2f(y, x);
        "libdevice_hypot" hypotf(x, y);
        "libdevice_fmod" fmodf(x, y);
    }
}
