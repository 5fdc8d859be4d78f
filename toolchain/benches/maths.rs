//! Measures the error of the device's maths: at every `f32` for functions of one argument, at a billion pairs for those of two.
//!
//! `cargo bench -p optix-toolchain --bench maths [-- sinf powf ..]`, with all threads; some minutes a function.

#[allow(unused_imports, reason = "tests call single functions too")]
#[path = "../tests/common/libm.rs"]
mod libm;

use libm::{Errors, FUNCTIONS, FUNCTIONS_2};

/// Runs `part` for each thread, with its number and the number of threads.
fn in_parallel(part: impl Fn(u32, u32) -> Errors + Sync) -> Errors {
    let threads = std::thread::available_parallelism().map_or(1, |count| count.get() as u32);
    let part = &part;
    std::thread::scope(|scope| {
        let running: Vec<_> = (0..threads).map(|i| scope.spawn(move || part(i, threads))).collect();
        running.into_iter().filter_map(|thread| thread.join().ok()).fold(Errors::default(), Errors::merge)
    })
}

fn main() {
    let asked: Vec<String> = std::env::args().skip(1).filter(|arg| !arg.starts_with('-')).collect();
    let is_asked = |name: &str| asked.is_empty() || asked.iter().any(|asked| asked == name);
    let report = |name: &str, bound: f64, errors: Errors| {
        let share = 100.0 * errors.correct as f64 / errors.count as f64;
        println!(
            "{name:8} {:8.4} ulp (bound {bound}) at {:?}, {share:.3} % of {} correctly rounded",
            errors.ulps, errors.at, errors.count
        );
    };
    for function in FUNCTIONS.into_iter().filter(|function| is_asked(function.name)) {
        report(function.name, function.bound, in_parallel(|i, threads| function.errors(i, threads)));
    }
    for function in FUNCTIONS_2.into_iter().filter(|function| is_asked(function.name)) {
        let part = |i: u32, threads: u32| function.errors(u64::from(i) + 1, 1_000_000_000 / u64::from(threads));
        report(function.name, function.bound, in_parallel(part));
    }
}
