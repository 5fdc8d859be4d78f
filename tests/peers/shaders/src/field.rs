//! Signed-distance fields as custom primitives, sphere-traced by the intersection program (Hart 1996).

use crate::middle;
use optix_device_rs::math::sin_cos_turns;
use optix_device_rs::prelude::*;
use path_tracer_shaders::Pinhole;

/// The launch parameters.
#[launch_params]
pub struct FieldFrame {
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
pub struct Look {
    /// Unit normal; zero for a miss.
    #[payload(write(closesthit, miss), read(caller))]
    pub normal: Vec3,
    /// Ray parameter.
    #[payload(write(closesthit, miss), read(caller))]
    pub t: f32,
}

/// Whether the sun is seen.
#[derive(Payload)]
pub struct Sunlit {
    /// True if nothing is between.
    #[payload(write(caller, miss), read(caller))]
    pub seen: bool,
}

/// A gyroid shell in a rounded box, in object space from -1 to 1.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Gyroid {
    /// Periods per unit of length.
    pub frequency: f32,
    /// Half the shell's thickness, in units of length.
    pub thickness: f32,
}

impl Gyroid {
    /// A lower bound of the distance from the shape (its gradient is at most 1).
    fn distance(&self, p: Vec3) -> f32 {
        let turns = p * self.frequency;
        let (sx, cx) = sin_cos_turns(turns.x);
        let (sy, cy) = sin_cos_turns(turns.y);
        let (sz, cz) = sin_cos_turns(turns.z);
        let gyroid = (sx * cy + sy * cz + sz * cx).abs() * (1.0 / (self.frequency * 10.9)) - self.thickness;
        let q = p.abs() - Vec3::splat(0.8);
        // The `max` of numbers is an instruction; that of glam's vectors compares and selects.
        let outside =
            Vec3::new(q.x.max(0.0), q.y.max(0.0), q.z.max(0.0)).length() + q.x.max(q.y.max(q.z)).min(0.0) - 0.1;
        gyroid.max(outside)
    }

    fn normal(&self, p: Vec3) -> Vec3 {
        let h = 0.001;
        let along = |d: Vec3| self.distance(p + d) - self.distance(p - d);
        let (x, y, z) = (Vec3::new(h, 0.0, 0.0), Vec3::new(0.0, h, 0.0), Vec3::new(0.0, 0.0, h));
        Vec3::new(along(x), along(y), along(z)).normalize()
    }
}

/// A hit on the field.
#[derive(Clone, Copy, Debug, Attributes)]
pub struct FieldHit {
    /// Unit normal in object space.
    pub normal: Vec3,
}

/// Steps along the ray by the distance.
#[intersection]
fn march(isect: &Intersection<Field, FieldHit>, record: &Gyroid) {
    let (origin, direction) = (isect.object_ray_origin(), isect.object_ray_direction());
    let length = direction.length();
    // Where the ray is in the box.
    let inverse = Vec3::ONE / direction;
    let (a, b) = ((Vec3::NEG_ONE - origin) * inverse, (Vec3::ONE - origin) * inverse);
    let mut t = a.min(b).max_element().max(isect.ray_tmin());
    let end = a.max(b).min_element().min(isect.ray_tmax());
    let mut step = 0;
    while t < end && step < 256 {
        let p = origin + direction * t;
        let d = record.distance(p);
        if d < 0.0005 {
            isect.report(t, 0, FieldHit { normal: record.normal(p) });
            return;
        }
        t += d / length;
        step += 1;
    }
}

#[raygen]
fn camera(rg: &RayGen<Field>) {
    let frame = rg.params();
    let px = rg.launch_index().xy();
    let ray = frame.camera().ray(middle(px, rg.launch_dimensions().xy()));
    let hit = rg.trace::<Look>(frame.world(), ray, ());
    let mut light = 0.1;
    if hit.normal != Vec3::ZERO {
        let facing = hit.normal.dot(frame.sun());
        if facing > 0.0 {
            let position = ray.origin + ray.direction * hit.t;
            let flags = RayFlags::NONE.terminate_on_first_hit();
            let shadow = Ray::new(position + hit.normal * 0.004, frame.sun()).flags(flags);
            if rg.trace_without_closesthit::<Sunlit>(frame.world(), shadow, SunlitFromCaller { seen: false }).seen {
                light += facing;
            }
        }
    }
    frame.film().set(px, (hit.normal * 0.25 + 0.75).extend(0.0) * light);
}

#[closesthit]
fn look(hit: &ClosestHit<Field, FieldHit>) -> LookFromClosestHit {
    let normal = hit.world_to_object().normal(hit.attributes().normal).normalize();
    LookFromClosestHit { normal, t: hit.ray_tmax() }
}

#[miss]
fn nothing(_ms: &Miss<Field>) -> LookFromMiss {
    LookFromMiss { normal: Vec3::ZERO, t: 0.0 }
}

#[miss]
fn sunlit(_ms: &Miss<Field>) -> SunlitFromMiss {
    SunlitFromMiss { seen: true }
}

pipeline! {
    /// Signed-distance fields in the sun.
    pub struct Field {
        params: FieldFrame,
        raygen: [camera],
        rays: { Look { miss: nothing }, Sunlit { miss: sunlit } },
        hitgroups: {
            Gyroid on Custom => { Look { intersection: march, closesthit: look }, Sunlit { intersection: march } },
        },
    }
}
