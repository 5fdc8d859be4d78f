//! A pipeline on cust's stream.

use glam::Vec3;
use optix_host::{Buffer, Device, Launch, Pipeline, Result, Scene, TriangleMesh, World};
use probe_shaders::{Probe, ProbeFrameHost, ProbeHit, ProbeRay, Surface};

/// Traces rays through one triangle.
pub struct Tracer {
    device: Device,
    pipeline: Pipeline<Probe>,
    world: World,
}

impl Tracer {
    /// Builds the scene.
    pub fn new(device: &Device) -> Result<Self> {
        let mut scene = Scene::<Probe>::new(device);
        let surface = scene.material(Surface {})?;
        let corners = [Vec3::NEG_ONE.with_z(0.0), Vec3::X.with_y(-1.0), Vec3::Y];
        let triangle = scene.geometry(TriangleMesh::new(&corners))?;
        let world = scene.gas([triangle.with(&surface)]).build()?.world()?;
        let pipeline = Pipeline::for_scene(&scene).ptx(optix_host::ptx!(probe_shaders)).build()?;
        Ok(Self { device: device.clone(), pipeline, world })
    }

    /// Begins to write to `hits` what each ray meets.
    pub fn begin(&self, rays: Buffer<ProbeRay>, hits: Buffer<ProbeHit>) -> Result<Launch> {
        let (count, tallies) = (rays.len() as u32, self.device.zeroed(0)?);
        let frame = ProbeFrameHost { rays, hits, tallies, world: self.world.clone(), secondary: 0, offset: 1.0 };
        self.pipeline.launch(&frame, [count, 1, 1])
    }
}
