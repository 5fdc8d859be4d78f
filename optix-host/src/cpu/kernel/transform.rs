//! Affine maps in double precision.

/// A 3x4 row-major affine map held in `f64`.
///
/// Instance matrices are given in `f32`; their inverses and products are formed and applied in `f64` and rounded once
/// at the end, so a chain of instances costs a transformed point no more than about 1 ulp of its largest term.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine(pub [f64; 12]);

impl Affine {
    pub const IDENTITY: Self = Self([1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0.]);

    pub fn from_f32(m: &[f32; 12]) -> Self {
        Self(m.map(f64::from))
    }

    /// The elements rounded to `f32`.
    pub fn to_f32(self) -> [f32; 12] {
        self.0.map(|x| x as f32)
    }

    #[inline(always)]
    pub fn point(&self, p: [f64; 3]) -> [f64; 3] {
        let m = &self.0;
        let row = |r: usize| m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3];
        [row(0), row(1), row(2)]
    }

    #[inline(always)]
    pub fn vector(&self, v: [f64; 3]) -> [f64; 3] {
        let m = &self.0;
        let row = |r: usize| m[4 * r] * v[0] + m[4 * r + 1] * v[1] + m[4 * r + 2] * v[2];
        [row(0), row(1), row(2)]
    }

    /// The map that applies `inner` first and `self` after it.
    pub fn after(&self, inner: &Self) -> Self {
        let (a, b) = (&self.0, &inner.0);
        Self(std::array::from_fn(|i| {
            let (r, c) = (i / 4, i % 4);
            let sum: f64 = (0..3).map(|k| a[4 * r + k] * b[4 * k + c]).sum();
            if c == 3 { sum + a[4 * r + 3] } else { sum }
        }))
    }

    /// The inverse, or `None` if the linear part is singular to working precision.
    ///
    /// The determinant is a sum of six products of three elements; `f64` evaluates it to within `2^-50` of the sum of
    /// their magnitudes, and a value below that can't be told from 0.
    pub fn inverse(&self) -> Option<Self> {
        let m = &self.0;
        let at = |r: usize, c: usize| m[4 * (r % 3) + c % 3];
        let cofactor = |r: usize, c: usize| at(r + 1, c + 1) * at(r + 2, c + 2) - at(r + 1, c + 2) * at(r + 2, c + 1);
        let determinant: f64 = (0..3).map(|c| at(0, c) * cofactor(0, c)).sum();
        let magnitude: f64 = (0..3)
            .map(|c| {
                let minor = at(1, c + 1) * at(2, c + 2);
                let other = at(1, c + 2) * at(2, c + 1);
                at(0, c).abs() * (minor.abs() + other.abs())
            })
            .sum();
        if determinant.abs() <= magnitude * 2f64.powi(-50) {
            return None;
        }
        let mut inverse = [0.0; 12];
        for r in 0..3 {
            for c in 0..3 {
                inverse[4 * r + c] = cofactor(c, r) / determinant;
            }
        }
        let linear = Self(inverse);
        let moved = linear.vector([m[3], m[7], m[11]]);
        for r in 0..3 {
            inverse[4 * r + 3] = -moved[r];
        }
        inverse.iter().all(|x| x.is_finite()).then_some(Self(inverse))
    }

    /// The largest row sum of magnitudes of the linear part: how much the map can lengthen a vector in the maximum norm.
    pub fn norm(&self) -> f64 {
        self.0.chunks_exact(4).map(|row| row[..3].iter().map(|x| x.abs()).sum()).fold(0.0, f64::max)
    }
}
