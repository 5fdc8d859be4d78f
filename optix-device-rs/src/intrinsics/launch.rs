//! The launch: its index and dimensions, its parameters, and the record of the running program (guide 6.5, 13.1, 13.8).

use super::Invocation;
#[cfg(target_arch = "nvptx64")]
use crate::data::DeviceData;
use crate::params::LaunchParams;
use crate::pipeline::Pipeline;
#[cfg(target_arch = "nvptx64")]
use core::arch::asm;
use core::marker::PhantomData;
use glam::UVec3;

device_functions! {
    in anywhere else _ {
        /// This launch index (guide 13.1).
        "optixGetLaunchIndex"
        fn launch_index(&self) -> UVec3 {
            ptx {
                UVec3::new(
                    get_u32!("_optix_get_launch_index_x"),
                    get_u32!("_optix_get_launch_index_y"),
                    get_u32!("_optix_get_launch_index_z"),
                )
            }
            host { self.frame().launch_index }
        }

        /// The launch's dimensions (guide 13.1).
        "optixGetLaunchDimensions"
        fn launch_dimensions(&self) -> UVec3 {
            ptx {
                UVec3::new(
                    get_u32!("_optix_get_launch_dimension_x"),
                    get_u32!("_optix_get_launch_dimension_y"),
                    get_u32!("_optix_get_launch_dimension_z"),
                )
            }
            host { self.frame().launch_dimensions }
        }
    }
}

methods! {
    in anywhere {
        /// The launch parameters, field by field (guide 6.5).
        #[inline(always)]
        pub fn params(&self) -> <P::Params as LaunchParams>::View<'_>
        where
            P: Pipeline,
        {
            self.invocation.params::<P::Params>().into()
        }
    }
    others {}
}

impl Invocation {
    /// The data of the running program's record (`optixGetSbtDataPointer`).
    #[inline(always)]
    pub fn record(&self) -> *const u8 {
        body! {
            ptx { get_u64!("_optix_get_sbt_data_ptr_64") as *const u8 }
            host { self.frame().record.as_ptr().cast_const() }
        }
    }

    /// The launch's parameters.
    #[inline(always)]
    pub fn params<P>(&self) -> ParamsBase<'_, P> {
        body! {
            ptx { ParamsBase(PhantomData) }
            host { ParamsBase(self.frame().params, PhantomData) }
        }
    }
}

/// The launch's parameters, for as long as the program's context is borrowed: on the device in constant memory, under a name
/// that `P` knows.
pub struct ParamsBase<'a, P>(#[cfg(not(target_arch = "nvptx64"))] core::ptr::NonNull<u8>, PhantomData<&'a P>);

impl<P> Clone for ParamsBase<'_, P> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}
impl<P> Copy for ParamsBase<'_, P> {}

/// The parameter field at byte `OFFSET`, by loads at constant addresses.
///
/// # Safety
/// `P` has a field of type `T` at `OFFSET`.
#[cfg(target_arch = "nvptx64")]
#[inline(always)]
pub unsafe fn load_param<P: LaunchParams, T: DeviceData, const OFFSET: usize>(_: ParamsBase<'_, P>) -> T {
    let mut value = core::mem::MaybeUninit::<T>::uninit();
    let most = if T::UNIT >= 4 { 128 } else { 8 };
    if size_of::<T>() > most {
        // Large fields are read through a pointer; such loads can't be specialised.
        // SAFETY: the symbol is a valid `P`, which has a `T` at `OFFSET`.
        return unsafe { P::address().add(OFFSET).cast::<T>().read() };
    }
    macro_rules! load {
        ($unit:ident as $ty:ty: $($i:literal)*) => {
            if T::UNIT == size_of::<$ty>() {
                $(if size_of::<T>() > size_of::<$ty>() * $i {
                    let to = value.as_mut_ptr().cast::<$ty>();
                    // SAFETY: inside of `T`, whose size and alignment are multiples of `UNIT`.
                    unsafe { to.add($i).write(P::$unit::<OFFSET, $i>()) };
                })*
            }
        };
    }
    load!(long as u64: 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15);
    load!(word as u32: 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31);
    load!(half as u16: 0 1 2 3);
    load!(byte as u8: 0 1 2 3 4 5 6 7);
    // SAFETY: all bytes are written, from a valid `T`.
    unsafe { value.assume_init() }
}

/// The parameter field at byte `OFFSET`, read from the launch's copy.
///
/// # Safety
/// `P` has a field of type `T` at `OFFSET`.
#[cfg(not(target_arch = "nvptx64"))]
#[inline(always)]
pub unsafe fn load_param<P: LaunchParams, T: Copy, const OFFSET: usize>(base: ParamsBase<'_, P>) -> T {
    // SAFETY: the executor's parameters are a valid `P` (`Invocation::new`), and the caller vouches for the field.
    unsafe { base.0.add(OFFSET).cast::<T>().read() }
}
