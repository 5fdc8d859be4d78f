//! Owners of textures.

use super::DeviceId;
use crate::texture::{Lookup, TextureView};
use core::marker::PhantomData;
use std::any::Any;
use std::sync::Arc;

/// A texture on a device. For backends.
///
/// # Safety
/// Programs of `device` may look up the texture with `number` while this value lives, from launches that keep it.
pub unsafe trait TextureMemory: Any + Send + Sync {
    /// Whose it is.
    fn device(&self) -> DeviceId;
    /// What views on that device hold: a texture object on a GPU, a [`Handle`](super::Handle)'s number on the CPU.
    fn number(&self) -> u64;
}

/// What lookups ask on the CPU.
pub trait Sampler: Send + Sync {
    /// Four channels, of which those that the texture does not have mean nothing.
    fn sample(&self, lookup: &Lookup) -> [f32; 4];
}

/// A texture that programs see as a `V`, such as [`Texture2d<Vec4>`](crate::texture::Texture2d). A clone is the same texture.
pub struct Texture<V> {
    pub(super) memory: Arc<dyn TextureMemory>,
    view: PhantomData<fn() -> V>,
}

impl<V> Clone for Texture<V> {
    fn clone(&self) -> Self {
        Self { memory: self.memory.clone(), view: PhantomData }
    }
}

impl<V> core::fmt::Debug for Texture<V> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("Texture")
    }
}

impl<V: TextureView> Texture<V> {
    /// For backends.
    ///
    /// # Safety
    /// The texture has the shape and the channels of `V`.
    #[doc(hidden)]
    pub unsafe fn from_memory(memory: Arc<dyn TextureMemory>) -> Self {
        Self { memory, view: PhantomData }
    }
}
