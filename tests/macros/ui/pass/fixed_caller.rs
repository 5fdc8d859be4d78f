//! The cases about callers and views, put right: one module each, with the name of the case.
#![allow(dead_code, unused)]

mod caller_gives_another_payload {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(caller, closesthit), read(closesthit, caller))]
        pub rng: Pcg32,
    }

    #[derive(Payload)]
    pub struct Shadow {
        #[payload(write(caller, miss), read(caller))]
        pub visible: bool,
    }

    #[raygen]
    pub fn camera<P: HasRay<Radiance> + HasRay<Shadow>>(rg: &RayGen<P>) {
        let start = ShadowFromCaller { visible: false };
        let _ = rg.trace::<Shadow>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), start);
    }
}

mod caller_gives_nothing {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(caller, closesthit), read(closesthit, caller))]
        pub rng: Pcg32,
    }

    #[raygen]
    pub fn camera<P: HasRay<Radiance>>(rg: &RayGen<P>) {
        let _ = rg.trace::<Radiance>(
            Traversable::NULL,
            Ray::new(Vec3::ZERO, Vec3::X),
            RadianceFromCaller { rng: Pcg32::new(1, 2) },
        );
    }
}

mod caller_gives_too_little {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(caller, closesthit), read(closesthit, caller))]
        pub rng: Pcg32,
    }

    #[raygen]
    pub fn camera<P: HasRay<Radiance>>(rg: &RayGen<P>) {
        let _ = rg.trace::<Radiance>(
            Traversable::NULL,
            Ray::new(Vec3::ZERO, Vec3::X),
            RadianceFromCaller { rng: Pcg32::new(1, 2) },
        );
    }
}

mod caller_has_no_part {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub world: Traversable,
    }

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
    }

    #[derive(Payload)]
    pub struct Touch {
        #[payload(write(caller), read(closesthit))]
        pub strength: f32,
    }

    fn gives<P: Pipeline<Params = Frame> + HasRay<Radiance>>(rg: &RayGen<P>, ray: Ray) -> Vec3 {
        let seen = rg.trace::<Radiance>(rg.params().world(), ray, ());
        seen.light
    }

    fn gets<P: Pipeline<Params = Frame> + HasRay<Touch>>(rg: &RayGen<P>, ray: Ray) {
        rg.trace::<Touch>(rg.params().world(), ray, TouchFromCaller { strength: 1.0 });
    }
}

mod caller_leaves_out_closesthit {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Shadow {
        #[payload(write(caller, miss), read(caller))]
        pub light: Vec3,
    }

    pub fn seen<P: HasRay<Shadow>>(rg: &RayGen<P>, world: Traversable, ray: Ray) -> Vec3 {
        rg.trace_without_closesthit::<Shadow>(world, ray, ShadowFromCaller { light: Vec3::ZERO }).light
    }
}

mod caller_names_no_ray {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(caller, closesthit), read(closesthit, caller))]
        pub rng: Pcg32,
    }

    #[derive(Payload)]
    pub struct Shadow {
        #[payload(write(caller, miss), read(caller))]
        pub visible: bool,
    }

    #[raygen]
    pub fn camera<P: HasRay<Radiance> + HasRay<Shadow>>(rg: &RayGen<P>) {
        let _ =
            rg.trace::<Shadow>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ShadowFromCaller { visible: false });
    }
}

mod caller_reads_what_does_not_come_back {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Probe {
        #[payload(write(caller), read(closesthit))]
        pub id: u32,
        #[payload(write(closesthit, miss), read(caller))]
        pub found: bool,
    }

    #[raygen]
    pub fn camera<P: HasRay<Probe>>(rg: &RayGen<P>) {
        let back = rg.trace::<Probe>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ProbeFromCaller { id: 7 });
        let _ = back.found;
    }
}

mod slice_forged {
    use optix_device_rs::prelude::*;

    pub fn table() -> Slice<u32> {
        Slice::EMPTY
    }
}

mod slice_of_bools {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Mask {
        pub bits: Slice<u8>,
    }
}

mod traversable_forged {
    use optix_device_rs::prelude::*;

    pub fn world() -> Traversable {
        Traversable::NULL
    }
}

mod twin_forgets_a_field {
    use optix_device_rs::host::Buffer;
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Painted {
        pub texels: Slice<Vec4>,
        pub scale: f32,
    }

    pub fn paint(texels: Buffer<Vec4>) -> PaintedHost {
        PaintedHost { texels, scale: 1.0 }
    }
}

mod twin_of_another_element {
    use optix_device_rs::host::Buffer;
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Painted {
        pub texels: Slice<Vec4>,
    }

    pub fn paint(texels: Buffer<Vec4>) -> PaintedHost {
        PaintedHost { texels }
    }
}

mod view_that_is_none {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Lambert {
        pub albedo: Vec3,
    }
}

mod twin_structure_without_instances {
    use optix_device_rs::host::{InstanceTable, World};
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub lamps: Instances,
    }

    pub fn frame(world: World, instances: InstanceTable) -> FrameHost {
        let _ = (&world, &instances);
        FrameHost { lamps: instances }
    }
}

mod twin_triangles_of_instances {
    use optix_device_rs::host::{InstanceTable, TriangleTable};
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub bulb: TriangleVertices,
    }

    pub fn frame(instances: InstanceTable, triangles: TriangleTable) -> FrameHost {
        let _ = (&instances, &triangles);
        FrameHost { bulb: triangles }
    }
}

mod twin_lowered_by_hand {
    use optix_device_rs::host::{Buffer, KeepAlive, HostData};
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Painted {
        pub texels: Slice<Vec4>,
    }

    pub fn texels(record: &PaintedHost) -> Buffer<Vec4> {
        record.texels.clone()
    }

    pub fn lower(record: &PaintedHost, keep: &mut KeepAlive) -> Painted {
        record.lower(keep)
    }
}

fn main() {}
