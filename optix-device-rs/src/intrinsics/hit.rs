//! The primitive and the hit, of whatever kind (guide 13.4, 13.7). What is asked about one kind of primitive is in its file.

#[cfg(target_arch = "nvptx64")]
use super::Invocation;
use crate::primitive::{Attributes, PrimitiveType};
use crate::program::HitKind;
#[cfg(target_arch = "nvptx64")]
use crate::words::WordBuffer;
use crate::words::part;
#[cfg(target_arch = "nvptx64")]
use core::arch::asm;

device_functions! {
    in primitive else HasPrimitive {
        /// Index of the primitive in its build input, plus that input's offset.
        "optixGetPrimitiveIndex"
        fn primitive_index(&self) -> u32 {
            ptx { get_u32!("_optix_read_primitive_idx") }
            host { self.frame().hit.primitive_index }
        }

        /// Index of the primitive's record in its GAS.
        "optixGetSbtGASIndex"
        fn sbt_gas_index(&self) -> u32 {
            ptx { get_u32!("_optix_read_sbt_gas_idx") }
            host { self.frame().hit.sbt_gas_index }
        }
    }

    in hit else HasHit {
        /// The kind that the intersection program reported, or that of a built-in primitive (guide 13.7).
        "optixGetHitKind"
        fn hit_kind(&self) -> HitKind {
            ptx { HitKind::of_number(get_u32!("_optix_get_hit_kind") as u8) }
            host { HitKind::of_number(self.frame().hit.kind) }
        }

        /// The kind of primitive that was hit; of a stored kind: [`HitKind::primitive_type`].
        "optixGetPrimitiveType()"
        fn primitive_type(&self) -> PrimitiveType {
            self.hit_kind().primitive_type()
        }
    }
}

methods! {
    in hit {
        /// What the intersection reported (`optixGetAttribute_0` and its kin).
        #[inline(always)]
        pub fn attributes(&self) -> A
        where
            A: Attributes,
        {
            let words = body! {
                ptx { self.invocation.attributes(A::WORDS).0 }
                host { self.frame().hit.attributes }
            };
            // SAFETY: `pipeline!` made sure that the intersection programs of this hit group report an `A`.
            unsafe { A::load(part(&words, 0, A::WORDS)) }
        }
    }
    others {
        #[doc(hidden)]
        pub fn attributes(&self)
        where
            Self: crate::check::HasHit,
        {
            unreachable!()
        }
    }
}

#[cfg(target_arch = "nvptx64")]
impl Invocation {
    /// The first `count` attribute words; the others are zero. `count` is a constant at every call.
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

/// The kind of primitive that a hit kind is of (`optixGetPrimitiveType` with an argument); legal in all programs.
#[inline(always)]
pub fn primitive_type_of(kind: u8) -> PrimitiveType {
    body! {
        ptx {
            // SAFETY: defined for every hit kind.
            let number =
                unsafe { get_of!("_optix_get_primitive_type_from_hit_kind", reg32 u32::from(kind), reg32 as u32) };
            PrimitiveType::from_optix(number)
        }
        host { PrimitiveType::of_hit_kind(kind).unwrap_or(PrimitiveType::Custom) }
    }
}

/// Whether a hit kind says that the back of a built-in primitive was hit (`optixIsBackFaceHit`); legal in all programs.
#[inline(always)]
pub fn is_back_face(kind: u8) -> bool {
    body! {
        ptx {
            // SAFETY: defined for every hit kind.
            unsafe { get_of!("_optix_get_backface_from_hit_kind", reg32 u32::from(kind), reg32 as u32) != 0 }
        }
        host { kind == HitKind::TRIANGLE_BACK_FACE.get() }
    }
}
