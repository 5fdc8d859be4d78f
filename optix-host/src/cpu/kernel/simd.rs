//! The two vector kernels, eight lanes each, portable and for AVX2.
//!
//! Both forms do the same IEEE operations in the same order, without fused multiply-add, so their results are
//! bit-identical and a launch gives the same image on every machine.

use super::bvh::{Lanes, Node, WIDTH};
use super::primitive::triangle::test::{Block, EDGE_ABSOLUTE, EDGE_RELATIVE, Sheared};
use super::ray::{BoxRay, ShearRay};

/// A piece of work that is compiled once for each instruction set.
pub trait Task {
    type Output;

    fn run<S: Simd>(self, simd: S) -> Self::Output;
}

/// An instruction set; a value of the type is the proof that the machine has it.
pub trait Simd: Copy {
    /// Runs `task` in a function that is compiled with this instruction set.
    fn run<T: Task>(self, task: T) -> T::Output;

    /// Bit `i` tells whether the ray meets child box `i` at a depth in `[ray.depth_min, depth_max]`; `near[i]` is then
    /// where it enters, at least `depth_min`.
    fn boxes(self, node: &Node, ray: &BoxRay, depth_max: f32, near: &mut Lanes) -> u32;

    /// Bit `i` is clear only if the line of the ray surely passes beside triangle `i`, or if that lies, with all its
    /// corners, at smaller or at greater depths than `depths`. Writes the corners in the ray's sheared space.
    fn triangles(self, block: &Block, ray: &ShearRay, depths: [f32; 2], sheared: &mut Sheared) -> u32;
}

/// Plain Rust.
#[derive(Clone, Copy, Debug)]
pub struct Portable;

/// The operand order of `vmaxps`, `vminps`.
#[inline(always)]
fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[inline(always)]
fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

impl Simd for Portable {
    // Not inlined, as the other instruction set's is not: callers hold both, and one is never used.
    #[inline(never)]
    fn run<T: Task>(self, task: T) -> T::Output {
        task.run(self)
    }

    #[inline(always)]
    fn boxes(self, node: &Node, ray: &BoxRay, depth_max: f32, near: &mut Lanes) -> u32 {
        let mut far = [0.0; WIDTH];
        let planes = |upper: [bool; 3]| [0, 1, 2].map(|a| &node.planes[a][usize::from(upper[a])].0);
        let [nx, ny, nz] = planes(ray.backward);
        let [fx, fy, fz] = planes(ray.backward.map(|b| !b));
        let [ix, iy, iz] = ray.inverse;
        let ([ox, oy, oz], [px, py, pz]) = (ray.near_origin, ray.far_origin);
        for i in 0..WIDTH {
            let x = (nx[i] - ox) * ix;
            let y = (ny[i] - oy) * iy;
            let z = (nz[i] - oz) * iz;
            near.0[i] = max(max(x, y), max(z, ray.depth_min));
            let x = (fx[i] - px) * ix;
            let y = (fy[i] - py) * iy;
            let z = (fz[i] - pz) * iz;
            far[i] = min(min(x, y), min(z, depth_max));
        }
        (0..WIDTH).fold(0, |mask, i| mask | (u32::from(near.0[i] <= far[i]) << i))
    }

    #[inline(always)]
    fn triangles(self, block: &Block, ray: &ShearRay, [near, far]: [f32; 2], sheared: &mut Sheared) -> u32 {
        for (corner, out) in block.corners.iter().zip(&mut *sheared) {
            let [x, y, z] = ray.axes.map(|a| &corner[a as usize].0);
            let [ox, oy, oz] = ray.origin;
            for i in 0..WIDTH {
                let depth = z[i] - oz;
                out[0].0[i] = (x[i] - ox) - ray.slope[0] * depth;
                out[1].0[i] = (y[i] - oy) - ray.slope[1] * depth;
                out[2].0[i] = depth;
            }
        }
        let [a, b, c] = &*sheared;
        let (mut above, mut below, mut beside) = (0, 0, 0);
        for i in 0..WIDTH {
            let [za, zb, zc] = [a, b, c].map(|corner| if ray.major < 0.0 { -corner[2].0[i] } else { corner[2].0[i] });
            beside |= u32::from(max(max(za, zb), zc) < near) << i;
            beside |= u32::from(min(min(za, zb), zc) > far) << i;
        }
        for (from, to) in [(c, b), (a, c), (b, a)] {
            for i in 0..WIDTH {
                let p = from[0].0[i] * to[1].0[i];
                let q = from[1].0[i] * to[0].0[i];
                let value = p - q;
                let bound = (p.abs() + q.abs()) * EDGE_RELATIVE + EDGE_ABSOLUTE;
                above |= u32::from(value > bound) << i;
                below |= u32::from(value < -bound) << i;
            }
        }
        !(above & below | beside) & 0xff
    }
}

#[cfg(target_arch = "x86_64")]
pub use avx2::Avx2;

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use std::arch::x86_64::*;

    use super::*;

    /// AVX2; made only by [`Avx2::detect`].
    #[derive(Clone, Copy, Debug)]
    pub struct Avx2(());

    impl Avx2 {
        #[inline]
        pub fn detect() -> Option<Self> {
            (is_x86_feature_detected!("avx2") && is_x86_feature_detected!("bmi1")).then_some(Self(()))
        }
    }

    impl Simd for Avx2 {
        #[inline(always)]
        fn run<T: Task>(self, task: T) -> T::Output {
            // SAFETY: `detect` has seen AVX2 and BMI1, and nothing else makes a value of `Self`.
            unsafe { run(self, task) }
        }

        #[inline(always)]
        fn boxes(self, node: &Node, ray: &BoxRay, depth_max: f32, near: &mut Lanes) -> u32 {
            // SAFETY: as in `run`.
            unsafe { boxes(node, ray, depth_max, near) }
        }

        #[inline(always)]
        fn triangles(self, block: &Block, ray: &ShearRay, depths: [f32; 2], sheared: &mut Sheared) -> u32 {
            // SAFETY: as in `run`.
            unsafe { triangles(block, ray, depths, sheared) }
        }
    }

    #[target_feature(enable = "avx2,bmi1")]
    fn run<T: Task>(simd: Avx2, task: T) -> T::Output {
        task.run(simd)
    }

    #[inline]
    #[target_feature(enable = "avx2,bmi1")]
    fn load(lanes: &Lanes) -> __m256 {
        bytemuck::cast(lanes.0)
    }

    #[inline]
    #[target_feature(enable = "avx2,bmi1")]
    fn slab(planes: &[Lanes; 2], upper: bool, origin: f32, inverse: f32) -> __m256 {
        let distance = _mm256_sub_ps(load(&planes[usize::from(upper)]), _mm256_set1_ps(origin));
        _mm256_mul_ps(distance, _mm256_set1_ps(inverse))
    }

    #[inline]
    #[target_feature(enable = "avx2,bmi1")]
    fn boxes(node: &Node, ray: &BoxRay, depth_max: f32, near: &mut Lanes) -> u32 {
        let [nx, ny, nz] =
            [0, 1, 2].map(|a| slab(&node.planes[a], ray.backward[a], ray.near_origin[a], ray.inverse[a]));
        let [fx, fy, fz] =
            [0, 1, 2].map(|a| slab(&node.planes[a], !ray.backward[a], ray.far_origin[a], ray.inverse[a]));
        let enter = _mm256_max_ps(_mm256_max_ps(nx, ny), _mm256_max_ps(nz, _mm256_set1_ps(ray.depth_min)));
        let leave = _mm256_min_ps(_mm256_min_ps(fx, fy), _mm256_min_ps(fz, _mm256_set1_ps(depth_max)));
        near.0 = bytemuck::cast(enter);
        _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(enter, leave)) as u32
    }

    #[inline]
    #[target_feature(enable = "avx2,bmi1")]
    fn shear(corner: &[Lanes; 3], ray: &ShearRay, out: &mut [Lanes; 3]) -> [__m256; 3] {
        let axis = |i: usize| _mm256_sub_ps(load(&corner[ray.axes[i] as usize]), _mm256_set1_ps(ray.origin[i]));
        let depth = axis(2);
        let slope = |i: usize| _mm256_mul_ps(_mm256_set1_ps(ray.slope[i]), depth);
        let sheared = [_mm256_sub_ps(axis(0), slope(0)), _mm256_sub_ps(axis(1), slope(1)), depth];
        *out =
            [Lanes(bytemuck::cast(sheared[0])), Lanes(bytemuck::cast(sheared[1])), Lanes(bytemuck::cast(sheared[2]))];
        sheared
    }

    #[inline]
    #[target_feature(enable = "avx2,bmi1")]
    fn triangles(block: &Block, ray: &ShearRay, [near, far]: [f32; 2], sheared: &mut Sheared) -> u32 {
        let [a, b, c] = &block.corners;
        let [out_a, out_b, out_c] = sheared;
        let (a, b, c) = (shear(a, ray, out_a), shear(b, ray, out_b), shear(c, ray, out_c));

        let sign = _mm256_set1_ps(-0.0);
        let down = if ray.major < 0.0 { sign } else { _mm256_setzero_ps() };
        let (za, zb, zc) = (_mm256_xor_ps(a[2], down), _mm256_xor_ps(b[2], down), _mm256_xor_ps(c[2], down));
        let deepest = _mm256_max_ps(_mm256_max_ps(za, zb), zc);
        let nearest = _mm256_min_ps(_mm256_min_ps(za, zb), zc);
        let beside = _mm256_or_ps(
            _mm256_cmp_ps::<_CMP_LT_OQ>(deepest, _mm256_set1_ps(near)),
            _mm256_cmp_ps::<_CMP_GT_OQ>(nearest, _mm256_set1_ps(far)),
        );

        let (relative, absolute) = (_mm256_set1_ps(EDGE_RELATIVE), _mm256_set1_ps(EDGE_ABSOLUTE));
        // Whether the edge function is surely positive, and surely negative.
        let side = |from: [__m256; 3], to: [__m256; 3]| {
            let p = _mm256_mul_ps(from[0], to[1]);
            let q = _mm256_mul_ps(from[1], to[0]);
            let value = _mm256_sub_ps(p, q);
            let size = _mm256_add_ps(_mm256_andnot_ps(sign, p), _mm256_andnot_ps(sign, q));
            let bound = _mm256_add_ps(_mm256_mul_ps(size, relative), absolute);
            (_mm256_cmp_ps::<_CMP_GT_OQ>(value, bound), _mm256_cmp_ps::<_CMP_LT_OQ>(value, _mm256_xor_ps(sign, bound)))
        };
        let (u, v, w) = (side(c, b), side(a, c), side(b, a));
        let above = _mm256_or_ps(_mm256_or_ps(u.0, v.0), w.0);
        let below = _mm256_or_ps(_mm256_or_ps(u.1, v.1), w.1);
        let out = _mm256_movemask_ps(_mm256_or_ps(_mm256_and_ps(above, below), beside)) as u32;
        !out & 0xff
    }
}
