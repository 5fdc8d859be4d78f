//! The feature `cust` of optix-host: launches on cust's stream and in its memory, and the other way.

use std::sync::Arc;

use cust::context::Context;
use cust::memory::{AsyncCopyDestination, CopyDestination, DeviceBuffer};
use cust::stream::{Stream, StreamFlags};
use glam::Vec4;
use optix_cust_tests::Tracer;
use optix_host::{Device, Error, OptixOptions, cust as interop};

/// cust's context and stream, and a device on them, where there is a GPU. With `OPTIX_TEST_GPU=1` there must be one.
fn shared(test: &str) -> Option<(Context, Arc<Stream>, Device)> {
    if let Err(why) = Device::optix() {
        assert!(std::env::var_os("OPTIX_TEST_GPU").is_none(), "{test} is to run on a GPU: {why}");
        println!("{test}: not run on a GPU, {}", why.to_string().lines().next().unwrap_or_default());
        return None;
    }
    cust::init(cust::CudaFlags::empty()).expect("cust starts where OptiX does");
    let context = cust::device::Device::get_device(0).and_then(Context::new).expect("a context");
    let stream = Arc::new(Stream::new(StreamFlags::DEFAULT, None).expect("a stream"));
    let device = interop::device(&context, stream.clone(), &OptixOptions::default()).expect("a device on it");
    Some((context, stream, device))
}

/// The error's text, which is to be one that names what is wrong.
fn says<T>(result: Result<T, Error>, words: &[&str]) {
    let text = result.err().expect("it was accepted").to_string();
    words.iter().for_each(|word| assert!(text.contains(word), "`{word}` is not in: {text}"));
}

#[test]
fn launches_on_custs_stream_write_custs_memory() {
    let Some((_context, stream, device)) = shared("launches_on_custs_stream_write_custs_memory") else { return };
    // Origin, least `t`, direction, greatest `t`: a row of rays across the triangle and beyond it.
    let rays: Vec<[f32; 8]> =
        (0..1000).map(|i| [i as f32 * 0.003 - 1.5, 0.1, 2.0, 0.0, 0.0, 0.0, -1.0, f32::MAX]).collect();
    let own = Device::optix().unwrap();
    let expected = own.zeroed(rays.len()).unwrap();
    let rays_of_own = rays.iter().map(|&[x, y, z, tmin, dx, dy, dz, tmax]| probe_shaders::ProbeRay {
        origin: [x, y, z],
        tmin,
        direction: [dx, dy, dz],
        tmax,
    });
    let rays_of_own = own.buffer(&rays_of_own.collect::<Vec<_>>()).unwrap();
    Tracer::new(&own).unwrap().begin(rays_of_own, expected.clone()).unwrap().wait().unwrap();
    let expected = expected.read().unwrap();
    let expected =
        expected.iter().map(|h| [h.instance, h.primitive, h.kind, h.t.to_bits(), h.u.to_bits(), h.v.to_bits()]);
    let expected: Vec<[u32; 6]> = expected.collect();

    let tracer = Tracer::new(&device).unwrap();
    let rays = interop::buffer(&device, Arc::new(DeviceBuffer::from_slice(&rays).unwrap())).unwrap();
    let hits = Arc::new(DeviceBuffer::from_slice(&vec![[0u32; 6]; expected.len()]).unwrap());
    let launch = tracer.begin(rays, interop::buffer(&device, hits.clone()).unwrap()).unwrap();
    // The copy stands behind the launch, which nobody has waited for.
    let mut found = vec![[0u32; 6]; expected.len()];
    // SAFETY: `found` lives until the stream is done.
    unsafe { hits.async_copy_to(&mut found, &stream) }.unwrap();
    stream.synchronize().unwrap();
    launch.wait().unwrap();
    assert!(expected.iter().any(|hit| hit[0] == u32::MAX) && expected.iter().any(|hit| hit[0] != u32::MAX));
    assert_eq!(found, expected);

    assert!(Arc::ptr_eq(&interop::stream(&device).unwrap(), &stream));
    drop((tracer, device));
    stream.synchronize().expect("it is still cust's");
    assert_eq!(hits.as_host_vec().unwrap(), expected);
}

#[test]
fn our_memory_is_custs_too() {
    let Some((context, _, device)) = shared("our_memory_is_custs_too") else { return };
    let ours = device.buffer(&[Vec4::splat(1.0), Vec4::splat(2.0)]).unwrap();
    let mut theirs = interop::slice::<Vec4, [f32; 4]>(&ours).unwrap();
    let mut seen = [[0.0; 4]; 2];
    theirs.copy_to(&mut seen).unwrap();
    assert_eq!(seen, [[1.0; 4], [2.0; 4]]);
    theirs.copy_from(&[[3.0; 4], [4.0; 4]]).unwrap();
    assert_eq!(ours.read().unwrap(), [Vec4::splat(3.0), Vec4::splat(4.0)]);
    assert_eq!(interop::context(&device).unwrap().as_raw(), context.as_raw());

    let odd = Arc::new(DeviceBuffer::from_slice(&[1.0f32; 5]).unwrap());
    says(interop::buffer::<f32, Vec4>(&device, odd), &["20 bytes", "elements of 16 bytes"]);
    says(interop::stream(&Device::optix().unwrap()), &["the device's own", "optix_host::cust::device"]);
}

#[test]
fn the_cpu_shares_nothing_with_cust() {
    let device = Device::cpu().unwrap();
    says(interop::context(&device), &["the device is the CPU", "what to do"]);
    says(interop::stream(&device), &["the device is the CPU"]);
    says(interop::slice::<f32, f32>(&device.buffer(&[1.0]).unwrap()), &["the device is the CPU"]);
}
