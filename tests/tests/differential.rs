//! Generated functions through both code generators and on the CPU: the same bits.
//!
//! Contraction is off, so that rounding is the same everywhere. A plain CUDA kernel runs them, without OptiX; where there is no
//! GPU that half does not run, and says so, and the CPU's half only runs the functions.

use std::ffi::{CString, c_void};

use cudarc::driver::result::{self, DriverError};
use cudarc::driver::{CudaContext, DevicePtr, DevicePtrMut};
use differential_functions::{FUNCTIONS, call};
use optix_device_rs::rng::Pcg32;

/// What makes the PTX, and the PTX; empty where it was not there when the tests were compiled.
const GENERATORS: [(&str, &str); 2] = [
    ("rustc", include_str!(concat!(env!("OUT_DIR"), "/differential.rustc.ptx"))),
    ("libNVVM", include_str!(concat!(env!("OUT_DIR"), "/differential.nvvm.ptx"))),
];

/// Inputs: what is special in some width, and random words.
fn inputs() -> Vec<[u64; 4]> {
    const SPECIAL: [u64; 12] =
        [0, 1, 7, 0x7f, 0x80, 0xffff, 0x7fff_ffff, 0x8000_0000, u32::MAX as u64, i64::MAX as u64, 1 << 63, u64::MAX];
    let mut rng = Pcg32::hashed(7, 0);
    let mut word = move || u64::from(rng.next_u32()) << 32 | u64::from(rng.next_u32());
    (0..2048)
        .map(|i| {
            std::array::from_fn(|_| {
                let random = word();
                if i % 2 == 0 { SPECIAL[(random % SPECIAL.len() as u64) as usize] } else { random >> (random % 57) }
            })
        })
        .collect()
}

fn on_cpu(inputs: &[[u64; 4]]) -> Vec<u64> {
    (0..FUNCTIONS).flat_map(|function| inputs.iter().map(move |input| call(function, input))).collect()
}

fn on_gpu(ptx: &str, inputs: &[[u64; 4]]) -> Result<Vec<u64>, DriverError> {
    let context = CudaContext::new(0)?;
    context.bind_to_thread()?;
    let stream = context.default_stream();
    let words: Vec<u64> = inputs.iter().flatten().copied().collect();
    let from = stream.clone_htod(&words)?;
    let mut to = stream.alloc_zeros::<u64>(FUNCTIONS as usize * inputs.len())?;
    let mut count = inputs.len() as u32;
    let image = CString::new(ptx).expect("PTX is text");
    {
        let (mut from, _read) = from.device_ptr(&stream);
        let (mut to, _written) = to.device_ptr_mut(&stream);
        let mut arguments: [*mut c_void; 3] = [(&raw mut from).cast(), (&raw mut to).cast(), (&raw mut count).cast()];
        // SAFETY: the text ends with a zero; the kernel has these parameters, and stays within `count` inputs and
        // `FUNCTIONS * count` outputs, which live until the stream is through.
        unsafe {
            let module = result::module::load_data(image.as_ptr().cast())?;
            let kernel = result::module::get_function(module, c"differential".to_owned())?;
            let grid = (count.div_ceil(128), FUNCTIONS, 1);
            result::launch_kernel(kernel, grid, (128, 1, 1), 0, stream.cu_stream(), &mut arguments)?;
        }
        stream.synchronize()?;
    }
    stream.clone_dtoh(&to)
}

/// Whether a CUDA GPU is there; with `OPTIX_TEST_GPU=1` it must be.
fn gpu(test: &str) -> bool {
    let devices = optix_host::optix::driver::devices();
    match devices {
        Ok(devices) if !devices.is_empty() => true,
        other => {
            let why = other.map_or_else(|error| error.to_string(), |_| "no GPU".into());
            assert!(std::env::var_os("OPTIX_TEST_GPU").is_none_or(|v| v != "1"), "{test} is to run on a GPU: {why}");
            println!("{test}: not run on a GPU, {}", why.lines().next().unwrap_or_default());
            false
        }
    }
}

#[test]
fn both_generators_and_the_cpu_compute_the_same() {
    let test = "both_generators_and_the_cpu_compute_the_same";
    let inputs = inputs();
    let expected = on_cpu(&inputs);
    let there = gpu(test);
    for (generator, ptx) in GENERATORS {
        if ptx.is_empty() {
            println!("{test}: {generator} not run, it was not there when this was compiled");
            continue;
        }
        assert!(ptx.contains(".entry differential"), "{generator}");
        if !there {
            continue;
        }
        let results = on_gpu(ptx, &inputs).unwrap_or_else(|error| panic!("{generator}: {error}"));
        let mut wrong = Vec::new();
        for (at, (result, expected)) in results.iter().zip(&expected).enumerate() {
            if result != expected {
                let (function, input) = (at / inputs.len(), inputs[at % inputs.len()]);
                wrong.push(format!("f{function}({input:x?}) is {result:x}, not {expected:x}"));
            }
        }
        println!("{test}: {generator}: {} results, {} differ from the CPU's", results.len(), wrong.len());
        assert!(wrong.is_empty(), "{generator}: {}", wrong.iter().take(20).cloned().collect::<Vec<_>>().join("\n"));
    }
}
