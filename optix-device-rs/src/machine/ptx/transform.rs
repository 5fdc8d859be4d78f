//! The transforms between a primitive and the world (guide 13.11).

use super::Cx;
use core::arch::asm;

impl Cx {
    /// Three rows of the object-to-world matrix.
    #[inline(always)]
    pub fn object_to_world(&self) -> [[f32; 4]; 3] {
        transform(Direction::ObjectToWorld)
    }

    /// Three rows of the world-to-object matrix.
    #[inline(always)]
    pub fn world_to_object(&self) -> [[f32; 4]; 3] {
        transform(Direction::WorldToObject)
    }
}

/// Which way a point goes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Direction {
    ObjectToWorld,
    WorldToObject,
}

/// Three rows of four from memory that does not change during a launch.
///
/// # Safety
/// `rows` is what a transform query returned: 48 bytes, aligned to 16, valid for the launch.
#[inline(always)]
unsafe fn rows(rows: u64) -> [[f32; 4]; 3] {
    let at = rows as *const [f32; 4];
    // SAFETY: the caller's.
    unsafe { [at.read(), at.add(1).read(), at.add(2).read()] }
}

/// `a` after `b`, both affine.
#[inline(always)]
fn concatenate(a: [[f32; 4]; 3], b: [[f32; 4]; 3]) -> [[f32; 4]; 3] {
    a.map(|row| {
        core::array::from_fn(|column| {
            let linear = row[0] * b[0][column] + row[1] * b[1][column] + row[2] * b[2][column];
            if column == 3 { linear + row[3] } else { linear }
        })
    })
}

/// The product of the transform list (guide 13.11). Instances are the only transforms of a static scene.
#[inline(always)]
fn transform(direction: Direction) -> [[f32; 4]; 3] {
    let mut product = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
    let size = get_u32!("_optix_get_transform_list_size");
    let mut i = 0;
    while i < size {
        let (handle, matrix): (u64, u64);
        // SAFETY: `i` is inside the list; the result is the handle of an instance.
        unsafe {
            asm!(
                "call ({h}), _optix_get_transform_list_handle, ({i});",
                h = out(reg64) handle,
                i = in(reg32) i,
                options(pure, nomem, nostack, preserves_flags)
            )
        };
        if direction == Direction::ObjectToWorld {
            // SAFETY: the handle of an instance.
            unsafe {
                asm!(
                    "call ({m}), _optix_get_instance_transform_from_handle, ({h});",
                    m = out(reg64) matrix,
                    h = in(reg64) handle,
                    options(pure, nomem, nostack, preserves_flags)
                )
            };
            // SAFETY: from the query above. Index 0 is nearest the root, so its transform is applied last.
            product = concatenate(product, unsafe { rows(matrix) });
        } else {
            // SAFETY: the handle of an instance.
            unsafe {
                asm!(
                    "call ({m}), _optix_get_instance_inverse_transform_from_handle, ({h});",
                    m = out(reg64) matrix,
                    h = in(reg64) handle,
                    options(pure, nomem, nostack, preserves_flags)
                )
            };
            // SAFETY: from the query above. Index 0 is nearest the root, so its inverse is applied first.
            product = concatenate(unsafe { rows(matrix) }, product);
        }
        i += 1;
    }
    product
}
