//! Launch times of Rust device programs over those of the same programs in CUDA C++.
//!
//! `tests/peers/build.sh DIR` makes the PTX, then, where there is a GPU, `cargo bench -p optix-peers --bench launch -- DIR
//! [LOAD]`. Pipelines of two generators launch in turns; printed are the medians, the median and range of the pairs' ratio,
//! and how far the pictures are apart.

use glam::UVec2;
use optix_device_rs::pipeline::Pipeline;
use optix_host::Device;
use optix_peers::{Generator, Load, generators, loads};
use std::error::Error;
use std::path::PathBuf;

/// How often both pipelines are built: the same PTX runs at rates some percent apart from one build to the next, by where
/// its code and tables come to lie.
const BUILDS: usize = 12;
/// Paired launches with each build, after one that warms up.
const PAIRS: usize = 3;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1).filter(|a| !a.starts_with('-'));
    let Some(folder) = arguments.next().map(PathBuf::from) else {
        println!("launch: not run, name the folder that tests/peers/build.sh made");
        return Ok(());
    };
    let only = arguments.next();
    let device = match Device::optix() {
        Ok(device) => device,
        Err(why) => {
            println!("launch: not run on a GPU, {why}");
            return Ok(());
        }
    };
    println!("{}", device.description());
    let all = generators(&folder)?;
    let chosen = |name: &str| if only.as_deref().is_none_or(|only| only == name) { all.as_slice() } else { &[] };
    let size = UVec2::new(1920, 1080);
    compare(&loads::path_tracer(&device, size, 4)?, chosen("path_tracer"))?;
    compare(&loads::occlusion(&device, size, 64)?, chosen("occlusion"))?;
    compare(&loads::foliage(&device, size, 100)?, chosen("foliage"))?;
    compare(&loads::field(&device, 2 * size)?, chosen("field"))?;
    compare(&loads::wide(&device, size, 8)?, chosen("wide"))?;
    Ok(())
}

/// Each generator against nvcc with the same contraction; nvcc against itself says what a difference is worth.
fn compare<P: Pipeline>(load: &Load<P>, generators: &[Generator]) -> Result<(), Box<dyn Error>> {
    let named = |name: &str| generators.iter().find(|g| g.name == name);
    for generator in generators.iter().filter(|g| g.name != "nvcc-exact") {
        let peer = if generator.name.ends_with("-exact") { "nvcc-exact" } else { "nvcc" };
        let Some(peer) = named(peer) else { continue };
        let ours = generator.ptx::<P>(load.name, load.shaders)?;
        let theirs = peer.ptx::<P>(load.name, load.shaders)?;
        let (mut times, mut ratios, mut instructions) = (Vec::new(), Vec::new(), [None; 2]);
        let mut pictures = [Vec::new(), Vec::new()];
        for build in 0..BUILDS {
            // Either one is built first, and launched first, as often.
            let swap = build % 2 == 1;
            let [first, second] = if swap { [&theirs, &ours] } else { [&ours, &theirs] };
            let both = [load.pipeline(first)?, load.pipeline(second)?];
            let [mine, other] = if swap { [&both[1], &both[0]] } else { [&both[0], &both[1]] };
            instructions = [mine.instructions().or(instructions[0]), other.instructions().or(instructions[1])];
            for (pipeline, picture) in [mine, other].into_iter().zip(&mut pictures) {
                pipeline.launch()?;
                *picture = load.picture()?;
            }
            for pair in 0..PAIRS {
                let (a, b) = if (build / 2 + pair) % 2 == 0 {
                    let a = mine.launch()?;
                    (a, other.launch()?)
                } else {
                    let b = other.launch()?;
                    (mine.launch()?, b)
                };
                times.push((a.as_secs_f64() * 1e3, b.as_secs_f64() * 1e3));
                ratios.push(a.as_secs_f64() / b.as_secs_f64());
            }
        }
        println!(
            "{:12} {:14} {:8.3} ms, {} {:8.3} ms: {:.4} [{:.4}, {:.4}]; {}; {} of OptiX's instructions, {}",
            load.name,
            generator.name,
            median(times.iter().map(|t| t.0)),
            peer.name,
            median(times.iter().map(|t| t.1)),
            median(ratios.iter().copied()),
            ratios.iter().copied().fold(f64::INFINITY, f64::min),
            ratios.iter().copied().fold(0.0, f64::max),
            Difference::of(&pictures[0], &pictures[1]),
            known(instructions[0]),
            known(instructions[1]),
        );
    }
    Ok(())
}

fn known(count: Option<u32>) -> String {
    count.map_or("an unknown number".to_owned(), |count| count.to_string())
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    0.5 * (values[(values.len() - 1) / 2] + values[values.len() / 2])
}

/// How far two pictures are apart.
struct Difference {
    values: usize,
    differ: usize,
    /// Of those that differ: half and 99 of 100 are within so many ulp.
    ulps: [u32; 2],
    means: [f64; 2],
}

impl Difference {
    fn of(a: &[f32], b: &[f32]) -> Self {
        let mut ulps: Vec<u32> = a.iter().zip(b).map(|(a, b)| ordered(*a).abs_diff(ordered(*b))).collect();
        ulps.retain(|&ulps| ulps != 0);
        ulps.sort_unstable();
        let at = |share: f64| ulps.get((ulps.len() as f64 * share) as usize).copied().unwrap_or(0);
        let mean = |v: &[f32]| v.iter().map(|&x| f64::from(x)).sum::<f64>() / v.len() as f64;
        Self { values: a.len(), differ: ulps.len(), ulps: [at(0.5), at(0.99)], means: [mean(a), mean(b)] }
    }
}

/// A number that counts up by one from each float to the next.
fn ordered(x: f32) -> i32 {
    let bits = x.to_bits() as i32;
    if bits < 0 { i32::MIN - bits } else { bits }
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.differ == 0 {
            return write!(f, "the same picture, mean {}", self.means[0]);
        }
        let [half, most] = self.ulps;
        write!(
            f,
            "{} of {} values differ, half of them by at most {half} ulp, 99 % by {most}; means differ by {:.1e} of {:.4}",
            self.differ,
            self.values,
            self.means[0] - self.means[1],
            self.means[1]
        )
    }
}
