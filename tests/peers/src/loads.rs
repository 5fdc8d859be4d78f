//! The loads.

use crate::load::{Film, Load};
use glam::{Affine3A, Quat, UVec2, Vec3};
use optix_device_rs::rng::Pcg32;
use optix_host::{Aabb, CustomPrimitives, Device, Geometry, Result, Scene, TriangleMesh};
use path_tracer::scene::{self, Cornell};
use path_tracer::shaders::{FrameHost, PathTracer, Pinhole};
use peer_shaders::field::{Field, FieldFrameHost, Gyroid};
use peer_shaders::foliage::{Blade, Foliage, FoliageFrameHost, Ground};
use peer_shaders::occlusion::{Clay, Occlusion, OcclusionFrameHost};
use peer_shaders::wide::{Paint, Wide, WideFrameHost};

const PEERS: &str = "peer_shaders";

fn camera(size: UVec2) -> Pinhole {
    Pinhole::look_at(Vec3::new(0.0, 0.0, 3.9), Vec3::ZERO, Vec3::Y, 0.69, size.x as f32 / size.y as f32)
}

/// The walls of the box and the knot, as geometries of one GAS each.
fn room<P: optix_device_rs::pipeline::Pipeline>(
    scene: &mut Scene<P>,
) -> Result<[Geometry<optix_device_rs::prelude::Triangles>; 2]> {
    let walls = scene.geometry(TriangleMesh::new(&scene::walls().concat()))?;
    let mesh = scene::knot();
    let positions: Vec<Vec3> = mesh.positions.iter().map(|&p| p.into()).collect();
    Ok([walls, scene.geometry(TriangleMesh::new(&positions).indices(&mesh.indices))?])
}

/// The examples' path tracer in its default scene.
pub fn path_tracer(device: &Device, size: UVec2, samples: u32) -> Result<Load<PathTracer>> {
    let Cornell { scene, world, light, camera } = Cornell::new(device, &scene::knot(), size.x as f32 / size.y as f32)?;
    let (sum, squares) = (device.zeroed_2d(size.into())?, device.zeroed_2d(size.into())?);
    let frame = FrameHost {
        sum: sum.clone(),
        squares,
        world,
        camera,
        light,
        first_sample: 0,
        samples,
        seed: 1,
        max_bounces: 8,
    };
    Ok(Load { name: "path_tracer", shaders: "path_tracer_shaders", scene, frame, film: Film::Colour(sum) })
}

/// Ambient occlusion in the box with the knot.
pub fn occlusion(device: &Device, size: UVec2, samples: u32) -> Result<Load<Occlusion>> {
    let mut scene = Scene::<Occlusion>::new(device);
    let clay = scene.material(Clay {})?;
    let [walls, knot] = room(&mut scene)?;
    let parts = [scene.gas([walls.with(&clay)]).compact().build()?, scene.gas([knot.with(&clay)]).compact().build()?];
    let world = scene.ias(parts.iter().map(|part| part.at(Affine3A::IDENTITY))).build()?.world()?;
    let film = device.zeroed_2d(size.into())?;
    let frame = OcclusionFrameHost { film: film.clone(), world, camera: camera(size), samples, radius: 0.5 };
    Ok(Load { name: "occlusion", shaders: PEERS, scene, frame, film: Film::Grey(film) })
}

/// A field of `across * across` plants of 48 leaves.
pub fn foliage(device: &Device, size: UVec2, across: u32) -> Result<Load<Foliage>> {
    let mut scene = Scene::<Foliage>::new(device);
    let blade = scene.material(Blade { albedo: Vec3::new(0.3, 0.6, 0.1), transmittance: 0.35 })?;
    let ground = scene.material(Ground { albedo: Vec3::new(0.35, 0.25, 0.15) })?;
    let mut rng = Pcg32::new(7, 1);
    let mut leaves = Vec::new();
    for leaf in 0..48 {
        let turn = Quat::from_rotation_y(2.4 * leaf as f32) * Quat::from_rotation_z(0.2 + 1.1 * rng.next_f32());
        let up = Vec3::Y * (0.1 + 0.02 * leaf as f32);
        leaves.extend(scene::parallelogram(up, turn * Vec3::new(0.6, 0.1, 0.0), turn * Vec3::new(-0.1, 0.0, 0.3)));
    }
    let plant = scene.geometry(TriangleMesh::new(&leaves))?;
    let plant = scene.gas([plant.with(&blade)]).compact().build()?;
    let reach = 0.4 * across as f32;
    let floor = scene::parallelogram(Vec3::new(-reach, 0.0, -reach), Vec3::Z * 2.0 * reach, Vec3::X * 2.0 * reach);
    let floor = scene.geometry(TriangleMesh::new(&floor))?;
    let floor = scene.gas([floor.with(&ground)]).compact().build()?;
    let mut instances = vec![floor.at(Affine3A::IDENTITY)];
    for i in 0..across * across {
        let place = Vec3::new((i % across) as f32 + rng.next_f32(), 0.0, (i / across) as f32 + rng.next_f32());
        let turn = Quat::from_rotation_y(std::f32::consts::TAU * rng.next_f32());
        let scale = Vec3::splat(0.7 + 0.6 * rng.next_f32());
        let place = place * 0.8 - Vec3::new(reach, 0.0, reach);
        instances.push(plant.at(Affine3A::from_scale_rotation_translation(scale, turn, place)));
    }
    let world = scene.ias(instances).build()?.world()?;
    let film = device.zeroed_2d(size.into())?;
    let aspect = size.x as f32 / size.y as f32;
    let camera = Pinhole::look_at(Vec3::new(0.0, 5.0, reach * 0.9), Vec3::ZERO, Vec3::Y, 0.9, aspect);
    let sun = Vec3::new(0.4, 0.8, 0.3).normalize();
    let frame = FoliageFrameHost { film: film.clone(), world, camera, sun };
    Ok(Load { name: "foliage", shaders: PEERS, scene, frame, film: Film::Colour(film) })
}

/// Five gyroids, turned and scaled.
pub fn field(device: &Device, size: UVec2) -> Result<Load<Field>> {
    let mut scene = Scene::<Field>::new(device);
    let gyroid = scene.material(Gyroid { frequency: 1.1, thickness: 0.03 })?;
    let unit = scene.geometry(CustomPrimitives::new(&[Aabb { min: Vec3::NEG_ONE, max: Vec3::ONE }]))?;
    let gas = scene.gas([unit.with(&gyroid)]).compact().build()?;
    let places = [(0.0, 0.0, 1.0), (-1.1, 0.75, 0.45), (1.1, 0.7, 0.4), (-1.05, -0.8, 0.4), (1.1, -0.75, 0.45)];
    let instances = places.iter().zip(0..).map(|(&(x, y, scale), i)| {
        let turn = Quat::from_rotation_y(0.5 + i as f32) * Quat::from_rotation_x(0.4 * i as f32);
        gas.at(Affine3A::from_scale_rotation_translation(Vec3::splat(scale * 0.8), turn, Vec3::new(x, y, 0.0)))
    });
    let world = scene.ias(instances).build()?.world()?;
    let film = device.zeroed_2d(size.into())?;
    let sun = Vec3::new(0.5, 0.6, 0.7).normalize();
    let frame = FieldFrameHost { film: film.clone(), world, camera: camera(size), sun };
    Ok(Load { name: "field", shaders: PEERS, scene, frame, film: Film::Colour(film) })
}

/// Paths with a wide payload in the open box with the knot.
pub fn wide(device: &Device, size: UVec2, samples: u32) -> Result<Load<Wide>> {
    let mut scene = Scene::<Wide>::new(device);
    let white = scene.material(Paint { albedo: Vec3::splat(0.8) })?;
    let brass = scene.material(Paint { albedo: Vec3::new(0.75, 0.52, 0.22) })?;
    let [walls, knot] = room(&mut scene)?;
    let parts = [scene.gas([walls.with(&white)]).compact().build()?, scene.gas([knot.with(&brass)]).compact().build()?];
    let world = scene.ias(parts.iter().map(|part| part.at(Affine3A::IDENTITY))).build()?.world()?;
    let [film, albedo, normal] = [(); 3].map(|()| device.zeroed_2d(size.into()));
    let (film, albedo, normal) = (film?, albedo?, normal?);
    let frame = WideFrameHost { film: film.clone(), albedo, normal, world, camera: camera(size), samples, segments: 8 };
    Ok(Load { name: "wide", shaders: PEERS, scene, frame, film: Film::Colour(film) })
}
