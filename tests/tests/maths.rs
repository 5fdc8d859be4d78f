//! The error of the device's maths where it runs: of every `f32` on a GPU, of a sample of them on the CPU, whose functions are
//! the standard library's.
//!
//! The GPU's figures are those of docs/maths.md.

use maths_shaders::{FUNCTIONS, Maths, MathsFrameHost, Measure, Worst};
use optix_host::{BackendKind, Device, Pipeline, Scene};
use optix_tests::devices;

const PTX: &str = optix_host::ptx!(maths_shaders);

/// The worst of a function on a device, of `launches * count` arguments that are `stride` apart.
fn sweep(device: &Device, pipeline: &Pipeline<Maths>, function: u32, launches: u32, count: u32, stride: u32) -> Worst {
    let worst = device.zeroed(launches as usize).unwrap();
    let frame = MathsFrameHost { worst: worst.clone(), function, count, stride };
    pipeline.launch(&frame, [launches, 1, 1]).unwrap().wait().unwrap();
    let found = worst.read().unwrap();
    found.into_iter().fold(Worst { error: 0.0, at: 0, correct: 0, tried: 0 }, |a, b| {
        let (error, at) = if b.error > a.error { (b.error, b.at) } else { (a.error, a.at) };
        // All 2^32 are one more than fits, but no function of all of them is correctly rounded everywhere.
        Worst { error, at, correct: a.correct.wrapping_add(b.correct), tried: a.tried.wrapping_add(b.tried) }
    })
}

#[test]
fn errors_are_below_their_bounds() {
    let mut missed = Vec::new();
    for device in devices::all("errors_are_below_their_bounds") {
        let pipeline = Pipeline::for_scene(&Scene::<Maths>::new(&device)).ptx(PTX).build().unwrap();
        let (launches, count, stride) = match device.kind() {
            BackendKind::Cpu => (1 << 10, 1 << 6, 65_537),
            _ => (1 << 20, 1 << 12, 1),
        };
        for (number, function) in (0..).zip(FUNCTIONS) {
            let worst = sweep(&device, &pipeline, number, launches, count, stride);
            let (x, unit) = (f32::from_bits(worst.at), if function.measure == Measure::Ulps { "ulp" } else { "" });
            let tried = if worst.tried == 0 { 1u64 << 32 } else { u64::from(worst.tried) };
            let correct = 100.0 * f64::from(worst.correct) / tried as f64;
            let error = if unit.is_empty() { format!("2^{:.2}", worst.error.log2()) } else { worst.error.to_string() };
            println!(
                "{:?} {:12} {:?} error {error} {unit} at {x:?} (bound {:e}); {correct:.3} % of {tried} correctly rounded",
                device.kind(),
                function.name,
                function.measure,
                function.bound
            );
            // The bounds are of the device's functions; a C library's may be off by more.
            let of_host = device.kind() == BackendKind::Cpu && function.measure == Measure::Ulps;
            if worst.error > if of_host { function.bound.max(2.5) } else { function.bound } {
                missed.push((device.kind(), function.name, worst));
            }
        }
    }
    assert!(missed.is_empty(), "{missed:#?}");
}
