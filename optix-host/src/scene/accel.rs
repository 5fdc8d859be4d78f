//! Acceleration structures: geometry (GAS) and instances (IAS) (guide 5).

use super::{Geometry, GeometryData, InstanceFlags, Scene};
use crate::affine::Affine;
use crate::backend::{BuildInput, BuiltAccel, GasInput, IasInput, InstanceInput};
use crate::{Error, Result};
use glam::Affine3A;
use optix_device_rs::attributes::{Geometry as GeometryKindOf, Triangles};
use optix_device_rs::host::{DeviceId, InstanceTable, TriangleTable, World};
use optix_device_rs::pipeline::Pipeline;
use std::marker::PhantomData;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// Geometry with its material, to go into a GAS.
pub struct GasMember<P, G> {
    data: Arc<GeometryData>,
    /// Whose material it is, per record.
    scenes: Vec<u64>,
    /// Material and hit group per record.
    records: Vec<(u32, u32)>,
    record_of_primitive: Option<Vec<u32>>,
    types: PhantomData<fn(P, G)>,
}

impl<P, G> GasMember<P, G> {
    pub(super) fn new(
        geometry: &Geometry<G>,
        scenes: Vec<u64>,
        records: Vec<(u32, u32)>,
        record_of_primitive: Option<Vec<u32>>,
    ) -> Self {
        Self { data: geometry.data.clone(), scenes, records, record_of_primitive, types: PhantomData }
    }
}

/// An acceleration structure of a scene. A clone is the same structure.
pub struct Accel<P> {
    shared: Arc<AccelShared>,
    pipeline: PhantomData<fn(P)>,
}

impl<P> Clone for Accel<P> {
    fn clone(&self) -> Self {
        Self { shared: self.shared.clone(), pipeline: PhantomData }
    }
}

/// What a launch checks of the structures it is given.
pub(crate) struct AccelShared {
    pub built: BuiltAccel,
    pub device: DeviceId,
    pub scene: u64,
    /// Levels of instances; 0 for a GAS.
    pub depth: u32,
    /// First record slot; 0 for an IAS, whose instances carry their offsets.
    first_slot: u32,
    /// The table has at least this many slots.
    pub slots: u32,
    /// Of the scene's structures: see `Usage`.
    roots: Arc<AtomicU32>,
    /// Keeps the children alive.
    _children: Vec<Arc<AccelShared>>,
}

impl AccelShared {
    fn world(self: &Arc<Self>) -> World {
        // SAFETY: the backend's owner keeps the handle, and this is what the scene built with it.
        unsafe { World::new(self.built.handle, self.device, self.built.owner.clone(), self.clone()) }
    }
}

/// A structure placed in an IAS.
pub struct Instance<P> {
    child: Accel<P>,
    transform: Affine3A,
    id: u32,
    mask: u8,
    flags: InstanceFlags,
}

impl<P> Instance<P> {
    /// The application's id, below 2^28, which programs read by `instance_id`.
    pub fn id(mut self, id: u32) -> Self {
        self.id = id;
        self
    }

    /// Rays whose mask shares no bit with this one don't see the instance.
    pub fn mask(mut self, mask: u8) -> Self {
        self.mask = mask;
        self
    }

    /// With these flags.
    pub fn flags(mut self, flags: InstanceFlags) -> Self {
        self.flags = flags;
        self
    }
}

impl<P> Accel<P> {
    /// An instance of this structure: `transform` takes its object space to the space of the IAS.
    pub fn at(&self, transform: Affine3A) -> Instance<P> {
        Instance { child: self.clone(), transform, id: 0, mask: 0xff, flags: InstanceFlags::NONE }
    }

    /// The structure as launch parameters take it: what rays are traced against.
    ///
    /// A GAS that does not have the first records of the table can't be a root itself, since only instances carry
    /// offsets: put it in an IAS.
    pub fn world(&self) -> Result<World> {
        let shared = &self.shared;
        if shared.first_slot != 0 {
            return Err(Error::Scene(
                "this GAS is not the scene's first, so its records are reached through an instance only: \
                 trace against an IAS that has it"
                    .into(),
            ));
        }
        shared.roots.fetch_or(1 << shared.depth, Relaxed);
        Ok(shared.world())
    }

    /// Bytes of the finished structure, without its children.
    pub fn bytes(&self) -> usize {
        self.shared.built.bytes
    }
}

/// Gathers what a GAS is built of.
pub struct GasBuilder<'s, P, G> {
    scene: &'s mut Scene<P>,
    members: Vec<GasMember<P, G>>,
    compact: bool,
}

/// Gathers what an IAS is built of.
pub struct IasBuilder<'s, P> {
    scene: &'s mut Scene<P>,
    instances: Vec<Instance<P>>,
}

impl<P: Pipeline> Scene<P> {
    /// A geometry acceleration structure of these, all of one kind (guide 5).
    pub fn gas<G: GeometryKindOf>(
        &mut self,
        members: impl IntoIterator<Item = GasMember<P, G>>,
    ) -> GasBuilder<'_, P, G> {
        GasBuilder { members: members.into_iter().collect(), compact: false, scene: self }
    }

    /// An instance acceleration structure of these (guide 5.4).
    pub fn ias(&mut self, instances: impl IntoIterator<Item = Instance<P>>) -> IasBuilder<'_, P> {
        IasBuilder { instances: instances.into_iter().collect(), scene: self }
    }
}

impl<P: Pipeline, G: GeometryKindOf> GasBuilder<'_, P, G> {
    /// Compacts the structure after the build (guide 5.8).
    pub fn compact(mut self) -> Self {
        self.compact = true;
        self
    }

    /// Builds it.
    pub fn build(self) -> Result<Accel<P>> {
        self.build_for(false)
    }

    fn build_for(self, random_vertex_access: bool) -> Result<Accel<P>> {
        let state = &mut self.scene.state;
        if self.members.is_empty() {
            return Err(Error::Scene("a GAS needs at least one geometry".into()));
        }
        for (i, member) in self.members.iter().enumerate() {
            if member.scenes.iter().any(|&scene| scene != state.id) {
                return Err(Error::Scene(format!("geometry {i} of the GAS has a material of another scene")));
            }
            check_records(i, member)?;
        }
        let description = P::DESCRIPTION;
        let inputs = self.members.iter().map(|member| BuildInput {
            geometry: member.data.clone(),
            record_has_anyhit: member
                .records
                .iter()
                .map(|&(_, group)| description.hitgroups[group as usize].rays.iter().any(|r| r.anyhit.is_some()))
                .collect(),
            record_of_primitive: member.record_of_primitive.clone(),
        });
        let input = GasInput { kind: G::KIND, inputs: inputs.collect(), compact: self.compact, random_vertex_access };
        let built = self.scene.device.backend.build_gas(&input)?;
        let records = self.members.iter().flat_map(|m| m.records.iter().copied()).collect();
        let first_slot = state.slots_for(records)?;
        state.usage.add(G::KIND);
        state.usage.depths.push(0);
        Ok(Accel {
            shared: Arc::new(AccelShared {
                built,
                device: self.scene.device.backend.id(),
                scene: state.id,
                depth: 0,
                first_slot,
                slots: state.slots.len() as u32,
                roots: state.usage.roots.clone(),
                _children: Vec::new(),
            }),
            pipeline: PhantomData,
        })
    }
}

impl<P: Pipeline> GasBuilder<'_, P, Triangles> {
    /// Builds it so that programs may read its triangles, which takes a little more memory
    /// (`OPTIX_BUILD_FLAG_ALLOW_RANDOM_VERTEX_ACCESS`, guide 13.9). The table is what a field of type
    /// [`TriangleVertices`](optix_device_rs::accel::TriangleVertices) holds.
    pub fn build_with_triangles(self) -> Result<(Accel<P>, TriangleTable)> {
        let device = self.scene.device.clone();
        let members = self.members.iter();
        let counts: Vec<u32> = members.flat_map(|m| m.records.iter().map(|_| m.data.primitives() as u32)).collect();
        let accel = self.build_for(true)?;
        let counts = device.buffer(&counts)?;
        // SAFETY: built for it, with these records, each of a geometry of 2^29 triangles at the most; the buffer is nobody else's.
        let table = unsafe { TriangleTable::new(accel.shared.world(), counts) };
        Ok((accel, table))
    }
}

fn check_records<P, G>(index: usize, member: &GasMember<P, G>) -> Result<()> {
    let Some(which) = &member.record_of_primitive else { return Ok(()) };
    let (primitives, materials) = (member.data.primitives(), member.records.len());
    if which.len() != primitives {
        return Err(Error::Scene(format!(
            "geometry {index} has {primitives} primitives but {} material numbers",
            which.len()
        )));
    }
    match which.iter().position(|&w| w as usize >= materials) {
        Some(primitive) => Err(Error::Scene(format!(
            "primitive {primitive} of geometry {index} has material number {}, but there are {materials} materials",
            which[primitive]
        ))),
        None => Ok(()),
    }
}

/// Instance ids and SBT offsets have 28 bits (guide 12).
const MAX_28_BITS: u32 = (1 << 28) - 1;
/// Levels of a traversable graph, with the GAS (guide 12).
const MAX_GRAPH_DEPTH: u32 = 31;

impl<P: Pipeline> IasBuilder<'_, P> {
    /// Builds it.
    pub fn build(self) -> Result<Accel<P>> {
        self.build_for(false)
    }

    /// Builds it so that programs may read its instances (`OPTIX_BUILD_FLAG_ALLOW_RANDOM_INSTANCE_ACCESS`, guide 13.12). The
    /// table is what a field of type [`Instances`](optix_device_rs::accel::Instances) holds.
    pub fn build_with_instances(self) -> Result<(Accel<P>, InstanceTable)> {
        let len = u32::try_from(self.instances.len())
            .map_err(|_| Error::Scene(format!("{} instances are more than an IAS has", self.instances.len())))?;
        let accel = self.build_for(true)?;
        // SAFETY: built for it, with so many instances.
        let table = unsafe { InstanceTable::new(accel.shared.world(), len) };
        Ok((accel, table))
    }

    fn build_for(self, random_instance_access: bool) -> Result<Accel<P>> {
        let state = &mut self.scene.state;
        if self.instances.is_empty() {
            return Err(Error::Scene("an IAS needs at least one instance".into()));
        }
        let mut instances = Vec::with_capacity(self.instances.len());
        let mut depth = 0;
        for (i, instance) in self.instances.iter().enumerate() {
            let child = &instance.child.shared;
            if child.scene != state.id {
                return Err(Error::Scene(format!("instance {i} is of another scene's acceleration structure")));
            }
            if instance.id > MAX_28_BITS {
                return Err(Error::Scene(format!("instance {i} has id {}, more than 28 bits", instance.id)));
            }
            if let Some([a, b]) = instance.flags.conflict() {
                return Err(Error::Scene(format!(
                    "instance {i} has the flags {a} and {b}, which exclude each other (guide 5.4): leave one out"
                )));
            }
            let rows = glam::Mat4::from(instance.transform).transpose().to_cols_array();
            let transform = core::array::from_fn(|k| rows[k]);
            if !instance.transform.is_finite() {
                return Err(Error::Scene(format!(
                    "instance {i} has a transform that is not finite: {}",
                    instance.transform
                )));
            }
            if Affine::from_f32(&transform).inverse().is_none() {
                return Err(Error::Scene(format!(
                    "instance {i} has a transform that can't be inverted, so rays can't be taken to its space: {}. An instance \
                     that shrinks to nothing, or to a plane, is left out where it gets there",
                    instance.transform
                )));
            }
            let sbt_offset = u64::from(child.first_slot) * u64::from(P::RAY_TYPES);
            let Some(sbt_offset) = u32::try_from(sbt_offset).ok().filter(|&offset| offset <= MAX_28_BITS) else {
                return Err(Error::Scene(format!("instance {i} has SBT offset {sbt_offset}, more than 28 bits")));
            };
            depth = depth.max(child.depth + 1);
            instances.push(InstanceInput {
                transform,
                id: instance.id,
                mask: instance.mask,
                flags: instance.flags,
                sbt_offset,
                child: child.built.clone(),
            });
        }
        if depth >= MAX_GRAPH_DEPTH {
            return Err(Error::Scene(format!(
                "{} levels of instances: a traversable graph has {MAX_GRAPH_DEPTH} levels with its geometry",
                depth
            )));
        }
        let built = self.scene.device.backend.build_ias(&IasInput { instances, random_instance_access })?;
        state.usage.depths.push(depth);
        Ok(Accel {
            shared: Arc::new(AccelShared {
                built,
                device: self.scene.device.backend.id(),
                scene: state.id,
                depth,
                first_slot: 0,
                slots: state.slots.len() as u32,
                roots: state.usage.roots.clone(),
                _children: self.instances.into_iter().map(|i| i.child.shared).collect(),
            }),
            pipeline: PhantomData,
        })
    }
}
