//! The vector form of the triangle test, in plain Rust and for AVX2: see [`simd`](crate::cpu::traversal::simd).

use super::intersect::{Block, EDGE_ABSOLUTE, EDGE_RELATIVE, Sheared};
use crate::cpu::traversal::bvh::WIDTH;
use crate::cpu::traversal::ray::ShearRay;
#[cfg(target_arch = "x86_64")]
use crate::cpu::traversal::simd::Avx2;
use crate::cpu::traversal::simd::{Portable, max, min};

/// What an instruction set does with triangles.
pub trait TriangleSimd {
    /// Bit `i` is clear only if the line of the ray surely passes beside triangle `i`, or if that lies, with all its
    /// corners, at smaller or at greater depths than `depths`. Writes the corners in the ray's sheared space.
    fn triangles(self, block: &Block, ray: &ShearRay, depths: [f32; 2], sheared: &mut Sheared) -> u32;
}

impl TriangleSimd for Portable {
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
impl TriangleSimd for Avx2 {
    #[inline(always)]
    fn triangles(self, block: &Block, ray: &ShearRay, depths: [f32; 2], sheared: &mut Sheared) -> u32 {
        // SAFETY: a value of `Self` is the proof that the machine has AVX2 and BMI1.
        unsafe { avx2::triangles(block, ray, depths, sheared) }
    }
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use super::*;
    use crate::cpu::traversal::bvh::Lanes;
    use crate::cpu::traversal::simd::load;
    use std::arch::x86_64::*;

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
    pub fn triangles(block: &Block, ray: &ShearRay, [near, far]: [f32; 2], sheared: &mut Sheared) -> u32 {
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
