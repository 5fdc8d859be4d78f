//! The cases about records, parameters and buffers, put right: one module each, with the name of the case.
#![allow(dead_code, unused)]

mod record_self {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Node {
        pub children: Slice<u32>,
    }
}

mod record_tuple {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Lambert {
        pub albedo: Vec3,
    }
}

mod record_view_in_a_struct {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, DeviceData)]
    #[repr(C)]
    pub struct Texture {
        pub texels: Slice<Vec4>,
        pub width: u32,
    }

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Lambert {
        #[view]
        pub albedo: Texture,
    }
}

mod record_view_in_a_tuple {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Painted {
        pub texture: Slice<Vec4>,
    }
}

mod record_view_in_an_option {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Painted {
        pub texture: Slice<Vec4>,
    }
}

mod record_without_repr_c {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Lambert {
        pub albedo: Vec3,
    }
}

mod record_view_called_plain {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, DeviceData)]
    #[repr(C)]
    pub struct Hidden {
        pub data: SliceMut<u32>,
    }

    #[launch_params]
    pub struct Frame {
        #[view]
        pub hidden: Hidden,
    }
}

fn main() {}
