//! Textures are made.

use crate::texture::{AddressMode, FilterMode, Sampling, TexelFormat, TextureInput};
use crate::{Device, Result};
use optix_device_rs::host::Texture;
use optix_device_rs::texture::{Texture1d, Texture2d, Texture2dArray, Texture3d, TextureCube, TextureView};
use std::marker::PhantomData;

/// Gathers what a texture is made of. Texels are given row by row, slice by slice; they are repeated, filtered, and looked up by
/// normalized coordinates unless it says otherwise.
pub struct TextureBuilder<'a, V, F> {
    device: &'a Device,
    size: [u32; 3],
    levels: Vec<&'a [F]>,
    sampling: Sampling,
    view: PhantomData<V>,
}

impl Device {
    /// A texture of one row.
    pub fn texture_1d<'a, F: TexelFormat>(
        &'a self,
        width: u32,
        texels: &'a [F],
    ) -> TextureBuilder<'a, Texture1d<F::Texel>, F> {
        self.texture([width, 1, 1], texels)
    }

    /// A texture of `size[1]` rows of `size[0]` texels: an image.
    ///
    /// ```
    /// # fn main() -> optix_host::Result<()> {
    /// use optix_host::{AddressMode, Device};
    /// let device = Device::cpu()?;
    /// let checks = [[255, 255, 255, 255], [0, 0, 0, 255], [0, 0, 0, 255], [255, 255, 255, 255u8]];
    /// let texture = device.texture_2d([2, 2], &checks).srgb().address(AddressMode::Mirror).build()?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn texture_2d<'a, F: TexelFormat>(
        &'a self,
        [width, height]: [u32; 2],
        texels: &'a [F],
    ) -> TextureBuilder<'a, Texture2d<F::Texel>, F> {
        self.texture([width, height, 1], texels)
    }

    /// A texture of so many images of one size.
    pub fn texture_2d_array<'a, F: TexelFormat>(
        &'a self,
        [width, height]: [u32; 2],
        layers: u32,
        texels: &'a [F],
    ) -> TextureBuilder<'a, Texture2dArray<F::Texel>, F> {
        self.texture([width, height, layers], texels)
    }

    /// A texture that is a box.
    pub fn texture_3d<'a, F: TexelFormat>(
        &'a self,
        size: [u32; 3],
        texels: &'a [F],
    ) -> TextureBuilder<'a, Texture3d<F::Texel>, F> {
        self.texture(size, texels)
    }

    /// A texture of six square images, the sides of a cube: +x, -x, +y, -y, +z, -z. Coordinates are clamped to each.
    pub fn texture_cube<'a, F: TexelFormat>(
        &'a self,
        width: u32,
        texels: &'a [F],
    ) -> TextureBuilder<'a, TextureCube<F::Texel>, F> {
        self.texture([width, width, 6], texels)
    }

    fn texture<'a, V, F>(&'a self, size: [u32; 3], texels: &'a [F]) -> TextureBuilder<'a, V, F> {
        TextureBuilder { device: self, size, levels: vec![texels], sampling: Sampling::default(), view: PhantomData }
    }
}

impl<'a, V: TextureView, F: TexelFormat<Texel = V::Texel>> TextureBuilder<'a, V, F> {
    /// The next smaller level of a mip-mapped texture: half of the one before on each side, rounded down, and 1 at least.
    pub fn mip_level(mut self, texels: &'a [F]) -> Self {
        self.levels.push(texels);
        self
    }

    /// What coordinates outside of the texture mean, in all dimensions. Those of a cube are always clamped.
    pub fn address(self, mode: AddressMode) -> Self {
        self.address_each([mode; 3])
    }

    /// The same, for each dimension.
    pub fn address_each(mut self, modes: [AddressMode; 3]) -> Self {
        self.sampling.address = modes;
        self
    }

    /// What lies between texels.
    pub fn filter(mut self, filter: FilterMode) -> Self {
        self.sampling.filter = filter;
        self
    }

    /// What lies between levels.
    pub fn mip_filter(mut self, filter: FilterMode) -> Self {
        self.sampling.mip_filter = filter;
        self
    }

    /// Coordinates count texels: the middle of the first one is at 0.5.
    pub fn unnormalized(mut self) -> Self {
        self.sampling.normalized = false;
        self
    }

    /// The colour around the texture, for [`AddressMode::Border`].
    pub fn border(mut self, colour: [f32; 4]) -> Self {
        self.sampling.border = colour;
        self
    }

    /// The first three of four channels of 8 bits are encoded by sRGB, and decoded before they are filtered.
    pub fn srgb(mut self) -> Self {
        self.sampling.srgb = true;
        self
    }

    /// Makes it.
    pub fn build(self) -> Result<Texture<V>> {
        let input = TextureInput::new(V::SHAPE, self.size, &self.levels, self.sampling)?;
        let memory = self.device.backend.create_texture(&input)?;
        // SAFETY: it was made with the shape of the view, of texels with its channels.
        Ok(unsafe { Texture::from_memory(memory) })
    }
}
