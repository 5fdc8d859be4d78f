//! Declarations that come out of `macro_rules!`.
#![deny(warnings)]

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    pub world: Traversable,
}

macro_rules! renderer {
    ($name:ident, $payload:ident, $record:ident, $field:ident: $ty:ty, $camera:ident, $shade:ident, $sky:ident) => {
        #[derive(Payload)]
        pub struct $payload {
            #[payload(write(caller, closesthit, miss), read(caller, closesthit))]
            pub $field: $ty,
            #[payload(write(closesthit, miss), read(caller))]
            pub depth: u32,
        }

        #[derive(Clone, Copy, SbtRecord)]
        #[repr(C)]
        pub struct $record {
            pub $field: $ty,
            pub normals: Slice<Vec3>,
        }

        pipeline! {
            pub struct $name {
                params: $crate::Frame,
                raygen: [$camera],
                rays: { $payload { miss: $sky } },
                hitgroups: { $record on Triangles => { $payload { closesthit: $crate::$shade } } },
            }
        }
    };
}

renderer!(First, Grey, GreyPaint, value: f32, grey_camera, grey_shade, grey_sky);
renderer!(Second, Coloured, ColouredPaint, value: Vec3, coloured_camera, coloured_shade, coloured_sky);

macro_rules! programs {
    ($pipeline:ident: $camera:ident, $shade:ident($record:ty, $at:ident) -> $from:ident, $sky:ident -> $missed:ident($value:expr)) => {
        #[raygen]
        pub fn $camera(_: &RayGen<$pipeline>) {}

        #[closesthit]
        pub fn $shade(_: &ClosestHit<$pipeline, Triangles>, record: &$record, ray: $at) -> $from {
            $from { value: record.value * ray.value, depth: 1 }
        }

        #[miss]
        pub fn $sky(_: &Miss<$pipeline>) -> $missed {
            $missed { value: $value, depth: 0 }
        }
    };
}

programs!(First: grey_camera, grey_shade(GreyPaint, GreyAtClosestHit) -> GreyFromClosestHit, grey_sky -> GreyFromMiss(1.0));
programs!(Second: coloured_camera, coloured_shade(ColouredPaint, ColouredAtClosestHit) -> ColouredFromClosestHit, coloured_sky -> ColouredFromMiss(Vec3::ONE));

macro_rules! twice {
    ($($module:ident)*) => {$(
        mod $module {
            use optix_device_rs::prelude::*;

            #[launch_params]
            pub struct Frame {
                pub film: SliceMut<u32>,
            }

            #[derive(Payload)]
            pub struct Radiance {
                #[payload(write(closesthit, miss), read(caller))]
                pub light: u32,
            }

            #[raygen]
            fn camera(_: &RayGen<Flat>) {}

            #[miss]
            fn sky(_: &Miss<Flat>) -> RadianceFromMiss {
                RadianceFromMiss { light: 1 }
            }

            pipeline! {
                pub struct Flat {
                    params: Frame,
                    raygen: [camera],
                    rays: { Radiance { miss: sky } },
                }
            }
        }
    )*};
}
twice! { first second }

fn main() {
    assert_ne!(First::DESCRIPTION.raygen[0].entry.name, Second::DESCRIPTION.raygen[0].entry.name);
}
