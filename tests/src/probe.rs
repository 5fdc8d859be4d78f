//! Traces lists of rays through the probe pipeline.

use glam::{Affine3A, Vec3};
use optix_host::{Aabb, Buffer, CustomPrimitives, Device, Pipeline, Result, Scene, TriangleMesh, World};
use path_tracer::shaders::Ball;
use probe_shaders::{Probe, ProbeFrameHost, Surface, respawn};
pub use probe_shaders::{ProbeHit, ProbeRay};

/// The PTX of the probe shaders.
pub const PTX: &str = optix_host::ptx!(probe_shaders);

/// A part of a scene: triangles, and where its instance stands.
pub struct Part<'a> {
    /// Positions in object space.
    pub positions: &'a [Vec3],
    /// Three per triangle; none where positions are triangles already.
    pub indices: Option<&'a [[u32; 3]]>,
    /// To world space.
    pub transform: Affine3A,
}

/// A scene that rays are traced through; the instance ids are the indices of its parts.
pub struct Tracer {
    device: Device,
    pipeline: Pipeline<Probe>,
    world: World,
}

/// Of secondary rays: how many met the triangle they left, missed all, and were traced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Met the triangle they left.
    pub own: u64,
    /// Missed all.
    pub missed: u64,
    /// Traced.
    pub traced: u64,
}

impl Tracer {
    /// Builds the scene.
    pub fn new(device: &Device, parts: &[Part<'_>]) -> Result<Self> {
        Self::with_balls(device, parts, &[])
    }

    /// Builds the scene, with unit balls so placed after the parts.
    pub fn with_balls(device: &Device, parts: &[Part<'_>], balls: &[Affine3A]) -> Result<Self> {
        let mut scene = Scene::<Probe>::new(device);
        let surface = scene.material(Surface {})?;
        let mut instances = Vec::new();
        for (id, part) in parts.iter().enumerate() {
            let mesh = TriangleMesh::new(part.positions);
            let mesh = part.indices.map_or(mesh, |indices| mesh.indices(indices));
            let geometry = scene.geometry(mesh)?;
            let gas = scene.gas([geometry.with(&surface)]).compact().build()?;
            instances.push(gas.at(part.transform).id(id as u32));
        }
        if !balls.is_empty() {
            let ball = scene.material(Ball { radius: 1.0, reflectance: Vec3::ONE })?;
            let unit = scene.geometry(CustomPrimitives::new(&[Aabb { min: Vec3::NEG_ONE, max: Vec3::ONE }]))?;
            let gas = scene.gas([unit.with(&ball)]).compact().build()?;
            instances.extend(balls.iter().zip(parts.len()..).map(|(&at, id)| gas.at(at).id(id as u32)));
        }
        let world = scene.ias(instances).build()?.world()?;
        let pipeline = Pipeline::for_scene(&scene).ptx(PTX).build()?;
        Ok(Self { device: device.clone(), pipeline, world })
    }

    fn frame(&self, rays: Buffer<ProbeRay>, hits: Buffer<ProbeHit>, tallies: Buffer<[u32; 4]>) -> ProbeFrameHost {
        ProbeFrameHost { rays, hits, tallies, world: self.world.clone(), secondary: 0, offset: 1.0 }
    }

    /// What each ray meets first.
    pub fn trace(&self, rays: &[ProbeRay]) -> Result<Vec<ProbeHit>> {
        let hits = self.device.zeroed(rays.len())?;
        let frame = self.frame(self.device.buffer(rays)?, hits.clone(), self.device.zeroed(0)?);
        self.pipeline.launch(&frame, [rays.len() as u32, 1, 1])?.wait()?;
        Ok(hits.read()?)
    }

    /// Sends `secondary` rays from where each ray hits, moved by `offset` times the error bound.
    pub fn respawn(&self, rays: &[ProbeRay], secondary: u32, offset: f32) -> Result<Tally> {
        let tallies = self.device.zeroed(rays.len())?;
        let mut frame = self.frame(self.device.buffer(rays)?, self.device.zeroed(0)?, tallies.clone());
        (frame.secondary, frame.offset) = (secondary, offset);
        self.pipeline.launch_program::<respawn>(&frame, [rays.len() as u32, 1, 1])?.wait()?;
        Ok(tallies.read()?.iter().fold(Tally::default(), |all, [own, missed, traced, _]| Tally {
            own: all.own + u64::from(*own),
            missed: all.missed + u64::from(*missed),
            traced: all.traced + u64::from(*traced),
        }))
    }
}

/// A ray over all of its line ahead.
pub fn ray(origin: Vec3, direction: Vec3) -> ProbeRay {
    ProbeRay { origin: origin.to_array(), tmin: 0.0, direction: direction.to_array(), tmax: f32::MAX }
}
