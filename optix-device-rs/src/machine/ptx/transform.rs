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
    let size = get_u32!("_optix_get_transform_list_size");
    if size == 0 {
        return [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
    }
    // Of most hits the list is one instance, whose matrix is the product.
    let mut product = matrix(direction, 0);
    let mut i = 1;
    while i < size {
        let next = matrix(direction, i);
        // Index 0 is nearest the root, so its transform is applied last, and its inverse first.
        product = match direction {
            Direction::ObjectToWorld => concatenate(product, next),
            Direction::WorldToObject => concatenate(next, product),
        };
        i += 1;
    }
    product
}

/// The matrix of the instance at `index` of the transform list, which is longer than that.
#[inline(always)]
fn matrix(direction: Direction, index: u32) -> [[f32; 4]; 3] {
    let (handle, address): (u64, u64);
    // SAFETY: `index` is inside the list; the result is the handle of an instance.
    unsafe {
        asm!(
            "call ({h}), _optix_get_transform_list_handle, ({i});",
            h = out(reg64) handle,
            i = in(reg32) index,
            options(pure, nomem, nostack, preserves_flags)
        )
    };
    match direction {
        // SAFETY: the handle of an instance.
        Direction::ObjectToWorld => unsafe {
            asm!(
                "call ({m}), _optix_get_instance_transform_from_handle, ({h});",
                m = out(reg64) address,
                h = in(reg64) handle,
                options(pure, nomem, nostack, preserves_flags)
            )
        },
        // SAFETY: the handle of an instance.
        Direction::WorldToObject => unsafe {
            asm!(
                "call ({m}), _optix_get_instance_inverse_transform_from_handle, ({h});",
                m = out(reg64) address,
                h = in(reg64) handle,
                options(pure, nomem, nostack, preserves_flags)
            )
        },
    }
    // SAFETY: what the queries return is 48 bytes.
    unsafe { [row(address), row(address + 16), row(address + 32)] }
}

/// A row of a matrix.
///
/// # Safety
/// `address` is of 16 bytes of global memory, aligned to 16, which do not change during the launch.
#[inline(always)]
unsafe fn row(address: u64) -> [f32; 4] {
    let (x, y, z, w): (u32, u32, u32, u32);
    // SAFETY: the caller's. Nobody writes the memory, so the load may be moved or left out as a computation may.
    unsafe {
        asm!(
            "{{ .reg .b64 g; cvta.to.global.u64 g, {a}; ld.global.v4.b32 {{{x}, {y}, {z}, {w}}}, [g]; }}",
            x = out(reg32) x,
            y = out(reg32) y,
            z = out(reg32) z,
            w = out(reg32) w,
            a = in(reg64) address,
            options(pure, nomem, nostack, preserves_flags)
        )
    };
    [x, y, z, w].map(f32::from_bits)
}
