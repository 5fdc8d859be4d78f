//! Triangles of many families, where they stand, and rays that leave them: for the bound of `SurfacePoint`.

use glam::{Affine3A, DAffine3, DVec3, Mat3, Quat, Vec3};
use optix_device_rs::pipeline::HasRayGen;
use optix_device_rs::rng::Pcg32;
use optix_host::{Aabb, BackendKind, CustomPrimitives, Device, Pipeline, Result, Scene, TriangleMesh, World};
use path_tracer::shaders::Ball;
pub use probe_shaders::spawn::{Departure, Spawn, Start};
use probe_shaders::spawn::{NONE, Sheet, Slab, SpawnFrameHost, between, leave, margin, neighbour};

use crate::probe::PTX;

/// Three vertices in object space.
pub type Triangle = [Vec3; 3];

/// Primitives, and the instances that they are in, the outermost first. Without any they are the root of a trace.
#[derive(Clone, Debug)]
pub struct Island {
    /// Transforms of the instances.
    pub levels: Vec<Affine3A>,
    /// What is there.
    pub content: Content,
}

/// What is in an island.
#[derive(Clone, Debug)]
pub enum Content {
    /// Triangles; a ray may be told to see one only.
    Triangles(Vec<Triangle>),
    /// A ball around the origin of object space.
    Ball(f32),
    /// A box around the origin of object space, by half its size.
    Slab(Vec3),
}

impl Island {
    /// Where a point of object space is in the world, in `f64`.
    pub fn to_world(&self, p: DVec3) -> DVec3 {
        self.levels.iter().rev().fold(p, |p, level| double(level).transform_point3(p))
    }
}

/// As `f64`, exactly.
pub fn double(map: &Affine3A) -> DAffine3 {
    DAffine3::from_cols(
        map.matrix3.x_axis.as_dvec3(),
        map.matrix3.y_axis.as_dvec3(),
        map.matrix3.z_axis.as_dvec3(),
        map.translation.as_dvec3(),
    )
}

/// Islands that rays are traced in, each on its own. All have as many levels; without levels there is one.
pub struct Field {
    device: Device,
    pipeline: Pipeline<Spawn>,
    worlds: Vec<World>,
}

impl Field {
    /// Builds them.
    pub fn new(device: &Device, islands: &[Island]) -> Result<Self> {
        let mut scene = Scene::<Spawn>::new(device);
        let mut worlds = Vec::new();
        for island in islands {
            let mut accel = match &island.content {
                Content::Triangles(triangles) => {
                    let sheet = scene.material(Sheet {})?;
                    let geometry = scene.geometry(TriangleMesh::new(triangles.as_flattened()))?;
                    scene.gas([geometry.with(&sheet)]).build()?
                }
                Content::Ball(radius) => {
                    let ball = scene.material(Ball { radius: *radius, reflectance: Vec3::ONE })?;
                    let size = Vec3::splat(*radius);
                    let geometry = scene.geometry(CustomPrimitives::new(&[Aabb { min: -size, max: size }]))?;
                    scene.gas([geometry.with(&ball)]).build()?
                }
                Content::Slab(half) => {
                    let slab = scene.material(Slab { half: *half })?;
                    let geometry = scene.geometry(CustomPrimitives::new(&[Aabb { min: -*half, max: *half }]))?;
                    scene.gas([geometry.with(&slab)]).build()?
                }
            };
            for level in island.levels.iter().rev() {
                accel = scene.ias([accel.at(*level)]).build()?;
            }
            worlds.push(accel.world()?);
        }
        let pipeline = Pipeline::for_scene(&scene).ptx(PTX).build()?;
        Ok(Self { device: device.clone(), pipeline, worlds })
    }

    fn run<P>(
        &self,
        island: usize,
        starts: &[Start],
        threads: usize,
        rays: u32,
        reach: f32,
        per_axis: bool,
    ) -> Result<Vec<Departure>>
    where
        Spawn: HasRayGen<P>,
    {
        let departures = self.device.zeroed(threads)?;
        let frame = SpawnFrameHost {
            starts: self.device.buffer(starts)?,
            departures: departures.clone(),
            world: self.worlds[island].clone(),
            rays,
            reach,
            per_axis,
        };
        self.pipeline.launch_program::<P>(&frame, [threads as u32, 1, 1])?.wait()?;
        Ok(departures.read()?)
    }

    /// Sends `rays` from each hit in all directions; `per_axis` with the bound of version 0.1.
    pub fn leave(&self, island: usize, starts: &[Start], rays: u32, per_axis: bool) -> Result<Vec<Departure>> {
        self.run::<leave>(island, starts, starts.len(), rays, f32::MAX, per_axis)
    }

    /// What the rays of the starts meet that end at `reach`: the error of the hit, 0 where there is none.
    pub fn met(&self, island: usize, starts: &[Start], reach: f32) -> Result<Vec<Departure>> {
        self.run::<leave>(island, starts, starts.len(), 0, reach, false)
    }

    /// Finds the largest offset that is too small: for `rays` directions, or with 0 for the given one.
    pub fn margins(&self, island: usize, starts: &[Start], rays: u32) -> Result<Vec<Departure>> {
        self.run::<margin>(island, starts, starts.len(), rays, f32::MAX, false)
    }

    /// Sends `rays` from each hit to the surface that is near it.
    pub fn neighbours(&self, island: usize, starts: &[Start], rays: u32) -> Result<Vec<Departure>> {
        self.run::<neighbour>(island, starts, starts.len(), rays, f32::MAX, false)
    }

    /// Sends segments between the hits of two starts in a row. The rays to these hits end at twice their distance.
    pub fn between(&self, island: usize, starts: &[Start]) -> Result<Vec<Departure>> {
        self.run::<between>(island, starts, starts.len() / 2, 0, 2.0, false)
    }
}

/// Random numbers, and what is made of them.
#[derive(Clone, Debug)]
pub struct Dice(Pcg32);

impl Dice {
    /// The same sequence for the same seed.
    pub fn new(seed: u64) -> Self {
        Self(Pcg32::hashed(seed, 77))
    }

    /// From 0 to 1.
    pub fn unit(&mut self) -> f32 {
        self.0.next_f32()
    }

    /// From -1 to 1.
    pub fn signed(&mut self) -> f32 {
        2.0 * self.unit() - 1.0
    }

    /// Below `n`.
    pub fn below(&mut self, n: u32) -> u32 {
        self.0.next_u32() % n
    }

    /// All bits.
    pub fn bits(&mut self) -> u32 {
        self.0.next_u32()
    }

    /// A power of two with a fraction: by exponents from `low` to `high`.
    pub fn power(&mut self, low: f32, high: f32) -> f32 {
        (low + (high - low) * self.unit()).exp2()
    }

    /// In a cube.
    pub fn cube(&mut self) -> Vec3 {
        Vec3::new(self.signed(), self.signed(), self.signed())
    }

    /// On a sphere.
    pub fn sphere(&mut self) -> Vec3 {
        loop {
            let v = self.cube();
            if v.length_squared() > 1e-2 && v.length_squared() <= 1.0 {
                return v.normalize();
            }
        }
    }

    /// One of them.
    pub fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len() as u32) as usize]
    }
}

/// `x`, so many floats away.
pub fn step(x: f32, by: i32) -> f32 {
    let order = |bits: i32| if bits < 0 { i32::MIN - bits } else { bits };
    f32::from_bits(order(order(x.to_bits() as i32).saturating_add(by)) as u32)
}

/// Families of triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// In a plane across an axis, at 0 or at another height.
    AxisAligned,
    /// The same, each vertex moved off the plane by up to ten ulp.
    Tilted,
    /// Any.
    Any,
    /// Up to a million times its size away.
    Far,
    /// From `2^20` to the largest that the machine can do.
    Huge,
    /// From the smallest that the machine can do to `2^-20`.
    Tiny,
    /// Up to `10^7` times as long as it is high.
    Needle,
}

/// All of them.
pub const FAMILIES: [Family; 7] =
    [Family::AxisAligned, Family::Tilted, Family::Any, Family::Far, Family::Huge, Family::Tiny, Family::Needle];

impl Family {
    /// One of the family, for a machine that can do triangles of sizes in `2^range`.
    pub fn triangle(self, range: [i32; 2], dice: &mut Dice) -> Triangle {
        match self {
            Self::AxisAligned | Self::Tilted => {
                let height = dice.pick(&[0.0, 1e-3, 0.1, 1.0, -1.0, 7.3, -40.0, 1e3]);
                let half = dice.pick(&[0.5, 1.0, 10.0, 100.0, 0.37, 3.3]);
                let axis = dice.below(3) as usize;
                let corners = if dice.below(2) == 0 {
                    [[-half, -half], [-half, half], [half, half]]
                } else {
                    [(); 3].map(|()| [half * dice.signed(), half * dice.signed()])
                };
                corners.map(|[a, b]| {
                    let off = if self == Self::Tilted { dice.below(21) as i32 - 10 } else { 0 };
                    // An ulp of the height, or of what the plane is large.
                    let tilted = if dice.below(2) == 0 { step(height, off) } else { height + off as f32 * half * 6e-8 };
                    let mut v = [tilted; 3];
                    (v[(axis + 1) % 3], v[(axis + 2) % 3]) = (a, b);
                    Vec3::from_array(v)
                })
            }
            Self::Any => {
                let size = dice.power(-4.0, 4.0);
                [(); 3].map(|()| dice.cube() * size)
            }
            Self::Far => {
                let (size, away) = (dice.power(-6.0, 4.0), dice.power(0.0, 20.0));
                let at = dice.sphere() * (size * away);
                [(); 3].map(|()| at + dice.cube() * size)
            }
            Self::Huge | Self::Tiny => loop {
                let [least, most] = range.map(|e| e as f32);
                let scale = if self == Self::Huge { dice.power(20.0, most) } else { dice.power(least, -20.0) };
                let of = dice.pick(&[Self::AxisAligned, Self::Any, Self::Far]);
                let triangle = of.triangle(range, dice);
                // So that the size is what counts.
                let size = triangle.iter().fold(0.0f32, |s, p| s.max(p.abs().max_element()));
                let scaled = triangle.map(|p| p / size * scale);
                if extent(&scaled) > least.exp2() {
                    return scaled;
                }
            },
            Self::Needle => {
                let (at, along) = (dice.cube() * dice.power(-4.0, 4.0), dice.sphere() * dice.power(-4.0, 4.0));
                let high = along.length() * dice.power(-23.0, -2.0);
                let across = along.cross(dice.sphere()).normalize() * high;
                let mut needle = [at, at + along, at + along * dice.unit() + across];
                needle.rotate_left(dice.below(3) as usize);
                needle
            }
        }
    }
}

/// The largest distance of two vertices on an axis.
pub fn extent([p0, p1, p2]: &Triangle) -> f32 {
    (p1 - p0).abs().max((p2 - p0).abs()).max((p2 - p1).abs()).max_element()
}

/// Sizes of triangles, as powers of two, at which a machine's test keeps the bound: beyond, products of coordinates over- and
/// underflow, and on OptiX those are products of three.
pub fn range(device: &Device) -> [i32; 2] {
    match device.kind() {
        BackendKind::Cpu => [-58, 56],
        BackendKind::Optix => [-28, 38],
    }
}

/// A transform of any kind: moves, scales, by axes too, shears, mirrors.
pub fn level(dice: &mut Dice) -> Affine3A {
    let turn = |dice: &mut Dice| Mat3::from_quat(Quat::from_axis_angle(dice.sphere(), dice.signed() * 3.2));
    let sizes = |dice: &mut Dice, range: f32| {
        Mat3::from_diagonal(Vec3::from_array(
            [(); 3].map(|()| dice.power(-range, range) * dice.pick(&[1.0, 1.0, 1.0, -1.0])),
        ))
    };
    let linear = match dice.below(6) {
        0 => Mat3::IDENTITY,
        1 => turn(dice),
        2 => turn(dice) * dice.power(-8.0, 8.0),
        3 => sizes(dice, 6.0),
        4 => turn(dice) * sizes(dice, 4.0),
        _ => turn(dice) * sizes(dice, 3.0) * turn(dice),
    };
    let by = if dice.below(4) == 0 { Vec3::ZERO } else { dice.cube() * dice.power(-3.0, 12.0) };
    Affine3A::from_mat3_translation(linear, by)
}

/// A start at the weights `[b1, b2]` of a triangle, from a direction and distance in object space that are given in lengths
/// of the triangle.
pub fn start(island: &Island, triangle: &Triangle, primitive: u32, [b1, b2]: [f32; 2], from: Vec3) -> Start {
    let [p0, p1, p2] = triangle.map(|p| p.as_dvec3());
    let (e1, e2) = (p1 - p0, p2 - p0);
    let size = e1.abs().max(e2.abs()).max_element();
    let at = p0 + e1 * f64::from(b1) + e2 * f64::from(b2);
    aimed(island, at, at + from.as_dvec3() * size, primitive)
}

/// A start between two points of object space.
pub fn aimed(island: &Island, at: DVec3, from: DVec3, primitive: u32) -> Start {
    let (target, origin) = (island.to_world(at), island.to_world(from).as_vec3());
    let direction = (target - origin.as_dvec3()).as_vec3();
    // Far away the origin may be rounded to the target; a ray without direction is undefined.
    let direction = if direction == Vec3::ZERO { Vec3::X } else { direction };
    Start {
        origin: origin.to_array(),
        primitive,
        direction: direction.to_array(),
        seed: 0,
        leaving: [0.0; 3],
        other: NONE,
    }
}

/// Weights inside of a triangle, or near its edges.
pub fn weights(dice: &mut Dice) -> [f32; 2] {
    let (a, b) = (dice.unit(), dice.unit());
    let [a, b] = if a + b > 1.0 { [1.0 - a, 1.0 - b] } else { [a, b] };
    match dice.below(5) {
        0 => [a, b * 1e-6],
        1 => [a * 1e-6, b],
        2 => [a, (1.0 - a) * (1.0 - 1e-6 * b)],
        _ => [a, b],
    }
}

/// The outermost direction that starts of [`start`] come from: any, at up to some lengths.
pub fn approach(dice: &mut Dice) -> Vec3 {
    dice.sphere() * dice.power(-2.0, 5.0)
}
