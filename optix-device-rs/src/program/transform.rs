//! Affine maps between spaces.

use glam::{Mat3, Vec3};

/// An affine map: what takes points from one space to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    rows: [[f32; 4]; 3],
    /// Element by element, what the roundings of applying the map are proportional to: the magnitudes of `rows`, or more
    /// where the map was composed in `f32`. See [`SurfacePoint`](crate::spawn::SurfacePoint).
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
