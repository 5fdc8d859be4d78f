//! The error of the device's maths on a GPU: at every `f32` for functions of one argument, at 2^32 pairs for those of two;
//! what each code generator makes, beside libdevice and, where nvcc was there when this was compiled, CUDA C++.
//!
//! The figures are those of docs/maths.md. `cargo test -p optix-toolchain --test maths` tries the same functions on the CPU.

use std::sync::Arc;

use cudarc::driver::{
    CudaContext, CudaFunction, CudaModule, CudaSlice, CudaStream, DriverError, LaunchConfig, PushKernelArg,
};
use cudarc::nvrtc::Ptx;
use maths_kernels::table::{Bound, Function, TABLE};
use maths_kernels::{Measure, Worst};
use optix_tests::devices;

/// What makes kernels, and its PTX; empty where it was not there when the tests were compiled.
const GENERATORS: [(&str, &str); 3] = [
    ("rustc", include_str!(concat!(env!("OUT_DIR"), "/maths.rustc.ptx"))),
    ("libNVVM", include_str!(concat!(env!("OUT_DIR"), "/maths.nvvm.ptx"))),
    ("nvcc", include_str!(concat!(env!("OUT_DIR"), "/maths.nvcc.ptx"))),
];

/// Arguments at a time.
const CHUNK: u32 = 1 << 26;
/// Threads of a launch, each of which takes many arguments.
const GRID: LaunchConfig = LaunchConfig { grid_dim: (1 << 9, 1, 1), block_dim: (1 << 8, 1, 1), shared_mem_bytes: 0 };

/// A kernel's values, and an error that is stated for them.
struct Question {
    /// `sin precise libdevice libNVVM`.
    name: String,
    /// The number in [`GENERATORS`].
    generator: usize,
    kernel: String,
    bound: Bound,
}

/// What there is to ask of a function, kernel after kernel.
fn questions(function: &Function) -> Vec<Question> {
    let mut questions = Vec::new();
    let mut ask = |what: &str, generator: usize, prefix: &str, bounds: &[Bound]| {
        let (maker, ptx) = GENERATORS[generator];
        let kernel = format!("{prefix}_{}", function.name);
        if ptx.is_empty() || bounds.is_empty() {
            return;
        }
        assert!(ptx.contains(&format!(".entry {kernel}(")), "{maker} made no {kernel}");
        let name = format!("{} {what} {maker}", function.name);
        questions.extend(bounds.iter().map(|&bound| Question {
            name: name.clone(),
            generator,
            kernel: kernel.clone(),
            bound,
        }));
    };
    for generator in [0, 1] {
        ask("precise", generator, "ours", function.precise);
        ask("fast", generator, "fast", function.fast);
    }
    ask("precise libdevice", 1, "libdevice", function.cuda);
    ask("precise CUDA", 2, "cuda", function.cuda);
    ask("fast CUDA", 2, "cuda_fast", function.cuda_fast);
    questions
}

/// What was found at all arguments: more of them than a thread's [`Worst`] counts.
#[derive(Default)]
struct Found {
    worst: Worst,
    correct: u64,
    tried: u64,
}

impl Found {
    fn by_threads(threads: Vec<[u32; 5]>) -> Self {
        threads.into_iter().fold(Self::default(), |mut found, [error, x, y, correct, tried]| {
            let error = f32::from_bits(error);
            if error > found.worst.error {
                found.worst = Worst { error, at: [x, y], correct, tried };
            }
            found.correct += u64::from(correct);
            found.tried += u64::from(tried);
            found
        })
    }

    /// Prints it, and gives whether it is within the bound.
    fn report(&self, function: &Function, question: &Question) -> bool {
        let (bound, error) = (question.bound, f64::from(self.worst.error));
        let [x, y] = self.worst.at;
        let at = match function.pairs {
            false => format!("{x:#010x} = {:?}", f32::from_bits(x)),
            true => format!("({x:#010x}, {y:#010x}) = {:?}", [x, y].map(f32::from_bits)),
        };
        let (max, limit) = match bound.measure {
            Measure::Ulps => (format!("{error:.4} ulp"), format!("{:.2}", bound.limit)),
            measure => (format!("2^{:.2} {measure:?}", error.log2()).to_lowercase(), format!("2^{:.2}", bound.limit)),
        };
        let range =
            if bound.high < f32::INFINITY { format!(" from {} to {}", bound.low, bound.high) } else { String::new() };
        let share = 100.0 * self.correct as f64 / self.tried as f64;
        let missed = if error > bound.error() { ", MISSED" } else { "" };
        println!(
            "maths: {}{range} max {max} at {at}; correctly rounded {share:.3} % of {}; bound {limit}{missed}",
            question.name, self.tried
        );
        missed.is_empty()
    }
}

struct Gpu {
    stream: Arc<CudaStream>,
    /// None where there is no PTX.
    modules: Vec<Option<Arc<CudaModule>>>,
    arguments: CudaSlice<[f32; 2]>,
    values: CudaSlice<f32>,
    exact: CudaSlice<f64>,
}

impl Gpu {
    fn new() -> Result<Self, DriverError> {
        let context = CudaContext::new(0)?;
        let stream = context.default_stream();
        let load = |(_, ptx): (&str, &str)| {
            if ptx.is_empty() { Ok(None) } else { context.load_module(Ptx::from_src(ptx)).map(Some) }
        };
        Ok(Self {
            modules: GENERATORS.into_iter().map(load).collect::<Result<_, _>>()?,
            arguments: stream.alloc_zeros(CHUNK as usize)?,
            values: stream.alloc_zeros(CHUNK as usize)?,
            exact: stream.alloc_zeros(CHUNK as usize)?,
            stream,
        })
    }

    fn kernel(&self, generator: usize, name: &str) -> Result<CudaFunction, DriverError> {
        self.modules[generator].as_ref().expect("only what there is PTX of is asked for").load_function(name)
    }

    /// Checks some exact values of a chunk by the host's, which are off by an ulp of `f64` or, near zeros, a thousand.
    /// Says which is not one.
    fn wrong_exact(&self, function: &Function, chunk: usize) -> Result<Option<String>, DriverError> {
        // Elsewhere in each chunk.
        let at = chunk * 1_048_573;
        let some = at..at + 1024;
        let arguments = self.stream.clone_dtoh(&self.arguments.slice(some.clone()))?;
        for ([x, y], exact) in arguments.into_iter().zip(self.stream.clone_dtoh(&self.exact.slice(some))?) {
            let host = (function.host)(x.into(), y.into());
            let is_close = (exact - host).abs() <= 2f64.powi(-40) * host.abs().max(f64::MIN_POSITIVE);
            let is_same = exact == host || exact.is_nan() && host.is_nan() || is_close;
            if !is_same {
                return Ok(Some(format!("exact {}({x:?}, {y:?}) is {exact:e}, the host's {host:e}", function.name)));
            }
        }
        Ok(None)
    }

    /// Answers to questions on a function, or which of its exact values is wrong.
    fn answers(
        &mut self,
        function: &Function,
        questions: &[Question],
    ) -> Result<Result<Vec<Found>, String>, DriverError> {
        let (fill, compare) = (self.kernel(0, "arguments")?, self.kernel(0, "compare")?);
        let exact = self.kernel(0, &format!("exact_{}", function.name))?;
        let kernels: Vec<_> =
            questions.iter().map(|q| self.kernel(q.generator, &q.kernel)).collect::<Result<_, _>>()?;
        // A `Worst` for each thread and question.
        let threads = (GRID.grid_dim.0 * GRID.block_dim.0) as usize;
        let mut worst = Vec::new();
        for _ in questions {
            worst.push(self.stream.alloc_zeros::<[u32; 5]>(threads)?);
        }
        for first in (0..1u64 << 32).step_by(CHUNK as usize) {
            let pairs = u32::from(function.pairs);
            // SAFETY: these are the kernels' parameters, and every buffer has as many elements as they are told.
            unsafe {
                let mut launch = self.stream.launch_builder(&fill);
                launch.arg(&mut self.arguments).arg(&CHUNK).arg(&first).arg(&pairs).launch(GRID)?;
                let mut launch = self.stream.launch_builder(&exact);
                launch.arg(&self.arguments).arg(&mut self.exact).arg(&CHUNK).launch(GRID)?;
            }
            if let Some(wrong) = self.wrong_exact(function, (first / u64::from(CHUNK)) as usize)? {
                return Ok(Err(wrong));
            }
            for (i, (question, worst)) in questions.iter().zip(&mut worst).enumerate() {
                let Bound { measure, low, high, .. } = question.bound;
                // SAFETY: as above; a `Worst` is as many words, and zeros are one.
                unsafe {
                    if i == 0 || questions[i - 1].name != question.name {
                        let mut launch = self.stream.launch_builder(&kernels[i]);
                        launch.arg(&self.arguments).arg(&mut self.values).arg(&CHUNK).launch(GRID)?;
                    }
                    let mut launch = self.stream.launch_builder(&compare);
                    launch.arg(&self.arguments).arg(&self.values).arg(&self.exact).arg(&CHUNK);
                    launch.arg(&(measure as u32)).arg(&low).arg(&high).arg(worst).launch(GRID)?;
                }
            }
        }
        let found = worst.iter().map(|worst| Ok(Found::by_threads(self.stream.clone_dtoh(worst)?)));
        found.collect::<Result<_, _>>().map(Ok)
    }
}

#[test]
fn errors_are_below_their_bounds() {
    let test = "errors_are_below_their_bounds";
    let asked: Vec<_> = TABLE.iter().map(|function| (function, questions(function))).collect();
    for (maker, ptx) in GENERATORS {
        if ptx.is_empty() {
            println!("{test}: {maker} not run, it was not there when this was compiled");
        }
    }
    // The first one's PTX has what is exact.
    if GENERATORS[0].1.is_empty() || !devices::cuda(test) {
        return;
    }
    let mut gpu = Gpu::new().unwrap();
    let mut missed = Vec::new();
    for (function, questions) in asked {
        let answers = gpu.answers(function, &questions).unwrap().unwrap_or_else(|wrong| {
            println!("maths: {wrong}");
            missed.push(wrong);
            Vec::new()
        });
        for (found, question) in answers.iter().zip(questions) {
            if !found.report(function, &question) {
                missed.push(question.name);
            }
        }
    }
    assert!(missed.is_empty(), "{missed:#?}");
}

/// The text of a kernel.
fn body<'a>(ptx: &'a str, kernel: &str) -> &'a str {
    let (_, rest) = ptx.split_once(&format!(".entry {kernel}(")).unwrap_or_else(|| panic!("there is no {kernel}"));
    rest.split_once("\n}").expect("it ends").0
}

/// Kernels of glam's functions and of `f32`'s methods, with their square roots and their divisions or reciprocals.
const LIBRARY: [(&str, usize, usize); 19] = [
    ("glam_length", 1, 0),
    ("glam_distance", 1, 0),
    ("glam_normalize", 1, 1),
    ("glam_normalize_or_zero", 1, 1),
    ("glam_quat_normalize", 1, 1),
    ("glam_quat_rotate", 0, 0),
    ("glam_quat_from_axis_angle", 0, 0),
    ("glam_quat_slerp", 2, 1),
    ("glam_from_angle", 0, 0),
    ("glam_angle_between", 2, 1),
    ("glam_refract", 1, 0),
    ("glam_mat4_inverse", 0, 1),
    ("glam_powf", 0, 4),
    ("glam_floor", 0, 0),
    ("method_sqrt", 1, 0),
    ("method_floor", 0, 0),
    ("method_mul_add", 0, 0),
    ("method_sin", 0, 0),
    ("method_sin_cos", 0, 0),
];

#[test]
fn libraries_are_made_of_instructions() {
    for (maker, ptx) in GENERATORS.into_iter().take(2).filter(|(_, ptx)| !ptx.is_empty()) {
        for (kernel, roots, divisions) in LIBRARY {
            let body = body(ptx, kernel);
            let count = |operation: &str| body.matches(operation).count();
            // Our square root is made of this.
            assert_eq!(count("rsqrt.approx.ftz.f32"), roots, "{maker}: square roots of {kernel}");
            assert_eq!(count("sqrt.rn.f32"), 0, "{maker}: square roots of {kernel} that are not ours");
            assert_eq!(count("rcp.rn.f32") + count("div.rn.f32"), divisions, "{maker}: divisions of {kernel}");
            assert!(!body.contains(".f64") && !body.contains(".local"), "{maker}: {kernel} is of f32, in registers");
            // Angles beyond 65,536 are reduced out of line.
            let mut called = body.split("call.uni").skip(1).map(|call| call.split(';').next().unwrap_or_default());
            assert!(called.all(|call| call.contains("reduce_large")), "{maker}: {kernel} calls nothing else");
        }
        for (kernel, instruction) in [
            ("glam_floor", "cvt.rmi"),
            ("method_floor", "cvt.rmi"),
            ("method_mul_add", "fma.rn.f32"),
            ("method_sin", "fma.rn.f32"),
        ] {
            assert!(body(ptx, kernel).contains(instruction), "{maker}: {kernel} has {instruction}");
        }
    }
}
