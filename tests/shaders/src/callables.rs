//! Programs that call callables and throw exceptions, each kind from each kind.

use optix_device_rs::prelude::*;

/// What a number becomes.
pub type Texture = fn(f32, UVec2) -> Vec3;
/// What comes back along a direction; may trace.
pub type Shader = fn(Vec3, u32) -> f32;

/// The launch parameters.
#[launch_params]
pub struct CallFrame {
    /// What each launch index found out.
    pub found: SliceMut<[f32; 4]>,
    /// Code and details of each launch index's exception; all ones without one.
    pub thrown: SliceMut<[u32; 9]>,
    /// Direct callables.
    pub textures: Callables<Texture>,
    /// Continuation callables.
    pub shaders: Callables<Shader, Continuation>,
    /// A floor at z = 0, beside it a ball.
    pub world: Traversable,
    /// How often a ray goes on.
    pub bounces: u32,
    /// Who throws: one of the constants below.
    pub thrower: u32,
}

/// Nobody throws.
pub const NOBODY: u32 = 0;
/// The ray-generation program throws.
pub const RAYGEN: u32 = 1;
/// The closest-hit program throws.
pub const CLOSESTHIT: u32 = 2;
/// The miss program throws.
pub const MISS: u32 = 3;
/// The any-hit program throws.
pub const ANYHIT: u32 = 4;
/// The intersection program throws.
pub const INTERSECTION: u32 = 5;
/// A direct callable throws.
pub const DIRECT: u32 = 6;
/// A continuation callable throws.
pub const CONTINUATION: u32 = 7;

/// What programs throw.
#[derive(Clone, Copy, Debug, PartialEq, UserException)]
#[repr(u32)]
pub enum Fault {
    /// Nothing to say.
    Lost,
    /// As much to say as there is room for.
    Full {
        /// Who threw.
        thrower: u32,
        /// The launch index.
        index: UVec3,
        /// Values of several sizes.
        values: (f32, f64, bool),
    } = 0x3fff_fff0,
    /// Less.
    Part(Vec2),
}

/// A ray that goes on.
#[derive(Payload)]
pub struct Bounce {
    /// How often yet.
    #[payload(write(caller), read(closesthit))]
    pub left: u32,
    /// What came of it.
    #[payload(write(closesthit, miss), read(caller))]
    pub value: f32,
}

/// A direct callable's data.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Scale {
    /// Factors.
    pub by: Vec3,
}

/// A direct callable's data, with another in it.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Sum {
    /// What to add up.
    pub of: [Callable<Texture>; 2],
}

/// A continuation callable's data.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Mirror {
    /// Where it lies.
    pub origin: Vec3,
    /// How much it takes.
    pub share: f32,
}

/// A material.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Floor {
    /// Which of the shaders.
    pub shader: u32,
    /// A texture.
    pub texture: Callable<Texture>,
}

/// A material of balls.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Round {
    /// A texture.
    pub texture: Callable<Texture>,
}

fn fault(thrower: u32, index: UVec3) -> Fault {
    match index.x % 3 {
        0 => Fault::Lost,
        1 => Fault::Part(Vec2::new(thrower as f32, index.x as f32)),
        _ => Fault::Full { thrower, index, values: (0.5 + index.x as f32, -1.0 / index.x as f64, index.x & 1 == 1) },
    }
}

/// Whether a program of this kind is to throw at this launch index.
fn throws(frame: CallFrameView<'_>, thrower: u32, index: UVec3) -> bool {
    frame.thrower() == thrower && index.x.is_multiple_of(2)
}

macro_rules! maybe_throw {
    ($context:ident, $thrower:expr) => {
        if throws($context.params(), $thrower, $context.launch_index()) {
            $context.throw(fault($thrower, $context.launch_index()));
        }
    };
}

/// Calls a direct and a continuation callable, chosen by launch index.
#[raygen]
pub fn call(rg: &RayGen<Calls>) {
    let (frame, index) = (rg.params(), rg.launch_index());
    maybe_throw!(rg, RAYGEN);
    let textures = frame.textures();
    let colour = textures.get(index.x.checked_rem(textures.len()).unwrap_or(0)).call(rg, index.x as f32, index.xy());
    let shaders = frame.shaders();
    let value = shaders.get(index.x.checked_rem(shaders.len()).unwrap_or(0)).call(rg, colour, frame.bounces());
    frame.found().set(index.x, colour.extend(value).to_array());
}

/// Multiplies.
#[direct_callable]
pub fn scale(dc: &DirectCallable<Calls>, record: &Scale, x: f32, at: UVec2) -> Vec3 {
    maybe_throw!(dc, DIRECT);
    record.by * x + at.as_vec2().extend(dc.launch_index().x as f32)
}

/// Adds up what others give: a direct callable that calls direct ones.
#[direct_callable]
pub fn sum(dc: &DirectCallable<Calls>, record: &Sum, x: f32, at: UVec2) -> Vec3 {
    let [a, b] = record.of;
    a.call(dc, x, at) + b.call(dc, x + 1.0, at)
}

/// Traces on.
#[continuation_callable]
pub fn mirror(cc: &ContinuationCallable<Calls>, record: &Mirror, towards: Vec3, left: u32) -> f32 {
    maybe_throw!(cc, CONTINUATION);
    let index = cc.launch_index().x;
    // Every third ray meets the ball, others the floor, or nothing.
    let target = match index % 3 {
        0 => Vec3::new(8.0, 0.0, 0.0),
        1 => Vec3::new(0.1, 0.1, 0.0),
        _ => Vec3::new(0.0, 0.0, 9.0),
    };
    let ray = Ray::new(record.origin, target - record.origin);
    let seen = cc.trace::<Bounce>(cc.params().world(), ray, BounceFromCaller { left });
    record.share * seen.value + towards.x * 0.125
}

/// Traces nothing.
#[continuation_callable]
pub fn flat(_: &ContinuationCallable<Calls>, towards: Vec3, left: u32) -> f32 {
    towards.y + left as f32
}

/// Goes on through a continuation callable, which traces again.
#[closesthit]
fn floor(hit: &ClosestHit<Calls, Triangles>, record: &Floor, ray: BounceAtClosestHit) -> BounceFromClosestHit {
    maybe_throw!(hit, CLOSESTHIT);
    let colour = record.texture.call(hit, hit.ray_tmax(), UVec2::splat(ray.left));
    if ray.left == 0 {
        return BounceFromClosestHit { value: colour.y };
    }
    let on = hit.params().shaders().get(record.shader);
    BounceFromClosestHit { value: on.call(hit, colour, ray.left - 1) }
}

/// Calls a direct callable during traversal.
#[anyhit]
fn holes(hit: &AnyHit<Calls, Triangles>, record: &Floor) -> Decision {
    maybe_throw!(hit, ANYHIT);
    let colour = record.texture.call(hit, 1.0, UVec2::ONE);
    if colour.x.is_nan() { Decision::Ignore } else { Decision::Accept }
}

/// What a ball's hit carries.
#[derive(Clone, Copy, Attributes)]
pub struct RoundHit {
    /// From its texture.
    pub colour: Vec3,
}

/// Calls a direct callable from an intersection program.
#[intersection]
fn round(isect: &Intersection<Calls, RoundHit>, record: &Round) {
    maybe_throw!(isect, INTERSECTION);
    isect.report(1.0, 0, RoundHit { colour: record.texture.call(isect, 2.0, UVec2::ZERO) });
}

/// What the intersection program found.
#[closesthit]
fn round_shade(hit: &ClosestHit<Calls, RoundHit>, _record: &Round) -> BounceFromClosestHit {
    BounceFromClosestHit { value: hit.attributes().colour.x }
}

/// Nothing is there.
#[miss]
fn sky(ms: &Miss<Calls>) -> BounceFromMiss {
    maybe_throw!(ms, MISS);
    let textures = ms.params().textures();
    BounceFromMiss { value: textures.get(0).call(ms, ms.world_ray_direction().z, UVec2::ZERO).z }
}

/// Writes down what was thrown.
#[exception]
fn caught(ex: &Exception<Calls>) {
    let note = match ex.raised() {
        Raised::User(Fault::Lost) => [1, 0, 0, 0, 0, 0, 0, 0, 0],
        Raised::User(Fault::Full { thrower, index, values: (single, double, flag) }) => {
            let bits = double.to_bits();
            let [x, y, z] = index.to_array();
            [2, thrower, x, y, z, single.to_bits(), bits as u32, (bits >> 32) as u32, u32::from(flag)]
        }
        Raised::User(Fault::Part(at)) => [3, at.x.to_bits(), at.y.to_bits(), 0, 0, 0, 0, 0, 0],
        Raised::TraceDepthExceeded => [4, 0, 0, 0, 0, 0, 0, 0, 0],
        Raised::StackOverflow => [5, 0, 0, 0, 0, 0, 0, 0, 0],
        _ => [6, ex.exception_code().cast_unsigned(), 0, 0, 0, 0, 0, 0, 0],
    };
    ex.params().thrown().set(ex.launch_index().x, note);
}

pipeline! {
    /// Calls callables, and throws.
    pub struct Calls {
        params: CallFrame,
        raygen: [call],
        rays: { Bounce { miss: sky } },
        hitgroups: {
            Floor on Triangles => { Bounce { closesthit: floor, anyhit: holes } },
            Round on Custom => { Bounce { intersection: round, closesthit: round_shade } },
        },
        direct_callables: [scale, sum],
        continuation_callables: [mirror, flat],
        throws: Fault,
        exception: caught,
        trace_depth: 4,
        callable_depth: 3,
    }
}

/// The launch parameters of [`Unheard`].
#[launch_params]
pub struct UnheardFrame {
    /// Ones where nothing was thrown.
    pub found: SliceMut<u32>,
}

/// Throws at launch indices from 3 on, and nobody is told.
#[raygen]
fn give_up<P: Throws<Fault> + Pipeline<Params = UnheardFrame>>(rg: &RayGen<P>) {
    let index = rg.launch_index();
    if index.x > 2 {
        rg.throw(Fault::Part(index.xy().as_vec2()));
    }
    rg.params().found().set(index.x, 1);
}

pipeline! {
    /// Throws, and has no exception program.
    pub struct Unheard {
        params: UnheardFrame,
        raygen: [give_up],
        rays: {},
        hitgroups: {},
        throws: Fault,
    }
}
