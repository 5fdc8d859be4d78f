//! Which devices tests run on.

use optix_host::{Device, OptixOptions};

/// OptiX, where it is there; otherwise says why not. With `OPTIX_TEST_GPU=1` in the environment it must be there.
pub fn optix(test: &str) -> Option<Device> {
    optix_with(test, &OptixOptions::default())
}

/// As [`optix`], with options.
pub fn optix_with(test: &str, options: &OptixOptions) -> Option<Device> {
    match Device::optix_with(options) {
        Ok(device) => Some(device),
        Err(why) if std::env::var_os("OPTIX_TEST_GPU").is_some_and(|v| v == "1") => {
            panic!("{test} is to run on a GPU: {why}")
        }
        Err(why) => {
            println!("{test}: not run on a GPU, {}", why.to_string().lines().next().unwrap_or_default());
            None
        }
    }
}

/// The CPU, and OptiX where it is there.
pub fn all(test: &str) -> Vec<Device> {
    let mut devices = vec![Device::cpu().expect("the CPU needs nothing")];
    devices.extend(optix(test));
    devices
}

/// Whether there is a GPU for plain CUDA kernels; otherwise says why not. With `OPTIX_TEST_GPU=1` there must be.
pub fn cuda(test: &str) -> bool {
    match optix_host::optix::driver::devices() {
        Ok(devices) if !devices.is_empty() => true,
        other => {
            let why = other.map_or_else(|error| error.to_string(), |_| "no GPU".into());
            assert!(std::env::var_os("OPTIX_TEST_GPU").is_none_or(|v| v != "1"), "{test} is to run on a GPU: {why}");
            println!("{test}: not run on a GPU, {}", why.lines().next().unwrap_or_default());
            false
        }
    }
}
