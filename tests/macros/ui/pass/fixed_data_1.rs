//! The cases about records, parameters and buffers, put right: one module each, with the name of the case.
#![allow(dead_code, unused)]

mod bound_of_another_type {
    use optix_device_rs::prelude::*;

    use optix_device_rs::params::Bound;

    #[launch_params]
    pub struct Frame {
        #[bound]
        pub max_bounces: u32,
        #[bound]
        pub exposure: f32,
    }

    pub const ONE: Bound<Frame, u32> = Frame::MAX_BOUNCES;
    pub const TWO: Bound<Frame, f32> = Frame::EXPOSURE;
}

mod element_alias {
    use optix_device_rs::prelude::*;

    type Flag = u8;

    #[derive(Clone, Copy, Element)]
    #[repr(C)]
    pub struct Vertex {
        pub hard: Flag,
    }
}

mod element_field {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Element)]
    #[repr(C)]
    pub struct Vertex {
        pub visible: u32,
        pub indices: [u32; 3],
    }
}

mod element_padding {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Element)]
    #[repr(C)]
    pub struct Vertex {
        pub flags: u32,
        pub position: Vec3,
        pub weight: f64,
    }
}

mod element_without_repr_c {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Element)]
    #[repr(C)]
    pub struct Vertex {
        pub position: Vec3,
    }
}

mod params_arguments {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub count: u32,
    }
}

mod params_below_derive {
    use optix_device_rs::prelude::*;

    #[launch_params]
    #[derive(Clone, Copy)]
    pub struct Frame {
        pub count: u32,
    }
}

mod params_bound_arguments {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        #[bound]
        pub max_bounces: u32,
    }
}

mod params_bound_name_taken {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        #[bound]
        pub max_bounces: u32,
    }

    impl Frame {
        pub const MOST_BOUNCES: u32 = 8;
    }
}

mod params_bound_nothing {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        #[bound]
        pub nothing: u32,
    }
}

mod params_bound_of_another_struct {
    use optix_device_rs::params::Bound;
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        #[bound]
        pub depth: u32,
    }

    #[launch_params]
    pub struct Other {
        #[bound]
        pub depth: u32,
    }

    pub const DEPTH: Bound<Frame, u32> = Frame::DEPTH;
}

mod params_bound_view {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub world: Traversable,
    }
}

mod params_cfg_field {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub count: u32,
        pub device_only: u32,
    }
}

mod params_enum {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub large: bool,
    }
}

mod params_field_not_data {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub count: u32,
    }
}

mod params_generic {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub value: f32,
    }
}

mod params_hidden_view {
    use optix_device_rs::prelude::*;

    type World = Traversable;

    #[launch_params]
    pub struct Frame {
        #[view]
        pub world: World,
        #[view]
        pub worlds: [World; 2],
    }
}

mod params_packed {
    use optix_device_rs::prelude::*;

    #[launch_params]
    #[repr(C)]
    pub struct Frame {
        pub value: u32,
    }
}

mod params_packed_by_cfg {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub flag: u8,
        pub count: u32,
    }
}

mod params_tuple {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub value: u32,
    }
}

mod record_alias_of_views {
    use optix_device_rs::prelude::*;

    type Textures<const N: usize> = [Slice<Vec4>; N];

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Painted {
        #[view]
        pub textures: Textures<2>,
    }
}

mod record_alignment {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C, align(16))]
    pub struct Lambert {
        pub albedo: Vec3,
    }
}

mod record_field_not_data {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, DeviceData)]
    #[repr(C)]
    pub struct Colour(f32, f32, f32);

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Lambert {
        pub albedo: Colour,
        pub name: u32,
    }
}

mod record_generic {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Lambert {
        pub albedo: Vec3,
    }
}

mod record_hidden_view {
    use optix_device_rs::prelude::*;

    type Texture = Slice<Vec4>;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Lambert {
        pub albedo: Vec3,
        #[view]
        pub texture: Texture,
    }
}

mod record_lifetime {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Painted {
        pub texels: Slice<Vec4>,
    }
}

mod record_made_by_a_macro {
    use optix_device_rs::prelude::*;

    macro_rules! record {
        ($name:ident, $ty:ty) => {
            #[derive(Clone, Copy, SbtRecord)]
            #[repr(C)]
            pub struct $name {
                pub data: $ty,
            }
        };
    }
    record!(Painted, Slice<Vec4>);
}

mod record_not_copy {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Lambert {
        pub albedo: Vec3,
    }
}

mod record_own_slice {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, DeviceData)]
    #[repr(C)]
    pub struct Range {
        pub first: u32,
        pub count: u32,
    }

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Mesh {
        pub triangles: Range,
    }
}

mod record_packed {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Lambert {
        pub albedo: Vec3,
    }
}

mod record_hides_instances {
    use optix_device_rs::prelude::*;

    type Lamps = Instances;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Lamp {
        #[view]
        pub lamps: Lamps,
    }
}

mod element_with_instances {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, DeviceData)]
    #[repr(C)]
    pub struct Lamp {
        #[view]
        pub lamps: Instances,
    }
}

mod params_alignment {
    use optix_device_rs::prelude::*;

    #[launch_params]
    #[repr(C, align(16))]
    pub struct Frame {
        pub bounces: u32,
    }
}

mod data_alignment {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, DeviceData)]
    #[repr(C, align(16))]
    pub struct Wide {
        pub numbers: [f32; 8],
    }
}

mod element_alignment {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Element)]
    #[repr(C, align(16))]
    pub struct Line(pub [u32; 16]);
}

mod data_of_one_machine {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Paint {
        #[cfg(feature = "extra")]
        pub extra: u32,
        pub colour: Vec3,
    }

    #[derive(Clone, Copy, Element)]
    #[repr(C)]
    pub struct Lamp {
        pub number: u32,
        pub colour: Vec3,
    }

    #[derive(Payload)]
    pub struct Probe {
        #[payload(write(caller), read(miss))]
        pub extra: u32,
        #[cfg_attr(not(target_arch = "nvptx64"), doc = "A number.")]
        #[payload(write(caller), read(miss))]
        pub id: u32,
    }

    #[derive(Clone, Copy, Attributes)]
    pub struct BallHit {
        pub normal: Vec3,
        pub id: u32,
    }

    #[derive(Clone, Copy, UserException)]
    pub enum Fault {
        Lost { id: u32 },
    }
}

mod bound_forged {
    use optix_device_rs::prelude::*;
    use optix_device_rs::params::Bound;

    #[launch_params]
    pub struct Frame {
        #[bound]
        pub bounces: u32,
    }

    pub const THERE: Bound<Frame, u32> = Frame::BOUNCES;
}

mod types_too_deep {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Paint {
        pub colours: [[[u32; 1]; 1]; 1],
    }

    #[launch_params]
    pub struct Frame {
        pub numbers: [[[u32; 1]; 1]; 1],
    }

    #[derive(Clone, Copy, Words)]
    pub struct Id(pub Option<Option<u32>>);
}

mod params_self_in_a_macro {
    use optix_device_rs::prelude::*;

    macro_rules! loaded {
        () => {
            u64
        };
    }

    #[launch_params]
    pub struct Frame {
        pub at: loaded!(),
    }
}

mod record_type_of_two_meanings {
    use optix_device_rs::prelude::*;

    mod __core {
        pub type Number = u64;
    }

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Paint {
        pub id: u64,
    }
}

fn main() {}
