//! Memory that a launch, the application and another launch read and write at the same time: no worse than on a GPU, and not
//! undefined. Elements of each width, since Rust does not define atomics of two widths on one place.
#![forbid(unsafe_code)]

use optix_device_rs::prelude::*;
use optix_host::{Device, Pipeline, Scene};
use std::thread;

const N: u32 = 5;

/// A pipeline that writes and reads a buffer of elements of one type.
macro_rules! element {
    ($($module:ident: $ty:ty, |$i:ident| $value:expr;)*) => {$(
        mod $module {
            use super::*;

            #[launch_params]
            pub struct Frame {
                pub out: SliceMut<$ty>,
                pub film: SliceMut2d<$ty>,
            }

            fn value($i: u32) -> $ty {
                $value
            }

            #[raygen]
            fn go(rg: &RayGen<Writes>) {
                let frame = rg.params();
                for i in 0..N {
                    frame.out().set(i, value(i));
                    frame.film().set(UVec2::new(i, 0), frame.out().get(i));
                }
            }

            pipeline! {
                pub struct Writes { params: Frame, raygen: [go], rays: {}, hitgroups: {} }
            }

            #[test]
            fn races_are_defined() {
                let device = Device::cpu().unwrap();
                let scene = Scene::<Writes>::new(&device);
                let pipeline = Pipeline::for_scene(&scene).build().unwrap();
                let out = device.zeroed::<$ty>(N as usize).unwrap();
                let film = device.zeroed_2d::<$ty>([N, 1]).unwrap();
                let expected: Vec<$ty> = (0..N).map(value).collect();
                thread::scope(|threads| {
                    let (reader, writer) = (out.clone(), film.clone());
                    threads.spawn(move || {
                        for element in reader.read().unwrap() {
                            // Old or new, or parts of both where it is wider than the memory's words.
                            let _ = element;
                        }
                    });
                    let same = expected.clone();
                    threads.spawn(move || writer.write(&same).unwrap());
                    let frame = FrameHost { out: out.clone(), film: film.clone() };
                    pipeline.launch(&frame, [2, 1, 1]).unwrap().wait().unwrap();
                });
                assert_eq!(out.read().unwrap(), expected);
                assert_eq!(film.read().unwrap(), expected);
            }
        }
    )*};
}

element! {
    bytes: u8, |i| i as u8 + 1;
    three_bytes: [u8; 3], |i| [i as u8, 7, 9];
    halves: u16, |i| i as u16 * 257;
    words: u32, |i| i.wrapping_mul(0x0101_0101);
    doubles: f64, |i| f64::from(i) + 0.5;
    vectors: Vec3, |i| Vec3::splat(i as f32);
    rows: Vec4, |i| Vec4::splat(i as f32);
    short_vectors: [u16; 3], |i| [i as u16; 3];
}
