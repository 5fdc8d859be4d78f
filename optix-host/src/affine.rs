//! Affine maps in double precision, and which of them have an inverse: one answer for scenes and both machines.

/// A 3x4 row-major affine map held in `f64`.
///
/// Instance matrices are given in `f32`; their inverses and products are formed and applied in `f64` and rounded once
/// at the end, so a chain of instances costs a transformed point no more than about 1 ulp of its largest term.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine(pub [f64; 12]);

impl Affine {
    /// Moves nothing.
    pub const IDENTITY: Self = Self([1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0.]);

    /// The elements, which are held without rounding.
    pub fn from_f32(m: &[f32; 12]) -> Self {
        Self(m.map(f64::from))
    }

    /// The elements rounded to `f32`.
    pub fn to_f32(self) -> [f32; 12] {
        self.0.map(|x| x as f32)
    }

    /// Where a point goes.
    #[inline(always)]
    pub fn point(&self, p: [f64; 3]) -> [f64; 3] {
        let m = &self.0;
        let row = |r: usize| m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3];
        [row(0), row(1), row(2)]
    }

    /// Where a vector goes: without translation.
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

    /// The inverse of a map whose elements are those of an `f32` matrix, or `None` if it is of no use: where the linear part is
    /// singular, or the inverse, rounded to `f32`, is not finite or is singular itself.
    ///
    /// Scales down to about 3e-39 thus have one, whatever the determinant would be in `f32`. The cofactors are exact but for
    /// one rounding, and so is the determinant; the elements are good to a few units in the last place of `f64`.
    pub fn inverse(&self) -> Option<Self> {
        let m = &self.0;
        let determinant = determinant(m);
        if determinant == 0.0 {
            return None;
        }
        let mut inverse = [0.0; 12];
        for r in 0..3 {
            for c in 0..3 {
                let [minor, other] = minors(m, c, r);
                inverse[4 * r + c] = (minor - other) / determinant;
            }
        }
        let moved = Self(inverse).vector([m[3], m[7], m[11]]);
        for r in 0..3 {
            inverse[4 * r + 3] = -moved[r];
        }
        let rounded = inverse.map(|x| f64::from(x as f32));
        (rounded.iter().all(|x| x.is_finite()) && self::determinant(&rounded) != 0.0).then_some(Self(inverse))
    }

    /// The largest row sum of magnitudes of the linear part: how much the map can lengthen a vector in the maximum norm.
    pub fn norm(&self) -> f64 {
        self.0.chunks_exact(4).map(|row| row[..3].iter().map(|x| x.abs()).sum()).fold(0.0, f64::max)
    }
}

/// The two products whose difference is the cofactor of an element of the linear part: exact where the elements are `f32`s.
fn minors(m: &[f64; 12], r: usize, c: usize) -> [f64; 2] {
    let at = |r: usize, c: usize| m[4 * (r % 3) + c % 3];
    [at(r + 1, c + 1) * at(r + 2, c + 2), at(r + 1, c + 2) * at(r + 2, c + 1)]
}

/// The determinant of the linear part, whose elements are `f32`s: 0 only if it is, and good to `2^-30` of its value.
fn determinant(m: &[f64; 12]) -> f64 {
    let minors = [0, 1, 2].map(|c| minors(m, 0, c));
    let quick: f64 = (0..3).map(|c| m[c] * (minors[c][0] - minors[c][1])).sum();
    // What the roundings of that are fractions of: six of `2^-53`.
    let size: f64 = (0..3).map(|c| m[c].abs() * (minors[c][0].abs() + minors[c][1].abs())).sum();
    if quick.abs() > size * 2f64.powi(-20) {
        return quick;
    }
    // Six products of three, each in two parts without an error.
    let mut parts = [0.0; 12];
    for c in 0..3 {
        for (i, minor) in [minors[c][0], -minors[c][1]].into_iter().enumerate() {
            let product = m[c] * minor;
            parts[4 * c + 2 * i] = product;
            parts[4 * c + 2 * i + 1] = m[c].mul_add(minor, -product);
        }
    }
    exact_sum(&parts)
}

/// The sum, rounded about once: 0 only if it is (Shewchuk, "Adaptive Precision Floating-Point Arithmetic", 1997).
fn exact_sum(terms: &[f64]) -> f64 {
    let mut partials: Vec<f64> = Vec::with_capacity(terms.len());
    for &term in terms {
        let (mut sum, mut kept) = (term, 0);
        for i in 0..partials.len() {
            let (large, small) = if sum.abs() < partials[i].abs() { (partials[i], sum) } else { (sum, partials[i]) };
            sum = large + small;
            let rest = small - (sum - large);
            if rest != 0.0 {
                partials[kept] = rest;
                kept += 1;
            }
        }
        partials.truncate(kept);
        partials.push(sum);
    }
    partials.iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn linear(m: [[f32; 3]; 3]) -> Affine {
        let [a, b, c] = m;
        Affine::from_f32(&[a[0], a[1], a[2], 3.0, b[0], b[1], b[2], -5.0, c[0], c[1], c[2], 7.0])
    }

    /// The inverse takes the map to the identity, within what `f64` loses to the matrix's condition.
    #[track_caller]
    fn inverts(map: &Affine) {
        let inverse = map.inverse().unwrap_or_else(|| panic!("{map:?} has no inverse"));
        let slack = 1e-14 * map.norm() * inverse.norm() + 1e-14;
        for (product, one) in
            inverse.after(map).0.iter().zip(Affine::IDENTITY.0).enumerate().filter(|(i, _)| i % 4 < 3).map(|(_, p)| p)
        {
            assert!((product - one).abs() <= slack, "{map:?} times {inverse:?}");
        }
    }

    #[test]
    fn tiny_and_sheared_maps_have_inverses() {
        for e in -37..=37 {
            let x: f32 = format!("1e{e}").parse().unwrap();
            inverts(&linear([[x, 0.0, 0.0], [0.0, x, 0.0], [0.0, 0.0, x]]));
            inverts(&linear([[0.0, x, 0.0], [0.0, 0.0, 1.0], [-x, 0.0, 0.0]]));
            inverts(&linear([[x, 0.0, 0.0], [0.0, 1.0 / x, 0.0], [x, 1.0, 1.0]]));
        }
        // The determinant is 2^-24.
        inverts(&linear([[1.000_244_1, 1.0, 0.0], [1.000_488_3, 1.000_244_1, 0.0], [0.0, 0.0, 1.0]]));
        // No f32 is the inverse of the smallest ones.
        for x in [1e-39, 1e-45] {
            assert_eq!(linear([[x, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]).inverse(), None);
        }
        for x in [0.0, f32::NAN, f32::INFINITY] {
            assert_eq!(linear([[x, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]).inverse(), None);
        }
    }

    /// Against integers: matrices that are singular, and their neighbours, at every scale.
    #[test]
    fn a_determinant_is_0_only_if_it_is() {
        let mut state = 1u64;
        let mut random = |bits: u32| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> (64 - bits)) as i128 - (1 << (bits - 1))
        };
        let mut singular = 0;
        for round in 0..20_000 {
            let bits = [3, 8, 16, 22][round % 4];
            let mut m = [[0i128; 3]; 3].map(|row| row.map(|_| random(bits)));
            if round % 3 > 0 {
                // The last row lies in the plane of the others, or beside it by the least there is.
                let [k, l] = [random(2), random(2)];
                m[2] = core::array::from_fn(|c| k * m[0][c] + l * m[1][c]);
                m[2][round % 2] += i128::from(round % 3 == 2);
            }
            let exact: i128 = (0..3)
                .map(|c| {
                    let [d, e] = [(c + 1) % 3, (c + 2) % 3];
                    m[0][c] * (m[1][d] * m[2][e] - m[1][e] * m[2][d])
                })
                .sum();
            let scale = 2f32.powi([0, -100, 90][round / 7 % 3]);
            let map = linear(m.map(|row| row.map(|x| x as f32 * scale)));
            let found = determinant(&map.0);
            let expected = exact as f64 * f64::from(scale).powi(3);
            assert!((found - expected).abs() <= expected.abs() * 2f64.powi(-29), "{m:?}: {found:e} for {expected:e}");
            assert_eq!(found == 0.0, exact == 0, "{m:?}");
            singular += u32::from(exact == 0);
        }
        assert!(singular > 5000, "{singular}");
    }
}
