//! Instances (guide 5.4).

use super::super::context::Context;
use super::super::limits::Limits;
use super::super::sys;
use super::build::{RawInput, build};
use super::staging::{Staging, Upload};
use super::{Accel, AccelOptions, Traversable};
use crate::affine::Affine;
use crate::error::DriverError as Error;
use crate::scene::InstanceFlags;

// The bits are OptiX's.
const _: () = {
    use sys::OptixInstanceFlags as Raw;
    assert!(InstanceFlags::NONE.bits() == Raw::NONE.0);
    assert!(InstanceFlags::DISABLE_TRIANGLE_FACE_CULLING.bits() == Raw::DISABLE_TRIANGLE_FACE_CULLING.0);
    assert!(InstanceFlags::FLIP_TRIANGLE_FACING.bits() == Raw::FLIP_TRIANGLE_FACING.0);
    assert!(InstanceFlags::DISABLE_ANYHIT.bits() == Raw::DISABLE_ANYHIT.0);
    assert!(InstanceFlags::ENFORCE_ANYHIT.bits() == Raw::ENFORCE_ANYHIT.0);
};

/// A placed copy of a traversable.
#[derive(Clone, Debug)]
pub struct Instance {
    /// What is placed.
    pub traversable: Traversable,
    /// Object to world, row-major 3x4.
    pub transform: [f32; 12],
    /// What programs read as the instance id; at most [`Limits::max_instance_id`], 28 bits.
    pub id: u32,
    /// Added to the index of the hit-group record; at most [`Limits::max_sbt_offset`], 28 bits.
    pub sbt_offset: u32,
    /// The instance is skipped by rays whose mask shares no bit with it.
    pub visibility_mask: u8,
    /// Flags.
    pub flags: InstanceFlags,
}

impl Instance {
    /// The traversable where it is, with id and record offset 0, seen by all rays.
    pub fn of(traversable: impl Into<Traversable>) -> Self {
        Self {
            traversable: traversable.into(),
            transform: [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
            id: 0,
            sbt_offset: 0,
            visibility_mask: 255,
            flags: InstanceFlags::NONE,
        }
    }

    fn raw(&self) -> sys::OptixInstance {
        sys::OptixInstance {
            transform: self.transform,
            instance_id: self.id,
            sbt_offset: self.sbt_offset,
            visibility_mask: self.visibility_mask.into(),
            flags: self.flags.bits(),
            traversable_handle: self.traversable.handle(),
            pad: [0; 2],
        }
    }
}

impl Accel {
    /// Builds an instance acceleration structure, and returns when it is built. It keeps the instanced traversables.
    ///
    /// # Errors
    /// [`Error::Invalid`] for ids, offsets and counts beyond the limits and traversables of another context,
    /// [`Error::Optix`] or [`Error::Cuda`] otherwise.
    pub fn instances(context: &Context, instances: &[Instance], options: &AccelOptions) -> Result<Self, Error> {
        let limits = context.limits();
        check_count(instances.len(), limits)?;
        for (index, instance) in instances.iter().enumerate() {
            context.owns("an instance", instance.traversable.context())?;
            check(index, instance, limits)?;
        }
        let raw: Vec<_> = instances.iter().map(Instance::raw).collect();
        let depth = 1 + instances.iter().map(|instance| instance.traversable.depth()).max().unwrap_or(0);
        let children = instances.iter().map(|instance| instance.traversable.clone()).collect();
        let mut staging = Staging::new(context);
        // SAFETY: `staging` is declared after `raw`, so it is dropped, and waits for the copy, before `raw` goes.
        let address = unsafe { staging.elements(&raw)? };
        let input = RawInput::instances(sys::OptixBuildInputInstanceArray {
            instances: address,
            // Checked against the limit, which has 32 bits.
            num_instances: raw.len() as u32,
            instance_stride: 0,
        });
        // SAFETY: the address belongs to `staging`, is aligned to 256 bytes and holds the instances, whose handles are
        // those of `children`.
        unsafe { build(context, &[input], options, children, depth) }
    }
}

fn check_count(count: usize, limits: &Limits) -> Result<(), Error> {
    if u32::try_from(count).is_ok_and(|count| count <= limits.max_instances_per_ias) {
        return Ok(());
    }
    let problem = format!("{count} instances, more than {}", limits.max_instances_per_ias);
    Err(Error::invalid(
        "an instance acceleration structure",
        problem,
        "split the instances over several instance structures, and put those into one (guide 12)",
    ))
}

fn check(index: usize, instance: &Instance, limits: &Limits) -> Result<(), Error> {
    const WHAT: &str = "an instance";
    let remedy = "ids and record offsets have 28 bits (guide 5.4)";
    if instance.id > limits.max_instance_id {
        let problem = format!("instance {index} has id {}, more than {}", instance.id, limits.max_instance_id);
        return Err(Error::invalid(WHAT, problem, remedy));
    }
    if instance.sbt_offset > limits.max_sbt_offset {
        let problem =
            format!("instance {index} has record offset {}, more than {}", instance.sbt_offset, limits.max_sbt_offset);
        return Err(Error::invalid(WHAT, problem, remedy));
    }
    if let Some([a, b]) = instance.flags.conflict() {
        let problem = format!("instance {index} has the flags {a} and {b}, which exclude each other");
        return Err(Error::invalid(WHAT, problem, "leave one out"));
    }
    if !instance.transform.iter().all(|x| x.is_finite()) || Affine::from_f32(&instance.transform).inverse().is_none() {
        let problem = format!("instance {index} has the transform {:?}", instance.transform);
        return Err(Error::invalid(WHAT, problem, "give a matrix of full rank and finite numbers"));
    }
    Ok(())
}
