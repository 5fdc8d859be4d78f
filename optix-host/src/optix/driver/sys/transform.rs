//! Transform traversables, which the application lays out in device memory (guide 5.9, 5.10).

use super::{OptixMotionOptions, OptixTraversableHandle};

abi_consts! {
    /// What a pointer to a transform points to.
    OptixTraversableType: u32 {
        STATIC_TRANSFORM = 8641,
        MATRIX_MOTION_TRANSFORM = 8642,
        SRT_MOTION_TRANSFORM = 8643,
    }
}

abi_structs! {
    OptixStaticTransform: size 112 align 8 {
        0 child: OptixTraversableHandle,
        8 pad: [u32; 2],
        16 transform: [f32; 12],
        64 inv_transform: [f32; 12],
    }

    /// With two keys. More keys continue the `transform` array past the end of the structure.
    OptixMatrixMotionTransform: size 128 align 8 {
        0 child: OptixTraversableHandle,
        8 motion_options: OptixMotionOptions,
        20 pad: [u32; 3],
        32 transform: [[f32; 12]; 2],
    }

    /// Scale with shear and pivot, rotation as a quaternion, translation (guide 5.10.5).
    OptixSRTData: size 64 align 4 {
        0 sx: f32,
        4 a: f32,
        8 b: f32,
        12 pvx: f32,
        16 sy: f32,
        20 c: f32,
        24 pvy: f32,
        28 sz: f32,
        32 pvz: f32,
        36 qx: f32,
        40 qy: f32,
        44 qz: f32,
        48 qw: f32,
        52 tx: f32,
        56 ty: f32,
        60 tz: f32,
    }

    /// With two keys. More keys continue the `srt_data` array past the end of the structure.
    OptixSRTMotionTransform: size 160 align 8 {
        0 child: OptixTraversableHandle,
        8 motion_options: OptixMotionOptions,
        20 pad: [u32; 3],
        32 srt_data: [OptixSRTData; 2],
    }
}
