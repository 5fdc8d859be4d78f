//! Every macro, in a crate that knows the device crate by another name and forbids `unsafe` and what lints of style there are.
#![no_std]
#![forbid(
    unsafe_code,
    missing_docs,
    unused,
    nonstandard_style,
    future_incompatible,
    rust_2018_idioms,
    unreachable_pub,
    single_use_lifetimes,
    unused_qualifications,
    unused_results,
    trivial_casts,
    trivial_numeric_casts,
    explicit_outlives_requirements,
    private_interfaces,
    private_bounds,
    let_underscore_drop,
    unexpected_cfgs,
    deprecated
)]

use rt::prelude::*;

/// What a launch is given.
#[launch_params]
pub struct Frame {
    /// The image.
    pub film: SliceMut2d<Vec4>,
    /// The scene.
    pub world: Traversable,
    /// The lamps.
    pub lamps: Slice<Lamp>,
    /// Where the camera stands.
    pub camera: Pinhole,
    /// How often light bounces.
    #[bound]
    pub bounces: u32,
}

/// A camera.
#[derive(Clone, Copy, Debug, DeviceData)]
#[repr(C)]
pub struct Pinhole {
    /// Its position.
    pub origin: Vec3,
}

/// A lamp.
#[derive(Clone, Copy, Debug, Element)]
#[repr(C)]
pub struct Lamp {
    /// Its colour.
    pub colour: Vec3,
}

/// Random numbers.
#[derive(Clone, Copy, Debug, Words)]
pub struct Seed {
    /// Their state.
    pub state: u64,
}

/// Light along a ray.
#[derive(Debug, Payload)]
pub struct Radiance {
    /// The light.
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    /// Random numbers.
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub seed: Seed,
}

/// A painted surface.
#[derive(Clone, Copy, Debug, SbtRecord)]
#[repr(C)]
pub struct Paint {
    /// Its colour.
    pub colour: Vec3,
    /// How it is looked up.
    pub texture: Callable<fn(Vec2) -> Vec3>,
}

/// A ball.
#[derive(Clone, Copy, Debug, SbtRecord)]
#[repr(C)]
pub struct Ball {
    /// Its radius.
    pub radius: f32,
}

/// What a hit on a ball carries.
#[derive(Clone, Copy, Debug, Attributes)]
pub struct BallHit {
    /// The normal.
    pub normal: Vec3,
}

/// What can go wrong.
#[derive(Clone, Copy, Debug, UserException)]
pub enum Fault {
    /// The light is no number.
    NotANumber {
        /// Where.
        pixel: UVec2,
    },
    /// Anything else.
    Other,
}

/// The camera.
#[raygen]
pub fn camera(rg: &RayGen<Flat>) {
    let (frame, pixel) = (rg.params(), rg.launch_index().xy());
    let ray = Ray::new(frame.camera().origin, Vec3::Z);
    let given = RadianceFromCaller { seed: Seed { state: 1 } };
    let RadianceAtCaller { light, .. } = rg.trace::<Radiance>(frame.world(), ray, given);
    if light.is_nan() {
        rg.throw(Fault::NotANumber { pixel });
    }
    frame.film().set(pixel, light.extend(1.0));
}

/// Nothing is hit.
#[miss]
pub fn sky(_: &Miss<Flat>) -> RadianceFromMiss {
    RadianceFromMiss { light: Vec3::ONE }
}

#[closesthit]
fn paint(hit: &ClosestHit<Flat, Triangles>, record: &Paint, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
    RadianceFromClosestHit { light: record.texture.call(hit, hit.barycentrics()) * record.colour, seed: ray.seed }
}

#[anyhit]
fn every_other(hit: &AnyHit<Flat, Triangles>) -> Decision {
    if hit.primitive_index() & 1 == 0 { Decision::Accept } else { Decision::Ignore }
}

#[intersection]
fn ball(isect: &Intersection<Flat, BallHit>, record: &Ball) {
    let _ = isect.report(record.radius, 0, BallHit { normal: Vec3::X });
}

#[closesthit]
fn ball_shade(hit: &ClosestHit<Flat, BallHit>, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
    RadianceFromClosestHit { light: hit.attributes().normal, seed: ray.seed }
}

#[direct_callable]
fn wood(_: &DirectCallable<Flat>, uv: Vec2) -> Vec3 {
    uv.extend(0.0)
}

#[continuation_callable]
fn mirror(cc: &ContinuationCallable<Flat>, direction: Vec3) -> Vec3 {
    let given = RadianceFromCaller { seed: Seed { state: 2 } };
    cc.trace::<Radiance>(cc.params().world(), Ray::new(Vec3::ZERO, direction), given).light
}

#[exception]
fn report(ex: &Exception<Flat>) {
    if let Raised::User(Fault::NotANumber { pixel }) = ex.raised() {
        ex.params().film().set(pixel, Vec4::X);
    }
}

pipeline! {
    /// All of it.
    pub struct Flat {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky } },
        hitgroups: {
            Paint on Triangles => { Radiance { closesthit: paint, anyhit: every_other } },
            Ball on Custom => { Radiance { intersection: ball, closesthit: ball_shade } },
        },
        direct_callables: [wood],
        continuation_callables: [mirror],
        throws: Fault,
        exception: report,
    }
}
