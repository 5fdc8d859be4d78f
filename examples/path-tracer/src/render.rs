//! Rendering in passes, with the statistics that the report needs.

use crate::scene::Cornell;
use glam::Vec4;
use optix_host::pipeline::Explanation;
use optix_host::report::Moments;
use optix_host::{Buffer2d, Device, Pipeline, Result};
use path_tracer_shaders::{Frame, FrameHost, PathTracer};

/// The most samples of a pass: small enough that the sums of a pass are good to a few ulp in `f32`.
pub const LARGEST_PASS: u32 = 64;

/// The PTX of the shaders; empty where no device compiler was found when this was built.
pub const PTX: &str = optix_host::ptx!(path_tracer_shaders);

/// A picture being rendered.
pub struct Render {
    pipeline: Pipeline<PathTracer>,
    frame: FrameHost,
    sum: Buffer2d<Vec4>,
    squares: Buffer2d<Vec4>,
    moments: Moments,
    samples: u64,
    rays: u64,
}

/// How to render.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Width and height.
    pub size: [u32; 2],
    /// How many times a path may bounce.
    pub bounces: u32,
    /// Chooses the random sequences.
    pub seed: u64,
}

impl Render {
    /// Makes ready to render a scene.
    pub fn new(device: &Device, cornell: &Cornell, settings: Settings) -> Result<Self> {
        let pipeline =
            Pipeline::for_scene(&cornell.scene).ptx(PTX).bind(Frame::MAX_BOUNCES, settings.bounces).build()?;
        let (sum, squares) = (device.zeroed_2d(settings.size)?, device.zeroed_2d(settings.size)?);
        let frame = FrameHost {
            sum: sum.clone(),
            squares: squares.clone(),
            world: cornell.world.clone(),
            camera: cornell.camera,
            light: cornell.light,
            first_sample: 0,
            samples: 0,
            seed: settings.seed,
            max_bounces: settings.bounces,
        };
        let pixels = settings.size[0] as usize * settings.size[1] as usize;
        Ok(Self { pipeline, frame, sum, squares, moments: Moments::new(pixels), samples: 0, rays: 0 })
    }

    /// Adds `samples` samples to every pixel.
    pub fn pass(&mut self, samples: u32) -> Result<()> {
        self.frame.first_sample = self.samples as u32;
        self.frame.samples = samples;
        let [width, height] = self.sum.size();
        self.pipeline.launch(&self.frame, [width, height, 1])?.wait()?;
        let (sum, squares) = (self.sum.read()?, self.squares.read()?);
        self.rays += sum.iter().map(|pixel| pixel.w as u64).sum::<u64>();
        self.samples += u64::from(samples);
        // The films have the size that the moments were made for.
        if let Err(error) = self.moments.add_pass(samples, &sum, &squares) {
            unreachable!("{error}");
        }
        Ok(())
    }

    /// What is known of the picture.
    pub fn moments(&self) -> &Moments {
        &self.moments
    }

    /// Samples a pixel so far.
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// Rays traced so far, of all kinds.
    pub fn rays(&self) -> u64 {
        self.rays
    }

    /// What the pipeline was specialised to.
    pub fn explain(&self) -> Explanation {
        self.pipeline.explain()
    }
}
