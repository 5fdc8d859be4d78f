//! The vertices of triangles: of the one that was hit, and of any in a structure (guide 13.9).

use super::Cx;
use core::arch::asm;
use glam::Vec3;

/// An intrinsic that gives three vertices, with what goes before its call. Needs `unsafe`: what it asks about is to be a
/// triangle.
macro_rules! vertices {
    ($($before:literal,)? call $call:literal $(, $name:ident = $class:ident $value:expr)*) => {{
        let (a, b, c, d, e, f, g, h, i): (f32, f32, f32, f32, f32, f32, f32, f32, f32);
        asm!(
            "{{ .reg .f32 f<9>;",
            $($before,)?
            concat!("call (f0, f1, f2, f3, f4, f5, f6, f7, f8), ", $call, ";"),
            "mov.b32 {a}, f0; mov.b32 {b}, f1; mov.b32 {c}, f2;",
            "mov.b32 {d}, f3; mov.b32 {e}, f4; mov.b32 {f}, f5;",
            "mov.b32 {g}, f6; mov.b32 {h}, f7; mov.b32 {i}, f8; }}",
            $($name = in($class) $value,)*
            a = out(reg32) a, b = out(reg32) b, c = out(reg32) c,
            d = out(reg32) d, e = out(reg32) e, f = out(reg32) f,
            g = out(reg32) g, h = out(reg32) h, i = out(reg32) i,
            options(pure, nomem, nostack, preserves_flags)
        );
        [Vec3::new(a, b, c), Vec3::new(d, e, f), Vec3::new(g, h, i)]
    }};
}

impl Cx {
    #[inline(always)]
    pub fn triangle_vertices(&self) -> [Vec3; 3] {
        // SAFETY: the hit is a triangle's, by the context's type.
        unsafe { vertices!(call "_optix_get_triangle_vertex_data_current_hit, ()") }
    }

    /// # Safety
    /// `gas` is of triangles and was built with random vertex access; `sbt_gas_index` is a record of one of its build
    /// inputs, which has a triangle `primitive`.
    #[inline(always)]
    pub unsafe fn triangle_vertices_from_handle(&self, gas: u64, primitive: u32, sbt_gas_index: u32) -> [Vec3; 3] {
        // SAFETY: the caller's.
        unsafe {
            vertices!(
                ".reg .f32 time; mov.f32 time, 0f00000000;",
                call "_optix_get_triangle_vertex_data_from_handle, ({gas}, {primitive}, {sbt}, time)",
                gas = reg64 gas,
                primitive = reg32 primitive,
                sbt = reg32 sbt_gas_index
            )
        }
    }
}
