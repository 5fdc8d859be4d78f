//! Renders a triangle to `{{name}}.png`: on the GPU through OptiX where there is one, otherwise on the CPU.

use {{ident}}_shaders::{FrameHost, Paint, Radiance, Renderer, Sky};
use optix_host::glam::{Affine3A, Vec3};
use optix_host::{Device, Pipeline, Scene, TriangleMesh};
use std::process::ExitCode;

fn main() -> ExitCode {
    match render() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn render() -> Result<(), Box<dyn std::error::Error>> {
    let device = Device::best()?;
    println!("device: {}", device.description());

    let mut scene = Scene::<Renderer>::new(&device);
    let (horizon, zenith) = (Vec3::new(0.9, 0.95, 1.0), Vec3::new(0.2, 0.4, 0.8));
    scene.miss::<Radiance>(Sky { horizon, zenith })?;
    let paint = scene.material(Paint { corners: [Vec3::X, Vec3::Y, Vec3::Z] })?;
    let triangle = [Vec3::new(-0.8, -0.6, 0.0), Vec3::new(0.8, -0.6, 0.0), Vec3::new(0.0, 0.8, 0.0)];
    let triangle = scene.geometry(TriangleMesh::new(&triangle))?;
    let gas = scene.gas([triangle.with(&paint)]).compact().build()?;
    let world = scene.ias([gas.at(Affine3A::IDENTITY)]).build()?.world()?;

    let pipeline = Pipeline::for_scene(&scene).ptx(optix_host::ptx!({{ident}}_shaders)).build()?;
    let [width, height] = [640, 480];
    let film = device.zeroed_2d([width, height])?;
    let frame = FrameHost { film: film.clone(), world, eye: Vec3::new(0.0, 0.0, 2.0) };
    pipeline.launch(&frame, [width, height, 1])?.wait()?;

    let srgb = |linear: f32| (linear.clamp(0.0, 1.0).powf(1.0 / 2.2) * 255.0 + 0.5) as u8;
    let bytes: Vec<u8> = film.read()?.iter().flat_map(|p| [srgb(p.x), srgb(p.y), srgb(p.z)]).collect();
    let mut png = png::Encoder::new(std::fs::File::create("{{name}}.png")?, width, height);
    png.set_color(png::ColorType::Rgb);
    png.write_header()?.write_image_data(&bytes)?;
    println!("wrote {{name}}.png");
    Ok(())
}
