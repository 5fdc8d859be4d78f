//! The loads show something, on every device.

use glam::UVec2;
use optix_device_rs::pipeline::Pipeline;
use optix_host::{Device, Result};
use optix_peers::{Load, loads};

fn check<P: Pipeline>(load: Result<Load<P>>) {
    let load = load.unwrap();
    load.pipeline("").unwrap().launch().unwrap();
    let picture = load.picture().unwrap();
    let mean = picture.iter().sum::<f32>() / picture.len() as f32;
    assert!(picture.iter().all(|x| x.is_finite()), "{}", load.name);
    assert!(mean > 0.02, "{} is dark: {mean}", load.name);
    assert!(picture.iter().filter(|x| **x > 0.5 * mean).count() > picture.len() / 8, "{} is empty", load.name);
}

#[test]
fn every_load_shows_something() {
    let device = Device::cpu().unwrap();
    let size = UVec2::new(48, 27);
    check(loads::path_tracer(&device, size, 4));
    check(loads::occlusion(&device, size, 8));
    check(loads::foliage(&device, size, 10));
    check(loads::field(&device, size));
    check(loads::wide(&device, size, 2));
}
