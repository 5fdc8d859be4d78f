//! The primitive and the hit (guide 13.4, 13.7, 13.9).

use super::Cx;
use crate::words::WordBuffer;
use core::arch::asm;
use glam::{Vec2, Vec3};

impl Cx {
    #[inline(always)]
    pub fn primitive_index(&self) -> u32 {
        get_u32!("_optix_read_primitive_idx")
    }
    #[inline(always)]
    pub fn sbt_gas_index(&self) -> u32 {
        get_u32!("_optix_read_sbt_gas_idx")
    }
    #[inline(always)]
    pub fn instance_id(&self) -> u32 {
        get_u32!("_optix_read_instance_id")
    }
    #[inline(always)]
    pub fn instance_index(&self) -> u32 {
        get_u32!("_optix_read_instance_idx")
    }
    #[inline(always)]
    pub fn hit_kind(&self) -> u32 {
        get_u32!("_optix_get_hit_kind")
    }

    #[inline(always)]
    pub fn barycentrics(&self) -> Vec2 {
        let (u, v): (f32, f32);
        // SAFETY: the hit is a triangle's, by the context's type.
        unsafe {
            asm!(
                "{{ .reg .f32 f<2>; call (f0, f1), _optix_get_triangle_barycentrics, ();",
                "mov.b32 {u}, f0; mov.b32 {v}, f1; }}",
                u = out(reg32) u,
                v = out(reg32) v,
                options(pure, nomem, nostack, preserves_flags)
            )
        };
        Vec2::new(u, v)
    }

    #[inline(always)]
    pub fn attributes(&self, count: usize) -> WordBuffer {
        let mut words = WordBuffer::ZERO;
        macro_rules! get {
            ($($i:literal)*) => {$(
                if count > $i {
                    words.0[$i] = get_u32!(concat!("_optix_get_attribute_", $i));
                }
            )*};
        }
        get!(0 1 2 3 4 5 6 7);
        words
    }

    #[inline(always)]
    pub fn triangle_vertices(&self) -> [Vec3; 3] {
        let v: [f32; 9];
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
        v = [a, b, c, d, e, f, g, h, i];
        [Vec3::new(v[0], v[1], v[2]), Vec3::new(v[3], v[4], v[5]), Vec3::new(v[6], v[7], v[8])]
    }
}
