//! The checks of the checked mode: they find what the OptiX guide calls undefined, or leaves to the application.

use super::Launch;
use crate::cpu::traversal::{Aabb, InstancePath, PrimitiveContext, Ray, ray_flags};
use core::cell::RefCell;
use glam::Vec3;
use optix_device_rs::host::end::fail;
use optix_device_rs::host::{PayloadDescription, PayloadWatch, Rule, TraceCall};
use optix_device_rs::surface::gamma;

/// Checks the arguments of a trace call. Returns what is known of its payload.
pub(super) fn trace(launch: &Launch<'_>, trace: &TraceCall) -> Watch {
    let ray = &trace.ray;
    for (what, vector) in [("origin", ray.origin), ("direction", ray.direction)] {
        if !vector.is_finite() {
            fail(Rule::Ray, format!("the ray's {what} {vector} is not finite"));
        }
    }
    if ray.direction == Vec3::ZERO {
        fail(Rule::Ray, "the ray has no direction: all its elements are 0".into());
    }
    // An infinite tmax is an interval without end.
    if ray.tmin.is_nan() || ray.tmin.is_infinite() {
        fail(Rule::Interval, format!("tmin is {}", ray.tmin));
    }
    if ray.tmax.is_nan() || ray.tmax == f32::NEG_INFINITY {
        fail(Rule::Interval, format!("tmax is {}", ray.tmax));
    }
    if ray.tmin < 0.0 {
        fail(Rule::Interval, format!("tmin is negative: {}", ray.tmin));
    }
    // A ray may have one flag of each of these groups.
    for (group, rule) in [(ray_flags::ANYHIT, Rule::AnyHitFlags), (ray_flags::CULL_FACES, Rule::CullFlags)] {
        if (ray.flags.bits() & group).count_ones() > 1 {
            fail(rule, format!("the ray flags {:#x} have two that exclude each other", ray.flags.bits()));
        }
    }
    Watch::new(launch.ray(trace.miss_index).payload, trace)
}

/// Ends the launch index, because the ray is not a valid ray in the object space of an instance.
pub(super) fn no_ray(path: &InstancePath<'_>, object_ray: &Ray) -> ! {
    let (origin, direction) = (Vec3::from_array(object_ray.origin), Vec3::from_array(object_ray.direction));
    let what = if !origin.is_finite() {
        format!("its origin becomes {origin}")
    } else if !direction.is_finite() {
        format!("its direction becomes {direction}")
    } else {
        "all elements of its direction become 0".into()
    };
    let (indices, id) = (path.indices(), path.instance_id());
    fail(
        Rule::ObjectRay,
        format!(
            "the ray can't be taken to the object space of the instance with ID {id}, at {indices:?} from the root: {what}, so it \
             misses what the instance holds"
        ),
    )
}

/// Checks a hit that is reported at a primitive, while the ray's interval ends at `tmax`.
pub(super) fn report(context: &PrimitiveContext<'_>, tmax: f32, t: f32, kind: u8) {
    if kind > 127 {
        fail(Rule::HitKind, format!("hit kind {kind} is reported: 128 to 255 are of built-in primitives"));
    }
    if t.is_nan() {
        fail(Rule::HitNan, "a hit is reported at t = NaN".into());
    }
    // Reporting outside of the interval is allowed, but is no hit.
    if (context.query.tmin..=tmax).contains(&t)
        && let Some(Aabb { min, max }) = context.gas.custom_box(context.sbt_gas_index, context.primitive_index)
    {
        let ray = &context.object_ray;
        let at: [f64; 3] = core::array::from_fn(|a| {
            let (origin, way) = (f64::from(ray.origin[a]), f64::from(t) * f64::from(ray.direction[a]));
            // Rounding in the program's own arithmetic may move the hit by this much.
            let slack = f64::from(gamma(64)) * (origin.abs() + way.abs());
            (origin + way).clamp(f64::from(min[a]) - slack, f64::from(max[a]) + slack) - (origin + way)
        });
        if at != [0.0; 3] {
            fail(
                Rule::OutsideBox,
                format!(
                    "a hit is reported at t = {t}, outside of the primitive's box from {min:?} to {max:?} by {at:?}"
                ),
            );
        }
    }
}

/// What is known of a trace call's payload.
pub(super) struct Watch {
    payload: PayloadDescription,
    /// The payload type of the trace call: the bits of `OptixPayloadTypeID`.
    payload_type: u32,
    /// For each field, whether the caller or a program has written it.
    written: RefCell<Vec<bool>>,
}

impl Watch {
    fn new(payload: PayloadDescription, trace: &TraceCall) -> Self {
        let written = RefCell::new(vec![false; payload.fields.len()]);
        let watch = Self { payload, payload_type: trace.payload_type, written };
        watch.gives(trace.caller_writes);
        watch
    }

    /// A program for rays of this type is about to run.
    pub fn runs(&self, ray: usize) {
        if self.payload_type != 1 << ray {
            fail(
                Rule::PayloadType,
                format!(
                    "payload type {:#x} is traced, but the record that the ray comes to is of programs for {:#x}",
                    self.payload_type,
                    1 << ray
                ),
            );
        }
    }

    /// The trace call returns, and its caller reads these fields.
    pub fn returns(&self, fields: &'static [usize]) {
        if let Some(field) = self.unwritten(fields) {
            fail(
                Rule::PayloadUnwritten,
                format!(
                    "{field} comes back to the caller, which reads it, but neither the caller nor any program of this trace wrote it"
                ),
            );
        }
    }

    /// The first of these fields that nobody has written, for messages.
    fn unwritten(&self, fields: &[usize]) -> Option<String> {
        let written = self.written.borrow();
        let field = self.payload.fields[*fields.iter().find(|field| !written[**field])?];
        let words = match field.count {
            1 => format!("word {}", field.at),
            count => format!("words {} to {}", field.at, field.at + count - 1),
        };
        Some(format!("payload field `{}::{}` ({words})", self.payload.name, field.name))
    }
}

impl PayloadWatch for Watch {
    fn takes(&self, fields: &'static [usize]) {
        if let Some(field) = self.unwritten(fields) {
            fail(Rule::PayloadUnwritten, format!("{field} is read, but neither the caller nor any program wrote it"));
        }
    }

    fn gives(&self, fields: &'static [usize]) {
        let mut written = self.written.borrow_mut();
        fields.iter().for_each(|field| written[*field] = true);
    }
}
