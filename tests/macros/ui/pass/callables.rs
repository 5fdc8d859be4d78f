//! Callables and exceptions in every form that they may have.
#![deny(warnings)]

use optix_device_rs::prelude::*;

pub type Texture = fn(Vec2) -> Vec3;

#[launch_params]
pub struct Frame {
    pub film: SliceMut2d<Vec4>,
    pub world: Traversable,
    pub textures: Callables<Texture>,
    pub lights: [Callable<fn() -> Vec3, Continuation>; 2],
}

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    #[payload(write(caller), read(closesthit))]
    pub texture: Callable<Texture>,
}

#[derive(Clone, Copy, Debug, PartialEq, Words)]
pub struct Spot {
    pub at: Vec3,
    pub on: Option<u8>,
}

#[derive(Clone, Copy, UserException)]
pub enum Fault {
    Lost,
    At(Vec3, u32),
    Spot { spot: (u64, bool), by: [f32; 4] },
}

#[derive(Clone, Copy, UserException)]
#[repr(u32)]
pub enum Numbered {
    Seven = 7,
    Eight(f64),
    Last = (1 << 30) - 1,
    r#Type { r#in: u32 } = 0x100,
}

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Mix {
    pub of: [Callable<Texture>; 2],
    pub share: f32,
}

#[raygen]
fn camera<P>(rg: &RayGen<P>)
where
    P: HasRay<Radiance> + Throws<Fault> + Pipeline<Params = Frame>,
{
    let frame = rg.params();
    if frame.textures().is_empty() {
        rg.throw(Fault::Lost);
    }
    let texture = frame.textures().get(rg.launch_index().x);
    let light = frame.lights()[0].call(rg);
    let seen =
        rg.trace::<Radiance>(frame.world(), Ray::new(light, Vec3::Z), RadianceFromCaller { texture });
    frame.film().set(UVec2::ZERO, seen.light.extend(1.0));
}

#[closesthit]
fn shade<P: Pipeline>(hit: &ClosestHit<P, Triangles>, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
    RadianceFromClosestHit { light: ray.texture.call(hit, hit.barycentrics()) }
}

#[anyhit]
fn cut<P: Pipeline>(hit: &AnyHit<P, Triangles>, record: &Mix) -> Decision {
    if record.of[0].call(hit, Vec2::ZERO).x > 0.5 { Decision::Ignore } else { Decision::Accept }
}

#[miss]
fn sky<P: Pipeline<Params = Frame>>(ms: &Miss<P>) -> RadianceFromMiss {
    RadianceFromMiss { light: ms.params().lights()[1].call(ms) }
}

/// For any context that may call.
fn helper<C: CallsDirect>(context: &C, textures: [Callable<Texture>; 2]) -> Vec3 {
    textures[0].call(context, Vec2::ONE) + textures[1].call(context, Vec2::ONE)
}

#[direct_callable]
fn mix<P: Throws<Fault>>(dc: &DirectCallable<P>, record: &Mix, uv: Vec2) -> Vec3 {
    if uv.x < 0.0 {
        dc.throw(Fault::At(uv.extend(0.0), 1));
    }
    helper(dc, record.of) * record.share
}

#[direct_callable]
fn many(_: &DirectCallable<Lit>, a: u8, b: u16, c: u32, d: u64, e: f32, f: f64, g: bool, h: [Spot; 2]) -> Spot {
    let sum = u64::from(a) + u64::from(b) + u64::from(c) + d + u64::from(g);
    Spot { at: Vec3::splat(sum as f32 + e + f as f32), ..h[0] }
}

#[direct_callable]
fn nothing<P: Pipeline>(_: &DirectCallable<P>) {}

#[continuation_callable]
fn lamp<P: Pipeline>(_: &ContinuationCallable<P>) -> Vec3 {
    Vec3::ONE
}

#[continuation_callable]
fn traced<P>(cc: &ContinuationCallable<P>, record: &Mix, texture: Callable<Texture>) -> Vec3
where
    P: HasRay<Radiance> + Pipeline<Params = Frame>,
{
    let frame = cc.params();
    let ray = Ray::new(record.of[1].call(cc, Vec2::X), frame.lights()[0].call(cc));
    cc.trace::<Radiance>(frame.world(), ray, RadianceFromCaller { texture }).light
}

#[exception]
fn report<P: Pipeline<Params = Frame, Exception = Fault>>(ex: &Exception<P>, record: &Mix) {
    let colour = match ex.raised() {
        Raised::User(Fault::At(at, _)) => at * record.share,
        Raised::User(_) | Raised::StackOverflow => Vec3::X,
        _ => Vec3::splat((ex.exception_code() + i32::from(ex.line_info().is_some())) as f32),
    };
    ex.params().film().set(ex.launch_index().xy(), colour.extend(1.0));
}

pipeline! {
    pub struct Lit {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky } },
        hitgroups: { Mix on Triangles => { Radiance { closesthit: shade, anyhit: cut } } },
        direct_callables: [mix, many, nothing],
        continuation_callables: [lamp, traced],
        throws: Fault,
        exception: report,
        trace_depth: 3,
        callable_depth: 2,
    }
}

/// An exception program for what OptiX raises itself.
#[exception]
fn quiet(ex: &Exception<Silent>) {
    let _ = matches!(ex.raised(), Raised::StackOverflow | Raised::TraceDepthExceeded);
}

#[raygen]
fn still(_: &RayGen<Silent>) {}

pipeline! {
    struct Silent {
        params: Frame,
        raygen: [still],
        rays: {},
        hitgroups: {},
        exception: quiet,
    }
}

fn main() {
    let codes: Vec<u32> = Numbered::VARIANTS.iter().map(|(code, _)| *code).collect();
    assert_eq!(codes, [7, 8, (1 << 30) - 1, 0x100]);
    assert_eq!((Fault::DETAILS, Numbered::DETAILS), (7, 2));
}
