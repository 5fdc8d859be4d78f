//! Builds scenes on a device: what [`scene`](crate::scene) describes and checks is given to the device's machine.

mod accel;
mod callable;
mod texture;

pub use accel::{GasBuilder, IasBuilder};
pub use texture::TextureBuilder;

use crate::geometry::IntoGeometry;
use crate::scene::{Geometry, Material, SceneState};
use crate::{Device, Result};
use optix_device_rs::host::HostData;
use optix_device_rs::payload::Payload;
use optix_device_rs::pipeline::{HasException, HasRay, HasRayGen, Pipeline};
use optix_device_rs::record::SbtRecord;
use std::marker::PhantomData;

/// A scene for pipeline `P`: it holds the records of the shader binding table and builds acceleration structures.
pub struct Scene<P> {
    pub(crate) device: Device,
    pub(crate) state: SceneState,
    pipeline: PhantomData<fn(P)>,
}

impl<P: Pipeline> Scene<P> {
    /// An empty scene on a device.
    pub fn new(device: &Device) -> Self {
        let state = SceneState::new(&P::DESCRIPTION, device.backend.id());
        Self { device: device.clone(), state, pipeline: PhantomData }
    }

    /// Checks and copies geometry: [`TriangleMesh`](crate::TriangleMesh) or [`CustomPrimitives`](crate::CustomPrimitives).
    pub fn geometry<I: IntoGeometry>(&mut self, geometry: I) -> Result<Geometry<I::Kind>> {
        Ok(Geometry::of(geometry)?)
    }

    /// Adds a material; `record` is the record struct, or its host counterpart where it holds views.
    pub fn material<H>(&mut self, record: H) -> Result<Material<P, H::Device>>
    where
        H: HostData<Device: SbtRecord<Host = H>>,
    {
        let record = self.state.lower(&record)?;
        self.state.add_material(record)
    }

    /// Gives the record of the miss program of rays `R`.
    pub fn miss<R: Payload>(&mut self, record: <P::MissRecord as SbtRecord>::Host) -> Result<()>
    where
        P: HasRay<R>,
    {
        self.state.miss[<P as HasRay<R>>::INDEX as usize] = self.state.lower(&record)?;
        Ok(())
    }

    /// Gives the record of ray-generation program `Prog`.
    pub fn raygen<Prog>(&mut self, record: <P::Record as SbtRecord>::Host) -> Result<()>
    where
        P: HasRayGen<Prog>,
    {
        self.state.raygen[<P as HasRayGen<Prog>>::INDEX as usize] = self.state.lower(&record)?;
        Ok(())
    }

    /// Gives the record of the exception program.
    pub fn exception(&mut self, record: <P::Record as SbtRecord>::Host) -> Result<()>
    where
        P: HasException,
    {
        self.state.exception = self.state.lower(&record)?;
        Ok(())
    }
}
