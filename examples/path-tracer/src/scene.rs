//! The scene: a box lit by an area light, with a mesh, a mirror ball and a leaf.

use crate::knot::torus_knot;
use crate::mesh::{Mesh, fit_into};
use glam::{Affine3A, Quat, Vec3};
use optix_host::{Aabb, CustomPrimitives, Device, Result, Scene, TriangleMesh, World};
use path_tracer_shaders::{AreaLight, Ball, Emitter, Lambert, Leaf, PathTracer, Pinhole, SmoothHost};

/// The default scene on a device.
pub struct Cornell {
    /// Its records, for the pipeline.
    pub scene: Scene<PathTracer>,
    /// What rays are traced against.
    pub world: World,
    /// The light.
    pub light: AreaLight,
    /// The camera.
    pub camera: Pinhole,
}

/// Where the mesh stands: centre and extents of its place in the box, which reaches from -1 to 1 on each axis.
pub const MESH_PLACE: ([f32; 3], [f32; 3]) = ([-0.25, -0.35, -0.25], [1.15, 1.3, 1.15]);

/// The built-in mesh in its place.
pub fn knot() -> Mesh {
    let mut mesh = torus_knot(512, 48);
    fit_into(&mut mesh, MESH_PLACE.0, MESH_PLACE.1);
    mesh
}

/// The light: below the ceiling, downwards.
pub fn light() -> AreaLight {
    AreaLight::new(Vec3::new(-0.3, 0.995, -0.3), 0.6 * Vec3::X, 0.6 * Vec3::Z, Vec3::new(14.0, 12.0, 9.5))
}

/// A parallelogram as two triangles, `p00 p10 p11` and `p00 p11 p01`; its front is where `side` x `other` points.
pub fn parallelogram(corner: Vec3, side: Vec3, other: Vec3) -> [Vec3; 6] {
    let [p00, p10, p11, p01] = [corner, corner + side, corner + side + other, corner + other];
    [p00, p10, p11, p00, p11, p01]
}

/// The walls that face into the box: floor, ceiling and back; left; right.
pub fn walls() -> [Vec<Vec3>; 3] {
    let (x, y, z) = (Vec3::X * 2.0, Vec3::Y * 2.0, Vec3::Z * 2.0);
    let corner = Vec3::splat(-1.0);
    let floor = parallelogram(corner, z, x);
    let ceiling = parallelogram(corner + y, x, z);
    let back = parallelogram(corner, x, y);
    let left = parallelogram(corner, y, z);
    let right = parallelogram(corner + x, z, y);
    [[floor, ceiling, back].concat(), left.to_vec(), right.to_vec()]
}

/// The leaf's corner and sides.
pub fn leaf() -> (Vec3, Vec3, Vec3) {
    (Vec3::new(-0.95, -0.98, 0.62), Vec3::new(0.62, 0.75, -0.12), Vec3::new(-0.26, 0.3, 0.42))
}

/// Where the ball is: from its own space, where it has radius 1 around the origin.
pub fn ball_placement() -> Affine3A {
    Affine3A::from_scale_rotation_translation(
        Vec3::splat(0.34),
        Quat::from_rotation_y(0.4),
        Vec3::new(0.52, -0.66, 0.38),
    )
}

impl Cornell {
    /// Builds the scene around a mesh that is already in its place, for pictures `aspect` times as wide as high.
    pub fn new(device: &Device, mesh: &Mesh, aspect: f32) -> Result<Self> {
        let mut scene = Scene::<PathTracer>::new(device);

        let white = scene.material(Lambert { albedo: Vec3::splat(0.73) })?;
        let red = scene.material(Lambert { albedo: Vec3::new(0.63, 0.06, 0.05) })?;
        let green = scene.material(Lambert { albedo: Vec3::new(0.14, 0.45, 0.09) })?;
        let mut room = Vec::new();
        for (positions, material) in walls().iter().zip([white, red, green]) {
            room.push(scene.geometry(TriangleMesh::new(positions))?.with(&material));
        }
        let room = scene.gas(room).compact().build()?;

        let light = light();
        let emitter = scene.material(Emitter { emission: light.emission })?;
        let lamp = scene.geometry(TriangleMesh::new(&parallelogram(light.corner, light.side, light.other)))?;
        let lamp = scene.gas([lamp.with(&emitter)]).compact().build()?;

        let positions: Vec<Vec3> = mesh.positions.iter().map(|&p| p.into()).collect();
        let geometry = scene.geometry(TriangleMesh::new(&positions).indices(&mesh.indices))?;
        let albedo = Vec3::new(0.75, 0.52, 0.22);
        let member = match &mesh.normals {
            Some(normals) => {
                let normals: Vec<Vec3> = normals.iter().map(|&n| n.into()).collect();
                let (normals, indices) = (device.buffer(&normals)?, device.buffer(&mesh.indices)?);
                geometry.with(&scene.material(SmoothHost { albedo, normals, indices })?)
            }
            None => geometry.with(&scene.material(Lambert { albedo })?),
        };
        let mesh = scene.gas([member]).compact().build()?;

        let (corner, side, other) = leaf();
        let green_leaf = scene.material(Leaf { albedo: Vec3::new(0.22, 0.42, 0.07) })?;
        let leaf = scene.geometry(TriangleMesh::new(&parallelogram(corner, side, other)))?;
        let leaf = scene.gas([leaf.with(&green_leaf)]).compact().build()?;

        let mirror = scene.material(Ball { radius: 1.0, reflectance: Vec3::new(0.92, 0.93, 0.95) })?;
        let ball = scene.geometry(CustomPrimitives::new(&[Aabb { min: Vec3::NEG_ONE, max: Vec3::ONE }]))?;
        let ball = scene.gas([ball.with(&mirror)]).compact().build()?;

        let here = Affine3A::IDENTITY;
        let world = scene.ias([
            room.at(here).id(0),
            lamp.at(here).id(1),
            mesh.at(here).id(2),
            leaf.at(here).id(3),
            ball.at(ball_placement()).id(4),
        ]);
        let world = world.build()?.world()?;
        let camera = Pinhole::look_at(Vec3::new(0.0, 0.0, 3.9), Vec3::ZERO, Vec3::Y, 0.69, aspect);
        Ok(Self { scene, world, light, camera })
    }
}
