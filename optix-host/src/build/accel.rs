//! Builds acceleration structures of geometry (GAS) and of instances (IAS) (guide 5).

use super::Scene;
use crate::Result;
use crate::geometry::GasPrimitive;
use crate::scene::{Accel, GasMember, Instance, SceneError};
use optix_device_rs::host::{InstanceTable, TriangleTable};
use optix_device_rs::pipeline::Pipeline;
use optix_device_rs::primitive::Triangles;

/// Gathers what a GAS is built of.
pub struct GasBuilder<'s, P, G: GasPrimitive> {
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
    /// A geometry acceleration structure of these members, all of one kind (guide 5).
    pub fn gas<G: GasPrimitive>(&mut self, members: impl IntoIterator<Item = GasMember<P, G>>) -> GasBuilder<'_, P, G> {
        GasBuilder { members: members.into_iter().collect(), compact: false, scene: self }
    }

    /// An instance acceleration structure of these instances (guide 5.4).
    pub fn ias(&mut self, instances: impl IntoIterator<Item = Instance<P>>) -> IasBuilder<'_, P> {
        IasBuilder { instances: instances.into_iter().collect(), scene: self }
    }
}

impl<P: Pipeline, G: GasPrimitive> GasBuilder<'_, P, G> {
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
        let Scene { device, state, .. } = self.scene;
        let input = state.gas_input(&self.members, self.compact, random_vertex_access)?;
        let built = device.backend.build_gas(&input)?;
        state.add_gas(&self.members, &input, built)
    }
}

impl<P: Pipeline> GasBuilder<'_, P, Triangles> {
    /// Builds it so that programs may read its triangles, which takes a little more memory
    /// (`OPTIX_BUILD_FLAG_ALLOW_RANDOM_VERTEX_ACCESS`, guide 13.9). The table is what a field of type
    /// [`TriangleVertices`](optix_device_rs::primitive::TriangleVertices) holds.
    pub fn build_with_triangles(self) -> Result<(Accel<P>, TriangleTable)> {
        let device = self.scene.device.clone();
        let counts: Vec<u32> = self.members.iter().flat_map(GasMember::primitives_by_record).collect();
        let accel = self.build_for(true)?;
        let counts = device.buffer(&counts)?;
        // SAFETY: built for it, with these records, each of a geometry of 2^29 triangles at the most; the buffer is nobody else's.
        let table = unsafe { TriangleTable::new(accel.shared.world(), counts) };
        Ok((accel, table))
    }
}

impl<P: Pipeline> IasBuilder<'_, P> {
    /// Builds it.
    pub fn build(self) -> Result<Accel<P>> {
        self.build_for(false)
    }

    /// Builds it so that programs may read its instances (`OPTIX_BUILD_FLAG_ALLOW_RANDOM_INSTANCE_ACCESS`, guide 13.12). The
    /// table is what a field of type [`Instances`](optix_device_rs::accel::Instances) holds.
    pub fn build_with_instances(self) -> Result<(Accel<P>, InstanceTable)> {
        let len = u32::try_from(self.instances.len())
            .map_err(|_| SceneError::TooMany { what: "instances in one IAS", count: self.instances.len() })?;
        let accel = self.build_for(true)?;
        // SAFETY: built for it, with so many instances.
        let table = unsafe { InstanceTable::new(accel.shared.world(), len) };
        Ok((accel, table))
    }

    fn build_for(self, random_instance_access: bool) -> Result<Accel<P>> {
        let Scene { device, state, .. } = self.scene;
        let input = state.ias_input(&self.instances, random_instance_access)?;
        let built = device.backend.build_ias(&input)?;
        Ok(state.add_ias(self.instances, built))
    }
}
