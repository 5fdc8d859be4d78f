//! Functions of floats that the host has and the device has not: each is there for the message that its use gives. They take
//! `&self`, so that those of another crate's trait, which take `self`, are found before them.

/// Has `powi`.
#[diagnostic::on_unimplemented(
    message = "the device has no `powi`, though the host has",
    label = "not on the device",
    note = "write the product, `x * x`, or a power with an exponent that is a float, `x.powf(2.0)`"
)]
pub trait HasPowi {}

/// Has a function that [`Math`](super::Math) has not.
#[diagnostic::on_unimplemented(
    message = "the device does not have this function of `f32`, though the host has",
    label = "not on the device",
    note = "put it together from those of `optix_device_rs::math::Math`, such as `exp`, `ln` and `sqrt`"
)]
pub trait HasRareMaths {}

/// Has functions of `f64`.
#[diagnostic::on_unimplemented(
    message = "the device has no functions of `f64`, though the host has",
    label = "not on the device",
    note = "compute in `f32`, which a GPU does many times faster: `(x as f32).sqrt()`; where it must be `f64`, call the crate `libm`: `libm::sqrt(x)`"
)]
pub trait HasDoubleMaths {}

macro_rules! host_only {
    ($(#[$doc:meta])* $trait:ident of $float:ident { $($name:ident($($argument:ident: $ty:ty),*): $bound:ident;)* }) => {
        $(#[$doc])*
        #[doc(hidden)]
        pub trait $trait: Copy {
            $(
                #[doc(hidden)]
                fn $name(&self $(, $argument: $ty)*) -> Self
                where
                    for<'never> Self: $bound, // with a lifetime, since rustc reports a plain bound that does not hold
                {
                    $(let _ = $argument;)*
                    *self
                }
            )*
        }
        impl $trait for $float {}
    };
}
host_only! {
    /// Of `f32`.
    HostOnly of f32 {
        powi(exponent: i32): HasPowi;
        exp_m1(): HasRareMaths;
        ln_1p(): HasRareMaths;
        log(base: f32): HasRareMaths;
        asinh(): HasRareMaths;
        acosh(): HasRareMaths;
        atanh(): HasRareMaths;
    }
}
host_only! {
    /// Of `f64`.
    HostOnlyDouble of f64 {
        sqrt(): HasDoubleMaths;
        cbrt(): HasDoubleMaths;
        hypot(other: f64): HasDoubleMaths;
        sin(): HasDoubleMaths;
        cos(): HasDoubleMaths;
        tan(): HasDoubleMaths;
        asin(): HasDoubleMaths;
        acos(): HasDoubleMaths;
        atan(): HasDoubleMaths;
        atan2(x: f64): HasDoubleMaths;
        sinh(): HasDoubleMaths;
        cosh(): HasDoubleMaths;
        tanh(): HasDoubleMaths;
        powf(exponent: f64): HasDoubleMaths;
        powi(exponent: i32): HasDoubleMaths;
        exp(): HasDoubleMaths;
        exp2(): HasDoubleMaths;
        exp_m1(): HasDoubleMaths;
        ln(): HasDoubleMaths;
        ln_1p(): HasDoubleMaths;
        log(base: f64): HasDoubleMaths;
        log2(): HasDoubleMaths;
        log10(): HasDoubleMaths;
        floor(): HasDoubleMaths;
        ceil(): HasDoubleMaths;
        trunc(): HasDoubleMaths;
        round(): HasDoubleMaths;
        round_ties_even(): HasDoubleMaths;
        mul_add(a: f64, b: f64): HasDoubleMaths;
        fract(): HasDoubleMaths;
        div_euclid(divisor: f64): HasDoubleMaths;
        rem_euclid(divisor: f64): HasDoubleMaths;
    }
}
