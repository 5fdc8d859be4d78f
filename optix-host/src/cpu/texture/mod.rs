//! Textures on the CPU, looked up as a GPU was measured to do (docs/measurements.md).

mod cube;
mod place;
mod texel;

use crate::texture::{FilterMode, Format, Sampling, TextureInput, TextureShape};
use optix_device_rs::host::{DeviceId, Handle, Sampler, TextureMemory};
use optix_device_rs::texture::{Level, Lookup};
use place::{FRACTION, Place, Row};
use texel::Texels;

/// A texture.
pub(super) struct CpuTexture {
    device: DeviceId,
    handle: Handle,
    shape: TextureShape,
    format: Format,
    sampling: Sampling,
    /// As the format stores it.
    border: [f32; 4],
    levels: Vec<LevelTexels>,
}

/// A level.
struct LevelTexels {
    size: [u32; 3],
    texels: Texels,
}

impl CpuTexture {
    pub fn new(device: DeviceId, input: &TextureInput<'_>) -> Self {
        let format = input.format();
        let sampling = *input.sampling();
        let texels = |bytes| Texels::new(format, sampling.srgb, bytes);
        let levels = input.levels().map(|(size, bytes)| LevelTexels { size, texels: texels(bytes) }).collect();
        let border = sampling.border.map(|channel| texel::stored(format, channel));
        Self { device, handle: Handle::issue(), shape: input.shape(), format, sampling, border, levels }
    }

    pub fn handle(&self) -> &Handle {
        &self.handle
    }

    /// What level of detail a lookup is at.
    fn level_of_detail(&self, level: Level) -> f32 {
        let lod = match level {
            Level::Lod(lod) => lod,
            Level::Gradient(gradient) => {
                let size = self.levels[0].size.map(|n| n as f32);
                let dimensions = match self.shape {
                    TextureShape::D1 => 1,
                    TextureShape::D2 | TextureShape::D2Array | TextureShape::Cube => 2,
                    TextureShape::D3 => 3,
                };
                // Of a plane the length is approximate, as on a GPU: 5 % too short to 6 % too long.
                let length = |step: [f32; 3]| {
                    let [x, y, z] = core::array::from_fn(|axis| (step[axis] * size[axis]).abs());
                    match dimensions {
                        1 => x,
                        2 => x.max(y) + x.min(y) * (11.0 / 32.0),
                        _ => (x * x + y * y + z * z).sqrt(),
                    }
                };
                gradient.map(length).into_iter().fold(0.0, f32::max).log2()
            }
        };
        // Not a number is level 0.
        lod.max(0.0).min((self.levels.len() - 1) as f32)
    }

    /// What is at a place of one level.
    fn in_level(&self, level: usize, coordinates: [f64; 3], layer: u32) -> [f32; 4] {
        let LevelTexels { size, texels } = &self.levels[level];
        let [width, height, depth] = *size;
        let Sampling { address, filter, normalized, .. } = self.sampling;
        let [x, y, z] = coordinates;
        let along = |axis: usize, coordinate: f64, len: u32| Place::new(coordinate, len, normalized, address[axis]);
        let columns = along(0, x, width);
        // A single row is looked up at the edge of a rectangle of that height, so at a border it has half of that.
        let rows = match self.shape {
            TextureShape::D1 => Place::at_edge(address[0]),
            _ => along(1, y, height),
        };
        let slice = match self.shape {
            TextureShape::D1 | TextureShape::D2 => 0,
            TextureShape::D2Array | TextureShape::Cube => layer.min(depth - 1) as usize,
            TextureShape::D3 => {
                let slices = along(2, z, depth);
                return match filter {
                    FilterMode::Point => self.one(texels, size, [columns.nearest(), rows.nearest(), slices.nearest()]),
                    FilterMode::Linear => self.eight(texels, size, [columns.around(), rows.around(), slices.around()]),
                };
            }
        };
        match filter {
            FilterMode::Point => self.one(texels, size, [columns.nearest(), rows.nearest(), Some(slice)]),
            FilterMode::Linear => self.four(texels, size, columns.around(), rows.around(), slice),
        }
    }

    /// A texel as it is stored, or the border.
    fn stored(&self, texels: &Texels, [width, height, _]: &[u32; 3], at: [Option<usize>; 3]) -> [f32; 4] {
        match at {
            [Some(x), Some(y), Some(z)] => texels.get((z * *height as usize + y) * *width as usize + x),
            _ => self.border,
        }
    }

    fn one(&self, texels: &Texels, size: &[u32; 3], at: [Option<usize>; 3]) -> [f32; 4] {
        self.stored(texels, size, at).map(|channel| texel::value(self.format, self.sampling.srgb, channel.into()))
    }

    /// A sum of texels with weights in 256ths.
    fn sum<const N: usize>(&self, texels: &Texels, size: &[u32; 3], terms: [(i32, [Option<usize>; 3]); N]) -> [f32; 4] {
        let mut sum = [0.0f64; 4];
        for (weight, at) in terms {
            if weight != 0 {
                let texel = self.stored(texels, size, at);
                for (sum, channel) in sum.iter_mut().zip(texel) {
                    *sum += f64::from(weight) * f64::from(channel);
                }
            }
        }
        sum.map(|sum| texel::filtered(self.format, self.sampling.srgb, sum / f64::from(FRACTION)))
    }

    /// Four texels, weighted: the product of the two fractions is rounded, and what it leaves of each goes to the others.
    fn four(&self, texels: &Texels, size: &[u32; 3], columns: Row, rows: Row, slice: usize) -> [f32; 4] {
        let z = Some(slice);
        let [[w00, w01], [w10, w11]] = split([FRACTION - columns.fraction, columns.fraction], rows.fraction);
        let ([x0, x1], [y0, y1]) = (columns.texels, rows.texels);
        let terms = [(w00, [x0, y0, z]), (w10, [x1, y0, z]), (w01, [x0, y1, z]), (w11, [x1, y1, z])];
        self.sum(texels, size, terms)
    }

    /// Eight texels, weighted: first by columns and slices, then each of the four weights by rows.
    fn eight(&self, texels: &Texels, size: &[u32; 3], [columns, rows, slices]: [Row; 3]) -> [f32; 4] {
        let ([x0, x1], [y0, y1], [z0, z1]) = (columns.texels, rows.texels, slices.texels);
        let [left, right] = split([FRACTION - columns.fraction, columns.fraction], slices.fraction);
        let [[w000, w010], [w001, w011]] = split(left, rows.fraction);
        let [[w100, w110], [w101, w111]] = split(right, rows.fraction);
        let terms = [
            (w000, [x0, y0, z0]),
            (w100, [x1, y0, z0]),
            (w010, [x0, y1, z0]),
            (w110, [x1, y1, z0]),
            (w001, [x0, y0, z1]),
            (w101, [x1, y0, z1]),
            (w011, [x0, y1, z1]),
            (w111, [x1, y1, z1]),
        ];
        self.sum(texels, size, terms)
    }
}

/// Splits each weight by a fraction, in whole 256ths: what is left, and the share.
fn split([first, second]: [i32; 2], fraction: i32) -> [[i32; 2]; 2] {
    // The sum is split, too, so that rounding takes nothing from it: where both are all there is, the shares add up to `fraction`.
    let share = (second * fraction + FRACTION / 2) / FRACTION;
    let rest = if first + second == FRACTION { fraction - share } else { (first * fraction + FRACTION / 2) / FRACTION };
    [[first - rest, rest], [second - share, share]]
}

impl Sampler for CpuTexture {
    fn sample(&self, lookup: &Lookup) -> [f32; 4] {
        let (coordinates, layer, level) = match self.shape {
            TextureShape::Cube => cube::on_face(lookup),
            _ => (lookup.coordinates.map(f64::from), lookup.layer, lookup.level),
        };
        let lod = self.level_of_detail(level);
        let at = |level| self.in_level(level, coordinates, layer);
        match self.sampling.mip_filter {
            FilterMode::Point => at((lod + 0.5) as usize),
            FilterMode::Linear => {
                let lod = (lod * FRACTION as f32) as usize;
                let (level, fraction) = (lod / FRACTION as usize, lod % FRACTION as usize);
                if fraction == 0 {
                    return at(level);
                }
                let share = fraction as f32 / FRACTION as f32;
                let (larger, smaller) = (at(level), at(level + 1));
                core::array::from_fn(|channel| larger[channel] * (1.0 - share) + smaller[channel] * share)
            }
        }
    }
}

// SAFETY: views hold the handle's number, which a launch that keeps this value knows as this texture.
unsafe impl TextureMemory for CpuTexture {
    fn device(&self) -> DeviceId {
        self.device
    }

    fn number(&self) -> u64 {
        self.handle.number()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::{AddressMode, TexelFormat};

    fn texture<F: TexelFormat>(shape: TextureShape, size: [u32; 3], levels: &[&[F]], sampling: Sampling) -> CpuTexture {
        CpuTexture::new(DeviceId(1), &TextureInput::new(shape, size, levels, sampling).unwrap())
    }

    fn at(texture: &CpuTexture, coordinates: [f32; 3]) -> [f32; 4] {
        texture.sample(&Lookup { coordinates, layer: 0, level: Level::Lod(0.0) })
    }

    /// Weights of 256ths mix neighbours, and the middle of a texel is that texel.
    #[test]
    fn a_row_is_filtered_in_256_steps() {
        let sampling = Sampling { address: [AddressMode::Clamp; 3], normalized: false, ..Sampling::default() };
        let row = texture(TextureShape::D1, [3, 1, 1], &[&[0.0f32, 256.0, 512.0]], sampling);
        for (x, value) in [(0.5, 0.0), (1.5, 256.0), (1.0, 128.0), (0.5 + 1.0 / 256.0, 1.0), (0.5 + 0.4 / 256.0, 0.0)] {
            assert_eq!(at(&row, [x, 0.0, 0.0])[0], value, "{x}");
        }
        for (x, value) in [(-5.0, 0.0), (9.0, 512.0), (f32::NAN, 0.0), (f32::INFINITY, 0.0), (f32::MAX, 512.0)] {
            assert_eq!(at(&row, [x, 0.0, 0.0])[0], value, "{x}");
        }
    }

    #[test]
    fn coordinates_outside_are_what_the_address_mode_says() {
        let row = |mode| {
            let sampling =
                Sampling { address: [mode; 3], filter: FilterMode::Point, border: [9.0; 4], ..Sampling::default() };
            texture(TextureShape::D2, [4, 1, 1], &[&[0.0f32, 1.0, 2.0, 3.0]], sampling)
        };
        let seen = |mode| {
            let row = row(mode);
            [-0.9f32, -0.1, 0.1, 0.9, 1.1, 1.9, 2.1].map(|x| at(&row, [x, 0.5, 0.0])[0])
        };
        assert_eq!(seen(AddressMode::Wrap), [0.0, 3.0, 0.0, 3.0, 0.0, 3.0, 0.0]);
        assert_eq!(seen(AddressMode::Mirror), [3.0, 0.0, 0.0, 3.0, 3.0, 0.0, 0.0]);
        assert_eq!(seen(AddressMode::Clamp), [0.0, 0.0, 0.0, 3.0, 3.0, 3.0, 3.0]);
        assert_eq!(seen(AddressMode::Border), [9.0, 9.0, 0.0, 3.0, 9.0, 9.0, 9.0]);
    }

    /// Filtering keeps what all texels have in common, whatever the place: weights sum to one.
    #[test]
    fn weights_sum_to_one() {
        let flat = [0.75f32; 4 * 5 * 3];
        let mut rng = optix_device_rs::rng::Pcg32::new(1, 2);
        for (shape, size) in
            [(TextureShape::D1, [60, 1, 1]), (TextureShape::D2, [12, 5, 1]), (TextureShape::D3, [4, 5, 3])]
        {
            let texture = texture(shape, size, &[&flat], Sampling::default());
            for _ in 0..10_000 {
                let place = [(); 3].map(|()| rng.next_f32() * 4.0 - 2.0);
                assert_eq!(at(&texture, place)[0], 0.75, "{shape:?} {place:?}");
            }
        }
    }

    /// What a GPU gave: texels of 8 bits, filtered.
    #[test]
    fn filtered_texels_of_8_bits_have_16() {
        let sampling = Sampling { address: [AddressMode::Clamp; 3], ..Sampling::default() };
        let row = texture(TextureShape::D2, [2, 1, 1], &[&[0u8, 255]], sampling);
        for step in 0..=256u32 {
            let u = 0.25 + 0.5 * step as f32 / 256.0;
            let expected = (f64::from(step) * 65535.0 / 256.0 + 0.5).floor() / 65535.0;
            assert_eq!(at(&row, [u, 0.5, 0.0])[0], expected as f32, "{step}");
        }
    }

    #[test]
    fn levels_are_chosen_and_mixed() {
        let levels: [&[f32]; 3] = [&[0.0; 16], &[1.0; 4], &[2.0]];
        let with =
            |mip_filter| texture(TextureShape::D2, [4, 4, 1], &levels, Sampling { mip_filter, ..Sampling::default() });
        let (mixed, nearest) = (with(FilterMode::Linear), with(FilterMode::Point));
        let seen = |texture: &CpuTexture, level| texture.sample(&Lookup { coordinates: [0.3; 3], layer: 0, level })[0];
        for (lod, value) in [(-3.0, 0.0), (0.0, 0.0), (0.25, 0.25), (1.5, 1.5), (7.0, 2.0), (f32::NAN, 0.0)] {
            assert_eq!(seen(&mixed, Level::Lod(lod)), value, "{lod}");
            assert_eq!(seen(&nearest, Level::Lod(lod)), (value + 0.5).floor().min(2.0), "{lod}");
        }
        // Two texels from lookup to lookup is level 1.
        let gradient = Level::Gradient([[0.5, 0.0, 0.0], [0.0, 0.1, 0.0]]);
        assert_eq!(seen(&mixed, gradient), 1.0);
        assert_eq!(seen(&mixed, Level::Gradient([[0.0; 3]; 2])), 0.0);
    }

    #[test]
    fn srgb_is_decoded_before_it_is_mixed() {
        let sampling = Sampling { srgb: true, address: [AddressMode::Clamp; 3], ..Sampling::default() };
        let row = texture(TextureShape::D2, [2, 1, 1], &[&[[0u8, 10, 188, 128], [255; 4]]], sampling);
        let texel = at(&row, [0.25, 0.5, 0.0]);
        for (seen, expected) in texel.iter().zip([0.0, 10.0 / 255.0 / 12.92, 0.502_886_5, 128.0 / 255.0]) {
            assert!((seen - expected).abs() < 1e-6, "{texel:?}");
        }
        assert!((at(&row, [0.5, 0.5, 0.0])[0] - 0.5).abs() < 1e-6);
    }
}
