//! Texture lookups by PTX instructions (PTX ISA, `tex`).

use super::{Level, Lookup, TextureShape};
use core::arch::asm;

/// A lookup by `tex` of this form, with these coordinates, these operands for a gradient, and the layer where there are layers.
macro_rules! tex {
    ($texture:ident, $lookup:ident, $form:literal, $coordinates:literal, $gradient:literal $(, $layer:ident)?) => {{
        let [x, y, z] = $lookup.coordinates;
        let (r, g, b, a): (f32, f32, f32, f32);
        // SAFETY: the texture is of this shape (`from_raw`), and nobody writes to it during the launch. Registers that the shape
        // has no use for are given all the same.
        unsafe {
            match $lookup.level {
                Level::Lod(lod) => asm!(
                    "{{ .reg .f32 x, y, z, l, r, g, b, a;",
                    "mov.b32 x, {x}; mov.b32 y, {y}; mov.b32 z, {z}; mov.b32 l, {l};",
                    concat!("tex.level.", $form, ".v4.f32.f32 {{r, g, b, a}}, [{t}, {{", $coordinates, "}}], l;"),
                    "mov.b32 {r}, r; mov.b32 {g}, g; mov.b32 {b}, b; mov.b32 {a}, a;",
                    "}}",
                    t = in(reg64) $texture,
                    x = in(reg32) x, y = in(reg32) y, z = in(reg32) z, l = in(reg32) lod, $($layer = in(reg32) $lookup.$layer,)?
                    r = out(reg32) r, g = out(reg32) g, b = out(reg32) b, a = out(reg32) a,
                    options(pure, nomem, nostack, preserves_flags)
                ),
                Level::Gradient([[dxx, dxy, dxz], [dyx, dyy, dyz]]) => asm!(
                    "{{ .reg .f32 x, y, z, dxx, dxy, dxz, dyx, dyy, dyz, r, g, b, a;",
                    "mov.b32 x, {x}; mov.b32 y, {y}; mov.b32 z, {z};",
                    "mov.b32 dxx, {dxx}; mov.b32 dxy, {dxy}; mov.b32 dxz, {dxz};",
                    "mov.b32 dyx, {dyx}; mov.b32 dyy, {dyy}; mov.b32 dyz, {dyz};",
                    concat!("tex.grad.", $form, ".v4.f32.f32 {{r, g, b, a}}, [{t}, {{", $coordinates, "}}], ", $gradient, ";"),
                    "mov.b32 {r}, r; mov.b32 {g}, g; mov.b32 {b}, b; mov.b32 {a}, a;",
                    "}}",
                    t = in(reg64) $texture,
                    x = in(reg32) x, y = in(reg32) y, z = in(reg32) z, $($layer = in(reg32) $lookup.$layer,)?
                    dxx = in(reg32) dxx, dxy = in(reg32) dxy, dxz = in(reg32) dxz,
                    dyx = in(reg32) dyx, dyy = in(reg32) dyy, dyz = in(reg32) dyz,
                    r = out(reg32) r, g = out(reg32) g, b = out(reg32) b, a = out(reg32) a,
                    options(pure, nomem, nostack, preserves_flags)
                ),
            }
        }
        [r, g, b, a]
    }};
}

/// Looks up a texture; the shape and the kind of level are constants of the view and the method.
#[inline(always)]
pub fn lookup(texture: u64, shape: TextureShape, lookup: Lookup) -> [f32; 4] {
    match shape {
        TextureShape::D1 => tex!(texture, lookup, "1d", "x", "{{dxx}}, {{dyx}}"),
        TextureShape::D2 => tex!(texture, lookup, "2d", "x, y", "{{dxx, dxy}}, {{dyx, dyy}}"),
        TextureShape::D3 => tex!(texture, lookup, "3d", "x, y, z, z", "{{dxx, dxy, dxz, dxz}}, {{dyx, dyy, dyz, dyz}}"),
        TextureShape::D2Array => tex!(texture, lookup, "a2d", "{layer}, x, y, y", "{{dxx, dxy}}, {{dyx, dyy}}", layer),
        TextureShape::Cube => {
            tex!(texture, lookup, "cube", "x, y, z, z", "{{dxx, dxy, dxz, dxz}}, {{dyx, dyy, dyz, dyz}}")
        }
    }
}
