//! Generated functions through both code generators and on the CPU: the same bits.
//!
//! Contraction is off, so that rounding is the same everywhere. A plain CUDA kernel runs them, without OptiX; where there is no
//! GPU that half does not run, and says so, and the CPU's half only runs the functions.

use cudarc::driver::{CudaContext, DriverError, LaunchConfig, PushKernelArg};
use cudarc::nvrtc::Ptx;
use differential_functions::{FUNCTIONS, call};
use optix_device_rs::rng::Pcg32;
use optix_tests::devices;

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
    let stream = context.default_stream();
    let kernel = context.load_module(Ptx::from_src(ptx))?.load_function("differential")?;
    let from = stream.clone_htod(inputs)?;
    let mut to = stream.alloc_zeros::<u64>(FUNCTIONS as usize * inputs.len())?;
    let count = inputs.len() as u32;
    let grid =
        LaunchConfig { grid_dim: (count.div_ceil(128), FUNCTIONS, 1), block_dim: (128, 1, 1), shared_mem_bytes: 0 };
    // SAFETY: the kernel has these parameters, and stays within `count` inputs and `FUNCTIONS * count` outputs.
    unsafe { stream.launch_builder(&kernel).arg(&from).arg(&mut to).arg(&count).launch(grid)? };
    stream.clone_dtoh(&to)
}

#[test]
fn both_generators_and_the_cpu_compute_the_same() {
    let test = "both_generators_and_the_cpu_compute_the_same";
    let inputs = inputs();
    let expected = on_cpu(&inputs);
    let there = devices::cuda(test);
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
