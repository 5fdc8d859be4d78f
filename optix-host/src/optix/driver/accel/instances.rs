//! Instances (guide 5.4).

use super::super::context::Context;
use super::super::sys;
use super::build::{RawInput, build};
use super::staging::{Staging, Upload};
use super::{Accel, AccelOptions, Traversable};
use crate::error::BuildError;
use crate::scene::{InstanceFlags, InstanceInput, InstanceLimits};

// The bits are OptiX's.
const _: () = {
    use sys::OptixInstanceFlags as Raw;
    assert!(InstanceFlags::NONE.bits() == Raw::NONE.0);
    assert!(InstanceFlags::DISABLE_TRIANGLE_FACE_CULLING.bits() == Raw::DISABLE_TRIANGLE_FACE_CULLING.0);
    assert!(InstanceFlags::FLIP_TRIANGLE_FACING.bits() == Raw::FLIP_TRIANGLE_FACING.0);
    assert!(InstanceFlags::DISABLE_ANYHIT.bits() == Raw::DISABLE_ANYHIT.0);
    assert!(InstanceFlags::ENFORCE_ANYHIT.bits() == Raw::ENFORCE_ANYHIT.0);
};

/// An instance of a traversable.
pub type Instance = InstanceInput<Traversable>;

fn raw<C>(instance: &InstanceInput<C>, traversable_handle: u64) -> sys::OptixInstance {
    sys::OptixInstance {
        transform: instance.transform,
        instance_id: instance.id,
        sbt_offset: instance.sbt_offset,
        visibility_mask: instance.visibility_mask.into(),
        flags: instance.flags.bits(),
        traversable_handle,
        pad: [0; 2],
    }
}

impl Accel {
    /// Builds an instance acceleration structure, and returns when it is built. It keeps the instanced traversables.
    ///
    /// # Errors
    /// [`Build`](crate::Error::Build) for what this GPU does not take, [`Driver`](crate::Error::Driver) for traversables of another
    /// context and where the driver fails.
    pub fn instances(context: &Context, instances: &[Instance], options: &AccelOptions) -> crate::Result<Self> {
        let limits = context.limits();
        let (count, limit) = (instances.len(), limits.max_instances_per_ias as usize);
        if count > limit {
            return Err(BuildError::TooMany { what: "instances", count, limit }.into());
        }
        let each = InstanceLimits {
            id: limits.max_instance_id,
            sbt_offset: limits.max_sbt_offset,
            depth: limits.max_graph_depth as usize,
        };
        for (index, instance) in instances.iter().enumerate() {
            context.owns("an instance", instance.child.context())?;
            let checked = instance.check(instance.child.depth() as usize, each);
            checked.map_err(|error| BuildError::Instance { instance: index, error })?;
        }
        let raw: Vec<_> = instances.iter().map(|instance| raw(instance, instance.child.handle())).collect();
        let depth = 1 + instances.iter().map(|instance| instance.child.depth()).max().unwrap_or(0);
        let children = instances.iter().map(|instance| instance.child.clone()).collect();
        let mut staging = Staging::new(context);
        // SAFETY: `staging` is declared after `raw`, so it is dropped, and waits for the copy, before `raw` goes.
        let address = unsafe { staging.elements(&raw)? };
        let instance_array = sys::OptixBuildInputInstanceArray {
            instances: address,
            // Checked against the limit, which has 32 bits.
            num_instances: raw.len() as u32,
            instance_stride: 0,
        };
        let input =
            RawInput::new(sys::OptixBuildInputType::INSTANCES, Box::default(), Box::default(), |union, _, _| {
                union.instance_array = instance_array
            });
        // SAFETY: the address belongs to `staging`, is aligned to 256 bytes and holds the instances, whose handles are
        // those of `children`.
        Ok(unsafe { build(context, &[input], options, children, depth)? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_instance_as_optix_has_it() {
        let transform = [1., 2., 3., 4., 5., 6., 7., 8., 9., 10., 11., 12.];
        let flags = InstanceFlags::FLIP_TRIANGLE_FACING | InstanceFlags::DISABLE_ANYHIT;
        let instance = InstanceInput { transform, id: 5, sbt_offset: 6, visibility_mask: 0x81, flags, child: () };
        let raw = raw(&instance, 0x1234);
        assert_eq!((raw.transform, raw.instance_id, raw.sbt_offset), (transform, 5, 6));
        assert_eq!((raw.visibility_mask, raw.flags, raw.traversable_handle, raw.pad), (0x81, 2 | 4, 0x1234, [0; 2]));
    }
}
