//! Lookups of textures of every shape.

use optix_device_rs::prelude::*;

/// One lookup.
#[derive(Clone, Copy, Debug, PartialEq, Element)]
#[repr(C)]
pub struct Query {
    /// As many as the shape has; of a cube a direction.
    pub at: [f32; 3],
    /// Level of detail.
    pub level: f32,
    /// How the coordinates change from lookup to lookup.
    pub steps: [[f32; 3]; 2],
    /// Of a layered texture.
    pub layer: u32,
    /// 0: the largest level; 1: `level`; 2: by `steps`.
    pub how: u32,
}

/// The launch parameters: a lookup for each launch index, in each texture.
#[launch_params]
pub struct TextureFrame {
    /// What is looked up.
    pub queries: Slice<Query>,
    /// What is there, by shape.
    pub seen: SliceMut2d<Vec4>,
    /// A row.
    pub d1: Texture1d<Vec4>,
    /// A rectangle.
    pub d2: Texture2d<Vec4>,
    /// Another, with two channels.
    pub two: Texture2d<Vec2>,
    /// Another, with one.
    pub one: Texture2d<f32>,
    /// A box.
    pub d3: Texture3d<Vec4>,
    /// Layers.
    pub array: Texture2dArray<Vec4>,
    /// A cube.
    pub cube: TextureCube<Vec4>,
}

/// How many textures there are.
pub const TEXTURES: u32 = 7;

macro_rules! look_up {
    ($texture:expr, $query:ident, $at:expr $(, $layer:expr)?) => {{
        let at = $at;
        match $query.how {
            0 => $texture.sample($($layer,)? at($query.at)),
            1 => $texture.sample_level($($layer,)? at($query.at), $query.level),
            _ => $texture.sample_gradient($($layer,)? at($query.at), at($query.steps[0]), at($query.steps[1])),
        }
    }};
}

#[raygen]
fn look_up(rg: &RayGen<Textures>) {
    let frame = rg.params();
    let index = rg.launch_index().x;
    let query = frame.queries().get(index);
    let show = |texture: u32, seen: Vec4| frame.seen().set(UVec2::new(index, texture), seen);
    let plane = |[x, y, _]: [f32; 3]| Vec2::new(x, y);
    show(0, look_up!(frame.d1(), query, |[x, ..]: [f32; 3]| x));
    show(1, look_up!(frame.d2(), query, plane));
    show(2, look_up!(frame.two(), query, plane).extend(0.0).extend(0.0));
    show(3, Vec4::splat(look_up!(frame.one(), query, plane)));
    show(4, look_up!(frame.d3(), query, Vec3::from_array));
    show(5, look_up!(frame.array(), query, plane, query.layer));
    show(6, look_up!(frame.cube(), query, Vec3::from_array));
}

pipeline! {
    /// Looks up textures.
    pub struct Textures {
        params: TextureFrame,
        raygen: [look_up],
        rays: {},
        hitgroups: {},
    }
}
