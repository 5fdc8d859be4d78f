//! What an application holds of a callable: the host counterparts of `Callable` and `Callables`.

use super::{DeviceId, KeepAlive, Kept, View};
use crate::callable::{Callable, CallableKind, Callables, Signature};
use crate::words::FromRaw;
use core::marker::PhantomData;
use std::any::Any;
use std::sync::Arc;

/// A record of the callables section: a callable with its data. The host counterpart of [`Callable`]; a clone is the same record.
pub struct CallableRecord<F, K> {
    range: Range,
    types: PhantomData<fn() -> (F, K)>,
}

/// Records of the callables section one behind the other: the host counterpart of [`Callables`]. A clone is the same table.
pub struct CallableTable<F, K> {
    range: Range,
    types: PhantomData<fn() -> (F, K)>,
}

/// Records of a scene.
#[derive(Clone)]
struct Range {
    /// The number by which programs know the first record; those of the others follow.
    first: u32,
    len: u32,
    device: DeviceId,
    scene: Arc<dyn Any + Send + Sync>,
}

impl Range {
    fn keep(&self, keep: &mut KeepAlive) {
        keep.keep(Kept::Callables(self.device, self.scene.clone()));
    }
}

macro_rules! owners {
    ($($name:ident)*) => {$(
        impl<F, K> Clone for $name<F, K> {
            fn clone(&self) -> Self {
                Self { range: self.range.clone(), types: PhantomData }
            }
        }

        impl<F, K> core::fmt::Debug for $name<F, K> {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                let Range { first, len, .. } = self.range;
                write!(f, concat!(stringify!($name), "({} to {})"), first, first + len)
            }
        }
    )*};
}
owners!(CallableRecord CallableTable);

impl<F, K> CallableRecord<F, K> {
    /// For scenes: the record of the callables section that programs on `device` know by `number`; `scene` tells launches which
    /// scene's it is.
    ///
    /// # Safety
    /// Launches that keep `scene` have that record, of a program with signature `F` and kind `K`.
    #[doc(hidden)]
    pub unsafe fn new(number: u32, device: DeviceId, scene: Arc<dyn Any + Send + Sync>) -> Self {
        Self { range: Range { first: number, len: 1, device, scene }, types: PhantomData }
    }

    /// What [`CallableRecord::new`] was given as `scene`, if it is a `T`.
    #[doc(hidden)]
    pub fn owner<T: Any>(&self) -> Option<&T> {
        self.range.scene.downcast_ref()
    }
}

impl<F, K> CallableTable<F, K> {
    /// For scenes: `len` records, the first of which programs know by number `first`; see [`CallableRecord::new`].
    ///
    /// # Safety
    /// As there, for each record.
    #[doc(hidden)]
    pub unsafe fn new(first: u32, len: u32, device: DeviceId, scene: Arc<dyn Any + Send + Sync>) -> Self {
        Self { range: Range { first, len, device, scene }, types: PhantomData }
    }

    /// How many records it has.
    pub fn len(&self) -> u32 {
        self.range.len
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.range.len == 0
    }
}

// SAFETY: the scene that has the records is kept.
unsafe impl<F: Signature, K: CallableKind> View for Callable<F, K> {
    type Owner = CallableRecord<F, K>;
    fn of(owner: &CallableRecord<F, K>, keep: &mut KeepAlive) -> Self {
        owner.range.keep(keep);
        // SAFETY: `CallableRecord::new`; launches refuse what another scene's table has.
        unsafe { Self::from_raw(owner.range.first) }
    }
}

// SAFETY: the scene that has the records is kept.
unsafe impl<F: Signature, K: CallableKind> View for Callables<F, K> {
    type Owner = CallableTable<F, K>;
    fn of(owner: &CallableTable<F, K>, keep: &mut KeepAlive) -> Self {
        owner.range.keep(keep);
        // SAFETY: `CallableTable::new`; launches refuse what another scene's table has.
        unsafe { Self::from_raw([owner.range.first, owner.range.len]) }
    }
}
