//! The vertices of the triangle that was hit (guide 13.9).

use super::Cx;
use core::arch::asm;
use glam::Vec3;

impl Cx {
    #[inline(always)]
    pub fn triangle_vertices(&self) -> [Vec3; 3] {
        let (a, b, c, d, e, f, g, h, i): (f32, f32, f32, f32, f32, f32, f32, f32, f32);
        // SAFETY: the hit is a triangle's, by the context's type.
        unsafe {
            asm!(
                "{{ .reg .f32 f<9>;",
                "call (f0, f1, f2, f3, f4, f5, f6, f7, f8), _optix_get_triangle_vertex_data_current_hit, ();",
                "mov.b32 {a}, f0; mov.b32 {b}, f1; mov.b32 {c}, f2;",
                "mov.b32 {d}, f3; mov.b32 {e}, f4; mov.b32 {f}, f5;",
                "mov.b32 {g}, f6; mov.b32 {h}, f7; mov.b32 {i}, f8; }}",
                a = out(reg32) a, b = out(reg32) b, c = out(reg32) c,
                d = out(reg32) d, e = out(reg32) e, f = out(reg32) f,
                g = out(reg32) g, h = out(reg32) h, i = out(reg32) i,
                options(pure, nomem, nostack, preserves_flags)
            )
        };
        [Vec3::new(a, b, c), Vec3::new(d, e, f), Vec3::new(g, h, i)]
    }
}
