//! Launch parameters, in constant memory (guide 6.5).

use super::Cx;
use crate::data::DeviceData;
use crate::params::LaunchParams;
use core::marker::PhantomData;
use core::mem::MaybeUninit;

/// The launch's parameters: in constant memory, under a name that `P` knows.
pub struct ParamsBase<'a, P>(PhantomData<&'a P>);

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
#[inline(always)]
pub unsafe fn load_param<P: LaunchParams, T: DeviceData, const OFFSET: usize>(_: ParamsBase<'_, P>) -> T {
    let mut value = MaybeUninit::<T>::uninit();
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

impl Cx {
    #[inline(always)]
    pub fn params<P>(&self) -> ParamsBase<'_, P> {
        ParamsBase(PhantomData)
    }
}
