//! Affine maps between spaces.

use glam::{Mat3, Vec3};

/// An affine map: what takes points from one space to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    rows: [[f32; 4]; 3],
    /// Element by element, what the roundings of applying the map are proportional to: the magnitudes of `rows`, or more
    /// where the map was composed in `f32`. See [`SurfacePoint`](crate::surface::SurfacePoint).
    sizes: [[f32; 4]; 3],
    /// How many maps were composed in `f32`.
    levels: u32,
}

impl Transform {
    #[inline(always)]
    pub(crate) fn from_rows(rows: [[f32; 4]; 3]) -> Self {
        Self { rows, sizes: rows.map(|row| row.map(f32::abs)), levels: 1 }
    }

    /// The map that applies `inner` first and `self` after it, composed in `f32`.
    #[cfg(any(target_arch = "nvptx64", test))]
    #[inline(always)]
    pub(crate) fn after(&self, inner: &Self) -> Self {
        Self {
            rows: concatenate(self.rows, inner.rows),
            sizes: concatenate(self.sizes, inner.sizes),
            levels: self.levels + inner.levels,
        }
    }

    /// What the error of a vector `v >= 0` grows to, at most, when it is mapped.
    #[inline(always)]
    pub(crate) fn magnitudes(&self, v: Vec3) -> Vec3 {
        let row = |[x, y, z, _]: [f32; 4]| x * v.x + y * v.y + z * v.z;
        let [x, y, z] = self.sizes;
        Vec3::new(row(x), row(y), row(z))
    }

    /// What rounding the terms of a mapped point counts with along a normal with the magnitudes `n` of the space that the map
    /// leads to, on each axis of the space that it leads from; and what rounding the translation counts with.
    ///
    /// One map rounds three times on a term, its translation included; composing two rounds four times more on each, and then
    /// both round. So where a bound counts at least 7 roundings of terms and 3 of translations for one map, `levels`
    /// and `3 levels - 2` times as many cover a composed one.
    #[inline(always)]
    pub(crate) fn magnitudes_along(&self, n: Vec3) -> (Vec3, f32) {
        let [x, y, z] = self.sizes;
        let column = |i: usize| x[i] * n.x + y[i] * n.y + z[i] * n.z;
        let (terms, translation) = (self.levels as f32, (3 * self.levels - 2) as f32);
        (Vec3::new(column(0), column(1), column(2)) * terms, column(3) * translation)
    }

    /// Three rows of four, row-major, translation in the last column: OptiX's order.
    #[inline(always)]
    pub fn rows(&self) -> [[f32; 4]; 3] {
        self.rows
    }

    /// Maps a point (with translation).
    #[inline(always)]
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.vector(p) + Vec3::new(self.rows[0][3], self.rows[1][3], self.rows[2][3])
    }

    /// Maps a vector (without translation).
    #[inline(always)]
    pub fn vector(&self, v: Vec3) -> Vec3 {
        let [x, y, z] = self.rows;
        Vec3::new(
            x[0] * v.x + x[1] * v.y + x[2] * v.z,
            y[0] * v.x + y[1] * v.y + y[2] * v.z,
            z[0] * v.x + z[1] * v.y + z[2] * v.z,
        )
    }

    /// Maps a normal of the space that this transform leads *to* back to where it leads *from*: the transpose of the
    /// linear part. So world normals come from object normals by the world-to-object transform's `normal`.
    #[inline(always)]
    pub fn normal(&self, n: Vec3) -> Vec3 {
        let [x, y, z] = self.rows;
        Vec3::new(
            x[0] * n.x + y[0] * n.y + z[0] * n.z,
            x[1] * n.x + y[1] * n.y + z[1] * n.z,
            x[2] * n.x + y[2] * n.y + z[2] * n.z,
        )
    }

    /// The linear part.
    #[inline(always)]
    pub fn linear(&self) -> Mat3 {
        let [x, y, z] = self.rows;
        Mat3::from_cols_array(&[x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]])
    }
}

/// `a` after `b`, both affine.
#[cfg(any(target_arch = "nvptx64", test))]
#[inline(always)]
fn concatenate(a: [[f32; 4]; 3], b: [[f32; 4]; 3]) -> [[f32; 4]; 3] {
    a.map(|row| {
        core::array::from_fn(|column| {
            let linear = row[0] * b[0][column] + row[1] * b[1][column] + row[2] * b[2][column];
            if column == 3 { linear + row[3] } else { linear }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Pcg32;
    use crate::surface::gamma;

    /// The arithmetic of a device that applies one map after the other, against `f64`.
    #[test]
    fn sizes_cover_the_rounding_of_composed_maps() {
        let mut rng = Pcg32::new(3, 1);
        let mut worst = [0.0f64; 5];
        for _ in 0..200_000 {
            let levels = 1 + rng.next_u32() as usize % 4;
            let mut number = |range: f32| {
                let fraction = 2.0 * rng.next_f32() - 1.0;
                fraction * f32::exp2(range * (2.0 * rng.next_f32() - 1.0))
            };
            let maps: [Transform; 4] = core::array::from_fn(|_| {
                let mut row = || [number(3.0), number(3.0), number(3.0), number(12.0)];
                Transform::from_rows([row(), row(), row()])
            });
            let x = Vec3::new(number(12.0), number(12.0), number(12.0));
            let n = Vec3::new(number(1.0), number(1.0), number(1.0)).normalize();
            let maps = &maps[..levels];

            let one_by_one = maps.iter().fold(x, |x, map| map.point(x));
            let composed = maps[1..].iter().fold(maps[0], |all, map| map.after(&all));
            let exact = maps.iter().fold(x.to_array().map(f64::from), |x, map| {
                map.rows.map(|r| (0..3).map(|k| f64::from(r[k]) * x[k]).sum::<f64>() + f64::from(r[3]))
            });

            let height = |p: [f64; 3]| (0..3).map(|k| f64::from(n[k]) * p[k]).sum::<f64>();
            let of = |p: Vec3| (height(p.to_array().map(f64::from)) - height(exact)).abs();
            let (terms, translation) = composed.magnitudes_along(n.abs());
            // One more than of a hit point, where the last addition cancels.
            let bound = f64::from(terms.dot(x.abs()) * gamma(8) + translation * gamma(3));
            // Both at once, as in the bound of a hit point.
            let share = (of(one_by_one) + of(composed.point(x))) / bound;
            worst[levels] = worst[levels].max(share);
        }
        std::println!("shares of the bound, by levels: {:?}", &worst[1..]);
        assert!(worst.iter().all(|&share| share < 1.0), "{worst:?}");
        assert!(worst[1..].iter().all(|&share| share > 0.05), "{worst:?}");
    }
}
