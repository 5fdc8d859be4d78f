//! Host counterparts: structs in which owning buffers stand in the place of device views.

use super::{Buffer, Buffer2d, DeviceId, InstanceTable, Memory, Texture, TextureMemory, TriangleTable, World};
use crate::accel::Instances;
use crate::data::DeviceData;
use crate::primitive::TriangleVertices;
use crate::ray::Traversable;
use crate::texture::{Texel, Texture1d, Texture2d, Texture2dArray, Texture3d, TextureCube};
use crate::view::{Element, Slice, SliceMut, SliceMut2d};
use crate::words::FromRaw;
use std::any::Any;
use std::sync::Arc;
use std::vec::Vec;

/// Something that launches keep alive, and what their programs do with it.
#[derive(Clone)]
pub enum Kept {
    /// Memory that views show.
    Memory(Arc<dyn Memory>),
    /// A texture that programs look up.
    Texture(Arc<dyn TextureMemory>),
    /// A structure that rays are traced against.
    Traced(World),
    /// A structure whose instances or triangles are read by number.
    Read(World),
    /// Records of callables; the scene's own, which tells whose they are.
    Callables(DeviceId, Arc<dyn Any + Send + Sync>),
}

impl Kept {
    fn device(&self) -> DeviceId {
        match self {
            Self::Memory(memory) => memory.device(),
            Self::Texture(texture) => texture.device(),
            Self::Traced(world) | Self::Read(world) => world.device,
            Self::Callables(device, _) => *device,
        }
    }

    /// What it is, for messages, with its article.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Memory(_) => "a buffer",
            Self::Texture(_) => "a texture",
            Self::Traced(_) | Self::Read(_) => "an acceleration structure",
            Self::Callables(..) => "a callable",
        }
    }
}

/// What a launch or a shader binding table keeps alive, gathered while twins are lowered to device data.
pub struct KeepAlive {
    kept: Vec<Kept>,
}

impl KeepAlive {
    /// Nothing yet.
    ///
    /// # Safety
    /// What views are made with it are used no longer than what it gathered is kept.
    pub const unsafe fn new() -> Self {
        Self { kept: Vec::new() }
    }

    pub(super) fn keep(&mut self, kept: Kept) {
        self.kept.push(kept);
    }

    /// What is to be kept, so far.
    pub fn kept(&self) -> &[Kept] {
        &self.kept
    }

    /// What is to be kept.
    pub fn into_kept(self) -> Vec<Kept> {
        self.kept
    }

    /// The first thing that is not `device`'s.
    pub fn foreign(&self, device: DeviceId) -> Option<&Kept> {
        self.kept.iter().find(|kept| kept.device() != device)
    }
}

/// Host data that becomes device data: a struct without views is its own host counterpart, a buffer is the host counterpart of a view.
///
/// # Safety
/// Views in what [`HostData::lower`] returns were made by that call, with its `keep`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` can't be handed to a device",
    label = "is not the host counterpart of any device type",
    note = "a struct `Paint` that holds views is filled in on the host as `PaintHost`, with a buffer or the like in each view's place; any \
            other needs `#[derive(SbtRecord)]` or `#[derive(DeviceData)]`"
)]
pub unsafe trait HostData {
    /// What programs see.
    type Device: DeviceData;
    /// The device data; owners of what it points to go to `keep`.
    fn lower(&self, keep: &mut KeepAlive) -> Self::Device;
}

// SAFETY: there are no views.
unsafe impl HostData for () {
    type Device = ();
    fn lower(&self, _: &mut KeepAlive) {}
}

/// Which host type stands in for a view in a host counterpart. Used by the derives.
///
/// # Safety
/// What [`View::of`] returns is valid while what it handed to `keep` is kept.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a view of device memory",
    label = "only `Slice` and its kin, `Texture2d` and its kin, `Traversable`, `Instances`, `TriangleVertices`, `Callable` and `Callables` have an owner on the host",
    note = "a field is taken for a view by its type's name or by `#[view]`: give a type of your own another name, or take `#[view]` away"
)]
pub unsafe trait View: DeviceData {
    /// The owner.
    type Owner: Clone;
    /// The view of what the owner owns.
    fn of(owner: &Self::Owner, keep: &mut KeepAlive) -> Self;
}

// SAFETY: the owner is kept.
unsafe impl<T: Element> View for Slice<T> {
    type Owner = Buffer<T>;
    fn of(owner: &Buffer<T>, keep: &mut KeepAlive) -> Self {
        keep.keep(Kept::Memory(owner.memory.clone()));
        // SAFETY: the buffer has `len` aligned elements (`from_memory`), and `keep` holds it.
        unsafe { Self::from_raw([owner.memory.address(), owner.len as u64]) }
    }
}

// SAFETY: the owner is kept.
unsafe impl<T: Element> View for SliceMut<T> {
    type Owner = Buffer<T>;
    fn of(owner: &Buffer<T>, keep: &mut KeepAlive) -> Self {
        keep.keep(Kept::Memory(owner.memory.clone()));
        // SAFETY: as for `Slice`.
        unsafe { Self::from_raw([owner.memory.address(), owner.len as u64]) }
    }
}

// SAFETY: the owner is kept.
unsafe impl<T: Element> View for SliceMut2d<T> {
    type Owner = Buffer2d<T>;
    fn of(owner: &Buffer2d<T>, keep: &mut KeepAlive) -> Self {
        keep.keep(Kept::Memory(owner.buffer.memory.clone()));
        let [width, height] = owner.size;
        // SAFETY: the buffer has `width * height` aligned elements (`Buffer2d::new`), and `keep` holds it.
        unsafe { Self::from_raw((owner.buffer.memory.address(), [width, height])) }
    }
}

// SAFETY: the owner is kept.
unsafe impl View for Traversable {
    type Owner = World;
    fn of(owner: &World, keep: &mut KeepAlive) -> Self {
        keep.keep(Kept::Traced(owner.clone()));
        // SAFETY: the owner keeps the handle alive (`World::new`), and `keep` holds it.
        unsafe { Self::from_raw(owner.handle) }
    }
}

// SAFETY: the owner is kept.
unsafe impl View for Instances {
    type Owner = InstanceTable;
    fn of(owner: &InstanceTable, keep: &mut KeepAlive) -> Self {
        keep.keep(Kept::Read(owner.ias.clone()));
        // SAFETY: as for `Traversable`; and `InstanceTable::new`.
        unsafe { Self::from_raw([owner.ias.handle, owner.len.into()]) }
    }
}

// SAFETY: the owner is kept.
unsafe impl View for TriangleVertices {
    type Owner = TriangleTable;
    fn of(owner: &TriangleTable, keep: &mut KeepAlive) -> Self {
        let counts = View::of(&owner.counts, keep);
        keep.keep(Kept::Read(owner.gas.clone()));
        // SAFETY: as for `Traversable`; and `TriangleTable::new`.
        unsafe { Self::from_raw((owner.gas.handle, counts)) }
    }
}

macro_rules! texture {
    ($($name:ident),*) => {$(
        // SAFETY: the owner is kept.
        unsafe impl<T: Texel> View for $name<T> {
            type Owner = Texture<Self>;
            fn of(owner: &Texture<Self>, keep: &mut KeepAlive) -> Self {
                keep.keep(Kept::Texture(owner.memory.clone()));
                // SAFETY: the owner has the view's shape and channels (`Texture::from_memory`), and `keep` holds it.
                unsafe { Self::from_raw(owner.memory.number()) }
            }
        }
    )*};
}
texture!(Texture1d, Texture2d, Texture2dArray, Texture3d, TextureCube);
