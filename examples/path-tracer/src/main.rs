//! Renders a mesh in a box, on OptiX or on the CPU. `path-tracer --help` tells more.

use optix_host::report::{ErrorCurve, Reference, pass_sizes};
use optix_host::{Device, OptixOptions};
use path_tracer::args::{Args, DeviceChoice, ReportFormat};
use path_tracer::image_file::{Image, write_beside};
use path_tracer::progress::{Progress, Summary};
use path_tracer::render::{LARGEST_PASS, Render, Settings};
use path_tracer::scene::{Cornell, MESH_PLACE};
use path_tracer::{knot, mesh, plot};
use std::error::Error;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

fn main() -> ExitCode {
    let args = match Args::from_command_line() {
        Ok(args) => args,
        Err(code) => return code,
    };
    match run(&args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {}", one_line(&*error));
            ExitCode::FAILURE
        }
    }
}

/// The error and its causes in a line.
fn one_line(error: &dyn Error) -> String {
    error.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}

fn run(args: &Args) -> Result<(), Box<dyn Error>> {
    let checked = args.check()?;
    let mut mesh = match &args.mesh {
        Some(path) => mesh::load(path)?,
        None => knot::torus_knot(512, 48),
    };
    for what in &mesh.left_out {
        eprintln!("note: {}: {what}", args.mesh.as_deref().unwrap_or(Path::new("")).display());
    }
    let (centre, size) = MESH_PLACE;
    mesh::fit_into(&mut mesh, centre, size);

    if args.threads > 0 {
        rayon::ThreadPoolBuilder::new().num_threads(args.threads as usize).build_global()?;
    }
    let optix = OptixOptions { validation: args.validate };
    let cpu = || if args.validate { Device::cpu_checked() } else { Device::cpu() };
    let device = match args.device {
        DeviceChoice::Auto if !args.validate => Device::best()?,
        DeviceChoice::Auto => Device::optix_with(&optix).or_else(|_| cpu())?,
        DeviceChoice::Cpu => cpu()?,
        DeviceChoice::Optix => Device::optix_with(&optix)?,
    };
    println!("device: {}", device.description());

    let (width, height) = (args.size.width, args.size.height);
    let cornell = Cornell::new(&device, &mesh, width as f32 / height as f32)?;
    let settings = Settings { size: [width, height], bounces: args.bounces, seed: args.seed };
    let mut render = Render::new(&device, &cornell, settings)?;
    if args.explain {
        print!("{}", render.explain());
    }

    let reference = checked.reference.as_ref().map(|image| Reference { pixels: &image.pixels, rmse: None });
    let mut curve = ErrorCurve::new();
    let mut progress = Progress::new(args.samples);
    let begin = Instant::now();
    for samples in pass_sizes(args.samples, LARGEST_PASS) {
        render.pass(samples)?;
        let done = render.samples();
        let mut relative = None;
        if ErrorCurve::is_due(done, args.samples) {
            let seconds = begin.elapsed().as_secs_f64();
            relative = curve.record(done, seconds, render.rays(), render.moments(), reference.as_ref())?.relative_error;
        }
        progress.update(done, render.rays(), relative);
    }
    let seconds = begin.elapsed().as_secs_f64();
    progress.finish();

    let image = Image { width, height, pixels: render.moments().mean_image() };
    image.write(&args.out, 0.0)?;
    let title = format!("{width}x{height}, {}", device.name());
    for (path, format) in &checked.reports {
        match format {
            ReportFormat::Csv => write_beside(path, |file| curve.write_csv(file))?,
            ReportFormat::Png => plot::write_plot(&curve, &title, path)?,
        }
    }
    let summary = Summary {
        device: device.name().into(),
        size: (width, height),
        seconds,
        samples: render.samples(),
        rays: render.rays(),
        relative_error: render.moments().estimate().relative,
        rejected_samples: render.moments().rejected().samples,
    };
    for message in device.take_messages() {
        eprintln!("driver: {message}");
    }
    println!("{summary}");
    println!("wrote {}", args.out.display());
    Ok(())
}
