//! Affine maps between spaces.

use glam::{Mat3, Vec3};

/// An affine map: what takes points from one space to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    rows: [[f32; 4]; 3],
}

impl Transform {
    pub(crate) fn from_rows(rows: [[f32; 4]; 3]) -> Self {
        Self { rows }
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
