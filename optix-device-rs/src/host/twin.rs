//! Host twins: structs in which owning buffers stand in the place of device views.

use super::{Buffer, Buffer2d, DeviceId, InstanceTable, Memory, TriangleTable, World};
use crate::accel::{Instances, TriangleVertices};
use crate::data::DeviceData;
use crate::ray::Traversable;
use crate::view::{Element, Slice, SliceMut, SliceMut2d};
use crate::words::FromRaw;
use std::any::Any;
use std::sync::Arc;
use std::vec::Vec;

/// What a launch or a shader binding table keeps alive, gathered while twins are lowered to device data.
pub struct KeepAlive {
    pub(super) owners: Vec<Arc<dyn Any + Send + Sync>>,
    pub(super) devices: Vec<(DeviceId, &'static str)>,
}

impl KeepAlive {
    /// Nothing yet.
    ///
    /// # Safety
    /// What views are made with it are used no longer than its owners are kept.
    pub const unsafe fn new() -> Self {
        Self { owners: Vec::new(), devices: Vec::new() }
    }

    fn memory(&mut self, memory: &Arc<dyn Memory>) {
        self.devices.push((memory.device(), "buffer"));
        let owner: Arc<dyn Any + Send + Sync> = memory.clone();
        self.owners.push(owner);
    }

    /// Keeps the structure of a handle.
    fn structure(&mut self, world: &World) -> u64 {
        self.devices.push((world.device, "acceleration structure"));
        self.owners.push(world.owner.clone());
        world.handle
    }

    /// What is to be kept, so far.
    pub fn owners(&self) -> &[Arc<dyn Any + Send + Sync>] {
        &self.owners
    }

    /// What is to be kept.
    pub fn into_owners(self) -> Vec<Arc<dyn Any + Send + Sync>> {
        self.owners
    }

    /// The first thing that is not `device`'s, by kind.
    pub fn foreign(&self, device: DeviceId) -> Option<&'static str> {
        self.devices.iter().find(|(id, _)| *id != device).map(|(_, what)| *what)
    }
}

/// Host data that becomes device data: a struct without views is its own twin, a buffer is the twin of a view.
#[diagnostic::on_unimplemented(
    message = "`{Self}` can't be handed to a device",
    label = "is not the host twin of any device type",
    note = "a struct `Paint` that holds views is filled in on the host as `PaintHost`, with a buffer or the like in each view's place; any \
            other needs `#[derive(SbtRecord)]` or `#[derive(DeviceData)]`"
)]
pub trait Twin {
    /// What programs see.
    type Device: DeviceData;
    /// The device data; owners of what it points to go to `keep`.
    fn lower(&self, keep: &mut KeepAlive) -> Self::Device;
}

impl Twin for () {
    type Device = ();
    fn lower(&self, _: &mut KeepAlive) {}
}

/// Which host type stands in for a view in a host twin. Used by the derives.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a view of device memory",
    label = "only `Slice` and its kin, `Traversable`, `Instances`, `TriangleVertices`, `Callable` and `Callables` have an owner on the host",
    note = "a field is taken for a view by its type's name or by `#[view]`: give a type of your own another name, or take `#[view]` away"
)]
pub trait View: DeviceData {
    /// The owner.
    type Owner: Clone;
    /// The view of what the owner owns.
    fn of(owner: &Self::Owner, keep: &mut KeepAlive) -> Self;
}

impl<T: Element> View for Slice<T> {
    type Owner = Buffer<T>;
    fn of(owner: &Buffer<T>, keep: &mut KeepAlive) -> Self {
        keep.memory(&owner.memory);
        // SAFETY: the buffer has `len` aligned elements (`from_memory`), and `keep` holds it.
        unsafe { Self::from_raw([owner.memory.address(), owner.len as u64]) }
    }
}

impl<T: Element> View for SliceMut<T> {
    type Owner = Buffer<T>;
    fn of(owner: &Buffer<T>, keep: &mut KeepAlive) -> Self {
        keep.memory(&owner.memory);
        // SAFETY: as for `Slice`.
        unsafe { Self::from_raw([owner.memory.address(), owner.len as u64]) }
    }
}

impl<T: Element> View for SliceMut2d<T> {
    type Owner = Buffer2d<T>;
    fn of(owner: &Buffer2d<T>, keep: &mut KeepAlive) -> Self {
        keep.memory(&owner.buffer.memory);
        let [width, height] = owner.size;
        // SAFETY: the buffer has `width * height` aligned elements (`Buffer2d::new`), and `keep` holds it.
        unsafe { Self::from_raw((owner.buffer.memory.address(), [width, height])) }
    }
}

impl View for Traversable {
    type Owner = World;
    fn of(owner: &World, keep: &mut KeepAlive) -> Self {
        // SAFETY: the owner keeps the handle alive (`World::new`), and `keep` holds it.
        unsafe { Self::from_raw(keep.structure(owner)) }
    }
}

impl View for Instances {
    type Owner = InstanceTable;
    fn of(owner: &InstanceTable, keep: &mut KeepAlive) -> Self {
        // SAFETY: as for `Traversable`; and `InstanceTable::new`.
        unsafe { Self::from_raw([keep.structure(&owner.ias), owner.len.into()]) }
    }
}

impl View for TriangleVertices {
    type Owner = TriangleTable;
    fn of(owner: &TriangleTable, keep: &mut KeepAlive) -> Self {
        let counts = View::of(&owner.counts, keep);
        // SAFETY: as for `Traversable`; and `TriangleTable::new`.
        unsafe { Self::from_raw((keep.structure(&owner.gas), counts)) }
    }
}
