//! Programs that write down what they are told of their primitive, its instances and their hit.

use optix_device_rs::prelude::*;
use path_tracer_shaders::ball::{self, Ball, BallHit};

/// What a program was told.
#[derive(Clone, Copy, Debug, PartialEq, Element)]
#[repr(C)]
pub struct Answer {
    /// Rows.
    pub object_to_world: [[f32; 4]; 3],
    /// Rows.
    pub world_to_object: [[f32; 4]; 3],
    /// [`AT`] as point, vector and normal, taken to world and then to object space.
    pub mapped: [[f32; 3]; 6],
    /// Of the transform list's first two instances: their matrices and the inverses.
    pub instances: [[[[f32; 4]; 3]; 2]; 2],
    /// Ray origin and direction in object space, where they are known.
    pub object_ray: [[f32; 3]; 2],
    /// Length of the transform list and the ids of its first two instances.
    pub list: [u32; 3],
    /// The innermost instance's id and index.
    pub instance: [u32; 2],
    /// Which of the first two instances have the primitive's GAS for a child: bits.
    pub gas_of: u32,
    /// Hit kind; 1 if a triangle; 1 for a front face, 2 for a back face.
    pub kind: [u32; 3],
    /// 1 if the vertices of the triangle, read by number, are those of the hit.
    pub vertices: u32,
}

/// What a program read of structures that it did not meet.
#[derive(Clone, Copy, Debug, PartialEq, Element)]
#[repr(C)]
pub struct Reading {
    /// Of the instance with this launch index: its matrix and the inverse.
    pub instance: [[[f32; 4]; 3]; 2],
    /// Its id.
    pub id: u32,
    /// Instances of the structure; records of the GAS; triangles of each.
    pub counts: [u32; 4],
    /// 1 if this and instance 0 have the same child.
    pub same_child: u32,
    /// Per record: the vertices of the triangle with this launch index.
    pub vertices: [[[f32; 3]; 3]; 2],
}

/// What is mapped between spaces.
pub const AT: Vec3 = Vec3::new(1.0, 2.0, 3.0);

const NOTHING: Answer = Answer {
    object_to_world: [[0.0; 4]; 3],
    world_to_object: [[0.0; 4]; 3],
    mapped: [[0.0; 3]; 6],
    instances: [[[[0.0; 4]; 3]; 2]; 2],
    object_ray: [[0.0; 3]; 2],
    list: [0; 3],
    instance: [0; 2],
    gas_of: 0,
    kind: [0; 3],
    vertices: 0,
};

/// The launch parameters.
#[launch_params]
pub struct QueryFrame {
    /// Origin and direction, one ray a launch index.
    pub rays: Slice<[[f32; 3]; 2]>,
    /// Per launch index: what its closest-hit and its any-hit program were told.
    pub answers: SliceMut<Answer>,
    /// Per launch index: what was read by ray generation.
    pub readings: SliceMut<Reading>,
    /// The scene.
    pub world: Traversable,
    /// The instances of a structure.
    pub instances: Instances,
    /// The triangles of a structure with two records.
    pub triangles: TriangleVertices,
}

/// Nothing needs to come back.
#[derive(Payload)]
pub struct Asked {
    /// Whether something was met.
    #[payload(write(caller, closesthit), read(caller))]
    pub met: bool,
}

/// A surface without data.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Bare {}

/// Traces the ray of this launch index.
#[raygen]
fn ask(rg: &RayGen<Queries>) {
    let [origin, direction] = rg.params().rays().get(rg.launch_index().x);
    let ray = Ray::new(Vec3::from_array(origin), Vec3::from_array(direction));
    let _ = rg.trace::<Asked>(rg.params().world(), ray, AskedFromCaller { met: false });
}

/// Reads the instance and the triangles with this launch index.
#[raygen]
pub fn read(rg: &RayGen<Queries>) {
    let (frame, index) = (rg.params(), rg.launch_index().x);
    let (instances, triangles) = (frame.instances(), frame.triangles());
    let instance = instances.get(rg, index);
    let vertices = [0, 1].map(|record| triangles.get(rg, record, index).map(|v| v.to_array()));
    frame.readings().set(
        index,
        Reading {
            instance: [instance.transform().rows(), instance.inverse_transform().rows()],
            id: instance.id(),
            counts: [instances.len(), triangles.records(), triangles.triangles(0), triangles.triangles(1)],
            same_child: u32::from(instance.child() == instances.get(rg, 0).child()),
            vertices,
        },
    );
}

macro_rules! answer {
    ($hit:ident) => {{
        let (mut answer, size) = (NOTHING, $hit.transform_list_size());
        answer.object_to_world = $hit.object_to_world().rows();
        answer.world_to_object = $hit.world_to_object().rows();
        answer.mapped = [
            $hit.point_to_world(AT),
            $hit.vector_to_world(AT),
            $hit.normal_to_world(AT),
            $hit.point_to_object(AT),
            $hit.vector_to_object(AT),
            $hit.normal_to_object(AT),
        ]
        .map(|v| v.to_array());
        answer.list[0] = size;
        if let Some(outer) = $hit.transform_list_handle(0).and_then(|transform| transform.instance()) {
            answer.list[1] = outer.id();
            answer.instances[0] = [outer.transform().rows(), outer.inverse_transform().rows()];
            answer.gas_of |= u32::from(outer.child() == $hit.gas_handle());
        }
        if let Some(inner) = $hit.transform_list_handle(1).and_then(|transform| transform.instance()) {
            answer.list[2] = inner.id();
            answer.instances[1] = [inner.transform().rows(), inner.inverse_transform().rows()];
            answer.gas_of |= u32::from(inner.child() == $hit.gas_handle()) << 1;
        }
        // Past the end of the list there is nothing.
        answer.list[0] += u32::from($hit.transform_list_handle(size).is_some()) << 16;
        answer.instance = [$hit.instance_id().unwrap_or(!0), $hit.instance_index()];
        let face = match $hit.hit_kind().face() {
            None => 0,
            Some(Face::Front) => 1,
            Some(Face::Back) => 2,
        };
        let triangle = $hit.primitive_type() == PrimitiveType::Triangle && $hit.hit_kind().is_triangle();
        answer.kind = [u32::from($hit.hit_kind().get()), u32::from(triangle), face];
        answer
    }};
}

macro_rules! same_vertices {
    ($hit:ident) => {
        u32::from($hit.params().triangles().get($hit, $hit.sbt_gas_index(), $hit.primitive_index()) == $hit.vertices())
    };
}

fn closest<A: Attributes>(hit: &ClosestHit<Queries, A>, vertices: u32) -> AskedFromClosestHit {
    hit.params().answers().set(hit.launch_index().x * 2, Answer { vertices, ..answer!(hit) });
    AskedFromClosestHit { met: true }
}

fn any<A: Attributes>(hit: &AnyHit<Queries, A>, vertices: u32) -> Decision {
    let mut answer = Answer { vertices, ..answer!(hit) };
    answer.object_ray = [hit.object_ray_origin(), hit.object_ray_direction()].map(|v| v.to_array());
    hit.params().answers().set(hit.launch_index().x * 2 + 1, answer);
    Decision::Accept
}

#[closesthit]
fn closest_triangle(hit: &ClosestHit<Queries, Triangles>) -> AskedFromClosestHit {
    closest(hit, same_vertices!(hit))
}

#[anyhit]
fn any_triangle(hit: &AnyHit<Queries, Triangles>) -> Decision {
    any(hit, same_vertices!(hit))
}

#[closesthit]
fn closest_ball(hit: &ClosestHit<Queries, BallHit>) -> AskedFromClosestHit {
    closest(hit, 0)
}

#[anyhit]
fn any_ball(hit: &AnyHit<Queries, BallHit>) -> Decision {
    any(hit, 0)
}

pipeline! {
    /// Writes down what programs are told.
    pub struct Queries {
        params: QueryFrame,
        raygen: [ask, read],
        rays: { Asked {} },
        hitgroups: {
            Bare on Triangles => { Asked { closesthit: closest_triangle, anyhit: any_triangle } },
            Ball on Custom => { Asked { intersection: ball::ball, closesthit: closest_ball, anyhit: any_ball } },
        },
    }
}
