//! Instructions that approximate (PTX ISA, "Floating Point Instructions").

use core::arch::asm;

macro_rules! instructions {
    ($($name:ident = $instruction:literal;)*) => {$(
        #[inline(always)]
        pub fn $name(x: f32) -> f32 {
            let bits: u32;
            // SAFETY: arithmetic.
            unsafe {
                asm!(
                    concat!("{{ .reg .f32 f; mov.b32 f, {x}; ", $instruction, " f, f; mov.b32 {y}, f; }}"),
                    x = in(reg32) x.to_bits(),
                    y = out(reg32) bits,
                    options(pure, nomem, nostack, preserves_flags)
                )
            };
            f32::from_bits(bits)
        }
    )*};
}

instructions! {
    sin = "sin.approx.f32";
    cos = "cos.approx.f32";
    exp2 = "ex2.approx.f32";
    log2 = "lg2.approx.f32";
    recip = "rcp.approx.f32";
    sqrt = "sqrt.approx.f32";
    rsqrt = "rsqrt.approx.f32";
}
