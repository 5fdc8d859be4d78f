//! The primitive and the hit (guide 13.4, 13.7).

use super::Cx;
use crate::primitive::PrimitiveType;
use crate::words::WordBuffer;
use core::arch::asm;
use glam::Vec2;

/// The kind of primitive that a hit kind is of; legal in all programs.
#[inline(always)]
pub fn primitive_type_of(kind: u8) -> PrimitiveType {
    // SAFETY: defined for every hit kind.
    let number = unsafe { get_of!("_optix_get_primitive_type_from_hit_kind", reg32 u32::from(kind), reg32 as u32) };
    PrimitiveType::from_optix(number)
}

/// Whether a hit kind says that the back of a built-in primitive was hit; legal in all programs.
#[inline(always)]
pub fn is_back_face(kind: u8) -> bool {
    // SAFETY: defined for every hit kind.
    unsafe { get_of!("_optix_get_backface_from_hit_kind", reg32 u32::from(kind), reg32 as u32) != 0 }
}

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
    pub fn gas_traversable_handle(&self) -> u64 {
        let handle: u64;
        // SAFETY: a pure query, legal in the programs whose context offers it.
        unsafe {
            asm!(
                "call ({h}), _optix_get_gas_traversable_handle, ();",
                h = out(reg64) handle,
                options(pure, nomem, nostack, preserves_flags)
            )
        };
        handle
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
}
