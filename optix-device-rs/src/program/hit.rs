//! What programs may ask about the primitive, the hit and the transforms (guide 13.4, 13.7, 13.9, 13.11).

use super::{AnyHit, Attributes, ClosestHit, Intersection};
use crate::check::OnTriangles;
use crate::spawn::SurfacePoint;
use crate::words::part;
use glam::{Mat3, Vec2, Vec3};

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

macro_rules! primitive_queries {
    ($($name:ident),*) => {$(
        impl<P, A> $name<P, A> {
            /// Index of the primitive in its build input, plus that input's offset.
            #[inline(always)]
            pub fn primitive_index(&self) -> u32 {
                self.cx.primitive_index()
            }
            /// Index of the primitive's record in its GAS.
            #[inline(always)]
            pub fn sbt_gas_index(&self) -> u32 {
                self.cx.sbt_gas_index()
            }
            /// The application's id of the instance; `None` where a GAS is traced without one.
            #[inline(always)]
            pub fn instance_id(&self) -> Option<u32> {
                let id = self.cx.instance_id();
                (id != !0).then_some(id)
            }
            /// Index of the instance in its IAS; 0 without an instance.
            #[inline(always)]
            pub fn instance_index(&self) -> u32 {
                self.cx.instance_index()
            }
            /// From object to world space.
            #[inline(always)]
            pub fn object_to_world(&self) -> Transform {
                Transform::from_rows(self.cx.object_to_world())
            }
            /// From world to object space.
            #[inline(always)]
            pub fn world_to_object(&self) -> Transform {
                Transform::from_rows(self.cx.world_to_object())
            }
        }
    )*};
}
primitive_queries!(Intersection, AnyHit, ClosestHit);

macro_rules! object_ray {
    ($($name:ident),*) => {$(
        impl<P, A> $name<P, A> {
            /// Ray origin in object space (guide 13.5).
            #[inline(always)]
            pub fn object_ray_origin(&self) -> Vec3 {
                self.cx.object_ray_origin()
            }
            /// Ray direction in object space, scaled as the transform does: `t` means the same in both spaces.
            #[inline(always)]
            pub fn object_ray_direction(&self) -> Vec3 {
                self.cx.object_ray_direction()
            }
        }
    )*};
}
object_ray!(Intersection, AnyHit);

/// Which side of a triangle a ray came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Face {
    /// Vertices run counter-clockwise as seen from the ray's origin.
    Front,
    /// Clockwise.
    Back,
}

macro_rules! hit_queries {
    ($($name:ident),*) => {$(
        impl<P, A: Attributes> $name<P, A> {
            /// What the intersection reported.
            #[inline(always)]
            pub fn attributes(&self) -> A {
                // SAFETY: `pipeline!` made sure that the intersection programs of this hit group report an `A`.
                unsafe { A::load(part(&self.cx.attributes(A::WORDS).0, 0, A::WORDS)) }
            }
            /// The kind that the intersection program reported, 0 to 127; 254 and 255 for triangles (guide 13.7).
            #[inline(always)]
            pub fn hit_kind(&self) -> u8 {
                self.cx.hit_kind() as u8
            }
        }

        // Of hits on triangles. The bound is on the methods, not the impl: so its message is shown.
        impl<P, A> $name<P, A> {
            /// Weights of the second and third vertex (guide 13.4).
            #[inline(always)]
            pub fn barycentrics(&self) -> Vec2
            where
                A: OnTriangles,
            {
                self.cx.barycentrics()
            }
            /// Which side was hit; an instance may flip it.
            #[inline(always)]
            pub fn face(&self) -> Face
            where
                A: OnTriangles,
            {
                if self.cx.hit_kind() == 254 { Face::Front } else { Face::Back }
            }
            /// The triangle's vertices in object space (guide 13.9).
            #[inline(always)]
            pub fn vertices(&self) -> [Vec3; 3]
            where
                A: OnTriangles,
            {
                self.cx.triangle_vertices()
            }
        }
    )*};
}
hit_queries!(AnyHit, ClosestHit);

impl<P, A> ClosestHit<P, A> {
    /// The hit point in world space with its normal and error bound, to shade and to spawn rays from.
    #[inline(always)]
    pub fn surface_point(&self) -> SurfacePoint
    where
        A: OnTriangles,
    {
        SurfacePoint::of_triangle(
            self.vertices(),
            self.barycentrics(),
            &self.object_to_world(),
            &self.world_to_object(),
        )
    }
}
