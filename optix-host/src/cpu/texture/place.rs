//! Where a coordinate lies among the texels of a dimension.

use crate::texture::AddressMode;

/// Places between texels are multiples of one part in so many.
pub const FRACTION: i32 = 256;
/// Normalized coordinates are multiples of one part in so many.
const NORMALIZED: f64 = (1 << 21) as f64;

/// A coordinate in a dimension of so many texels.
#[derive(Clone, Copy)]
pub struct Place {
    /// In texels; finite.
    at: f64,
    len: i64,
    mode: AddressMode,
}

/// Two neighbours, none where there is border, and how far it is from the first to the second, in 256ths.
#[derive(Clone, Copy)]
pub struct Row {
    pub texels: [Option<usize>; 2],
    pub fraction: i32,
}

impl Place {
    pub fn new(coordinate: f64, len: u32, normalized: bool, mode: AddressMode) -> Self {
        let coordinate = if coordinate.is_finite() { coordinate } else { 0.0 };
        let texels = f64::from(len);
        // Far outside one place is as good as another; near by, arithmetic is exact.
        let at = if !normalized {
            coordinate.clamp(-2.0, texels + 2.0)
        } else {
            let near = match mode {
                AddressMode::Wrap => coordinate - coordinate.floor(),
                AddressMode::Mirror => coordinate - 2.0 * (coordinate / 2.0).floor(),
                // Two texels away, even if there is only one.
                AddressMode::Clamp | AddressMode::Border => coordinate.clamp(-2.0, 3.0),
            };
            (near * NORMALIZED).floor() / NORMALIZED * texels
        };
        Self { at, len: len.into(), mode }
    }

    /// The edge of a dimension of one texel.
    pub fn at_edge(mode: AddressMode) -> Self {
        Self { at: 0.0, len: 1, mode }
    }

    /// The texel that it is in.
    pub fn nearest(self) -> Option<usize> {
        self.texel(self.at.floor() as i64)
    }

    /// The texels whose middles it is between.
    pub fn around(self) -> Row {
        let at = ((self.at - 0.5) * f64::from(FRACTION) + 0.5).floor() as i64;
        let first = at.div_euclid(FRACTION.into());
        let fraction = at.rem_euclid(FRACTION.into()) as i32;
        Row { texels: [self.texel(first), self.texel(first + 1)], fraction }
    }

    fn texel(self, index: i64) -> Option<usize> {
        let inside = match self.mode {
            AddressMode::Wrap => index.rem_euclid(self.len),
            AddressMode::Mirror => {
                let there_and_back = index.rem_euclid(2 * self.len);
                there_and_back.min(2 * self.len - 1 - there_and_back)
            }
            AddressMode::Clamp => index.clamp(0, self.len - 1),
            AddressMode::Border if (0..self.len).contains(&index) => index,
            AddressMode::Border => return None,
        };
        Some(inside as usize)
    }
}
