//! Affine maps between spaces.

use glam::{Mat3, Vec3};

/// An affine map: what takes points from one space to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    rows: [[f32; 4]; 3],
    /// Element by element, what the roundings of applying the map are proportional to: the magnitudes of `rows`, or more
    /// where the map was composed in `f32`. See [`SurfacePoint`](crate::spawn::SurfacePoint).
    sizes: [[f32; 4]; 3],
}

impl Transform {
    #[inline(always)]
    pub(crate) fn from_rows(rows: [[f32; 4]; 3]) -> Self {
        Self { rows, sizes: rows.map(|row| row.map(f32::abs)) }
    }

    /// The map that applies `inner` first and `self` after it, composed in `f32`.
    #[cfg(any(target_arch = "nvptx64", test))]
    #[inline(always)]
    pub(crate) fn after(&self, inner: &Self) -> Self {
        Self { rows: concatenate(self.rows, inner.rows), sizes: concatenate(self.sizes, inner.sizes) }
    }

    /// Composed of `levels` maps, by [`Transform::after`]. A map of one level rounds three times on a term, its translation
    /// included; composing rounds four times more on each of both for every further level. So where a bound counts `n >= 7`
    /// roundings of terms and `n' >= 3` of translations for one level, `levels * n` and `(3 * levels - 2) * n'` cover all.
    #[cfg(any(target_arch = "nvptx64", test))]
    #[inline(always)]
    pub(crate) fn of_levels(self, levels: u32) -> Self {
        let (terms, translation) = (levels as f32, (3 * levels - 2) as f32);
        Self { sizes: self.sizes.map(|[x, y, z, w]| [x * terms, y * terms, z * terms, w * translation]), ..self }
    }

    #[inline(always)]
    pub(crate) fn sizes(&self) -> [[f32; 4]; 3] {
        self.sizes
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
