//! Macros that write down an ABI and check it while compiling.

/// Declares `#[repr(C)]` structures whose size, alignment and field offsets are stated beside them and asserted at
/// compile time. `Default` is all zero bytes, which is what the API asks for before filling (guide 3.6).
macro_rules! abi_structs {
    ($(
        $(#[$meta:meta])*
        $name:ident: size $size:literal align $align:literal {
            $($offset:literal $field:ident: $ty:ty,)*
        }
    )*) => {$(
        $(#[$meta])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug)]
        pub struct $name {
            $(pub $field: $ty,)*
        }

        const _: () = {
            assert!(size_of::<$name>() == $size);
            assert!(align_of::<$name>() == $align);
            $(assert!(core::mem::offset_of!($name, $field) == $offset);)*
        };

        impl Default for $name {
            fn default() -> Self {
                // SAFETY: the fields are integers, floats, arrays and structures of these, raw pointers and
                // `Option`s of function pointers; zero bytes are a valid value of each.
                unsafe { core::mem::zeroed() }
            }
        }
    )*};
}

/// Declares C enums and flag sets as transparent 32-bit newtypes with named constants.
macro_rules! abi_consts {
    ($(
        $(#[$meta:meta])*
        $name:ident: $repr:ty { $($(#[$cmeta:meta])* $constant:ident = $value:expr,)* }
    )*) => {$(
        $(#[$meta])*
        #[repr(transparent)]
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
        pub struct $name(pub $repr);

        impl $name {
            $($(#[$cmeta])* pub const $constant: Self = Self($value);)*
        }
    )*};
}

/// Declares opaque handles: distinct pointer-sized newtypes. Copying one does not create an object (guide 3.5).
macro_rules! handles {
    ($($(#[$meta:meta])* $name:ident;)*) => {$(
        $(#[$meta])*
        #[repr(transparent)]
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct $name(pub *mut core::ffi::c_void);

        impl $name {
            /// No object.
            pub const NULL: Self = Self(core::ptr::null_mut());
        }

        // SAFETY: a name, not a reference: it is only handed back to the driver, whose functions take it from any
        // thread and at the same time (guide 3.2).
        unsafe impl Send for $name {}
        // SAFETY: as above.
        unsafe impl Sync for $name {}
    )*};
}
