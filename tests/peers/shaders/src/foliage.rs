//! Foliage: many instances of a plant whose leaves are cut out by an any-hit program, lit by the sun.

use crate::middle;
use optix_device_rs::prelude::*;
use path_tracer_shaders::Pinhole;

/// The launch parameters.
#[launch_params]
pub struct FoliageFrame {
    /// The picture.
    pub film: SliceMut2d<Vec4>,
    /// The scene.
    pub world: Traversable,
    /// The camera.
    pub camera: Pinhole,
    /// Unit vector to the sun.
    pub sun: Vec3,
}

/// What a camera ray meets.
#[derive(Payload)]
pub struct Seen {
    /// Where.
    #[payload(write(closesthit, miss), read(caller))]
    pub position: Vec3,
    /// Unit normal towards the ray.
    #[payload(write(closesthit, miss), read(caller))]
    pub normal: Vec3,
    /// Error bound of the position; negative for a miss.
    #[payload(write(closesthit, miss), read(caller))]
    pub error: f32,
    /// Share of light that it reflects, or the sky's light.
    #[payload(write(closesthit, miss), read(caller))]
    pub colour: Vec3,
}

/// How much of the sun is seen.
#[derive(Payload)]
pub struct Sun {
    /// Product of the transmittances of the leaves that it met; the ray ends where that is below a hundredth.
    #[payload(write(caller, anyhit), read(anyhit, caller))]
    pub light: f32,
    /// Whether it got out: it met nothing opaque, and the leaves did not end it.
    #[payload(write(caller, miss), read(caller))]
    pub seen: bool,
}

/// A leaf's colours.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Blade {
    /// Share of light that it reflects, per colour.
    pub albedo: Vec3,
    /// Share of light that passes through it.
    pub transmittance: f32,
}

/// The ground.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Ground {
    /// Share of light that it reflects, per colour.
    pub albedo: Vec3,
}

#[raygen]
fn camera(rg: &RayGen<Foliage>) {
    let frame = rg.params();
    let px = rg.launch_index().xy();
    let ray = frame.camera().ray(middle(px, rg.launch_dimensions().xy()));
    let hit = rg.trace::<Seen>(frame.world(), ray, ());
    let mut colour = hit.colour;
    if hit.error >= 0.0 {
        let point = SurfacePoint::new(hit.position, hit.normal, hit.error);
        let sun = frame.sun();
        let ray = point.ray(sun);
        let shadow = rg.trace_without_closesthit::<Sun>(frame.world(), ray, SunFromCaller { light: 1.0, seen: false });
        let direct = if shadow.seen { shadow.light * hit.normal.dot(sun).abs() } else { 0.0 };
        colour *= 0.25 + direct;
    }
    frame.film().set(px, colour.extend(1.0));
}

/// Whether there is leaf at a hit: a lens with a serrated edge and holes.
fn is_leaf(primitive: u32, barycentrics: Vec2) -> bool {
    let Vec2 { x: u, y: v } = barycentrics;
    let at = if primitive & 1 == 0 { Vec2::new(u + v, v) } else { Vec2::new(u, u + v) };
    let across = (at.y - 0.5).abs();
    let teeth = 0.03 * (at.x * 24.0 - (at.x * 24.0).floor());
    let width = 1.7 * at.x * (1.0 - at.x) - teeth;
    let hole = (at * 7.0 - (at * 7.0).floor() - 0.5).length_squared() < 0.03;
    across < width && !hole
}

/// Camera rays pass where there is no leaf.
#[anyhit]
fn cut_out(hit: &AnyHit<Foliage, Triangles>) -> Decision {
    if is_leaf(hit.primitive_index(), hit.barycentrics()) { Decision::Accept } else { Decision::Ignore }
}

/// Sun rays pass through leaves too, and get weaker.
#[anyhit]
fn shade(hit: &AnyHit<Foliage, Triangles>, record: &Blade, ray: SunAtAnyHit) -> (Decision, SunFromAnyHit) {
    let leaf = is_leaf(hit.primitive_index(), hit.barycentrics());
    let light = if leaf { ray.light * record.transmittance } else { ray.light };
    (if light < 0.01 { Decision::Terminate } else { Decision::Ignore }, SunFromAnyHit { light })
}

#[closesthit]
fn blade(hit: &ClosestHit<Foliage, Triangles>, record: &Blade) -> SeenFromClosestHit {
    surface(hit, record.albedo)
}

#[closesthit]
fn ground(hit: &ClosestHit<Foliage, Triangles>, record: &Ground) -> SeenFromClosestHit {
    surface(hit, record.albedo)
}

fn surface(hit: &ClosestHit<Foliage, Triangles>, colour: Vec3) -> SeenFromClosestHit {
    let SurfacePoint { position, normal, error, .. } = hit.surface_point();
    let normal = if normal.dot(hit.world_ray_direction()) > 0.0 { -normal } else { normal };
    SeenFromClosestHit { position, normal, error, colour }
}

#[miss]
fn sky(ms: &Miss<Foliage>) -> SeenFromMiss {
    let up = 0.5 * ms.world_ray_direction().y + 0.5;
    let colour = Vec3::new(0.7, 0.8, 0.9) * (1.0 - up) + Vec3::new(0.2, 0.4, 0.8) * up;
    SeenFromMiss { position: Vec3::ZERO, normal: Vec3::ZERO, error: -1.0, colour }
}

#[miss]
fn lit(_ms: &Miss<Foliage>) -> SunFromMiss {
    SunFromMiss { seen: true }
}

pipeline! {
    /// Foliage in the sun.
    pub struct Foliage {
        params: FoliageFrame,
        raygen: [camera],
        rays: { Seen { miss: sky }, Sun { miss: lit } },
        hitgroups: {
            Blade on Triangles => { Seen { closesthit: blade, anyhit: cut_out }, Sun { anyhit: shade } },
            Ground on Triangles => { Seen { closesthit: ground }, Sun {} },
        },
    }
}
