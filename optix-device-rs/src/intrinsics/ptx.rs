//! How intrinsics are called: what the PTX bodies of the table are written with.
//!
//! OptiX checks the register type of every argument and result, and LLVM keeps `f32` in untyped `.b32` registers; so each asm
//! block declares `.f32` registers of its own and moves the bits across. Names, order, register types and volatility follow the
//! public device headers of OptiX 9.0 as facts.

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

/// Three pure intrinsics that give the coordinates of a vector.
macro_rules! get_vec3 {
    ($name:literal) => {
        Vec3::new(get_f32!(concat!($name, "_x")), get_f32!(concat!($name, "_y")), get_f32!(concat!($name, "_z")))
    };
}

/// A pure intrinsic without arguments that gives one 64-bit integer, such as an address or a handle.
macro_rules! get_u64 {
    ($name:literal) => {{
        let value: u64;
        // SAFETY: as for `get_u32`.
        unsafe {
            asm!(
                concat!("call ({v}), ", $name, ", ();"),
                v = out(reg64) value,
                options(pure, nomem, nostack, preserves_flags)
            )
        };
        value
    }};
}

/// A pure intrinsic that takes one integer and gives one. Needs `unsafe`: the argument is to be one it is defined for.
macro_rules! get_of {
    ($name:literal, $from:ident $argument:expr, $to:ident as $ty:ty) => {{
        let value: $ty;
        asm!(
            concat!("call ({v}), ", $name, ", ({a});"),
            v = out($to) value,
            a = in($from) $argument,
            options(pure, nomem, nostack, preserves_flags)
        );
        value
    }};
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

/// How many identifiers there are.
macro_rules! count {
    () => { 0 };
    ($first:ident $($rest:ident)*) => { 1 + count!($($rest)*) };
}
