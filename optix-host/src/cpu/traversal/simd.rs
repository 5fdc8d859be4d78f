//! Instruction sets, eight lanes each, and the test of boxes: in plain Rust and for AVX2. A kind of primitive that is tested with
//! vectors has a trait of its own, which each instruction set implements beside that kind.
//!
//! Both forms do the same IEEE operations in the same order, without fused multiply-add, so their results are
//! bit-identical and a launch gives the same image on every machine.

use super::bvh::{Lanes, Node, WIDTH};
use super::primitive::triangle::TriangleSimd;
use super::ray::BoxRay;

/// A piece of work that is compiled once for each instruction set.
pub trait Task {
    type Output;

    fn run<S: Simd>(self, simd: S) -> Self::Output;
}

/// An instruction set; a value of the type is the proof that the machine has it.
pub trait Simd: Copy + TriangleSimd {
    /// Runs `task` in a function that is compiled with this instruction set.
    fn run<T: Task>(self, task: T) -> T::Output;

    /// Bit `i` tells whether the ray meets child box `i` at a depth in `[ray.depth_min, depth_max]`; `near[i]` is then
    /// where it enters, at least `depth_min`.
    fn boxes(self, node: &Node, ray: &BoxRay, depth_max: f32, near: &mut Lanes) -> u32;
}

/// Plain Rust.
#[derive(Clone, Copy, Debug)]
pub struct Portable;

/// The operand order of `vmaxps`, `vminps`.
#[inline(always)]
pub fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[inline(always)]
pub fn min(a: f32, b: f32) -> f32 {
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
}

#[cfg(target_arch = "x86_64")]
pub use avx2::{Avx2, load};

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
    }

    #[target_feature(enable = "avx2,bmi1")]
    fn run<T: Task>(simd: Avx2, task: T) -> T::Output {
        task.run(simd)
    }

    #[inline]
    #[target_feature(enable = "avx2,bmi1")]
    pub fn load(lanes: &Lanes) -> __m256 {
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
}
