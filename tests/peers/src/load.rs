//! A scene with its launch parameters, ready for a pipeline from any PTX that has its programs.

use glam::Vec4;
use optix_device_rs::params::LaunchParams;
use optix_device_rs::pipeline::Pipeline as PipelineType;
use optix_host::pipeline::Explanation;
use optix_host::{Buffer2d, Pipeline, Result, Scene};
use std::time::{Duration, Instant};

/// What is launched.
pub struct Load<P: PipelineType> {
    /// Its name, which is that of its peer in `cuda`.
    pub name: &'static str,
    /// The crate whose PTX has its programs.
    pub shaders: &'static str,
    pub(crate) scene: Scene<P>,
    pub(crate) frame: <P::Params as LaunchParams>::Host,
    pub(crate) film: Film,
}

/// The picture that a load makes.
pub(crate) enum Film {
    Grey(Buffer2d<f32>),
    Colour(Buffer2d<Vec4>),
}

impl<P: PipelineType> Load<P> {
    /// The pipeline from this PTX.
    pub fn pipeline(&self, ptx: &str) -> Result<Ready<'_, P>> {
        Ok(Ready { load: self, pipeline: Pipeline::for_scene(&self.scene).ptx(ptx).build()? })
    }

    fn size(&self) -> [u32; 2] {
        match &self.film {
            Film::Grey(film) => film.size(),
            Film::Colour(film) => film.size(),
        }
    }

    /// The picture of the last launch.
    pub fn picture(&self) -> Result<Vec<f32>> {
        Ok(match &self.film {
            Film::Grey(film) => film.read()?,
            Film::Colour(film) => film.read()?.iter().flat_map(|pixel| pixel.to_array()).collect(),
        })
    }
}

/// A pipeline for a load.
pub struct Ready<'l, P: PipelineType> {
    load: &'l Load<P>,
    pipeline: Pipeline<P>,
}

impl<P: PipelineType> Ready<'_, P> {
    /// Launches, and waits for the end.
    pub fn launch(&self) -> Result<Duration> {
        let [width, height] = self.load.size();
        let begin = Instant::now();
        self.pipeline.launch(&self.load.frame, [width, height, 1])?.wait()?;
        Ok(begin.elapsed())
    }

    /// Instructions of the programs, as OptiX's compiler counts them; none where it says nothing, as of a module from the
    /// driver's cache.
    pub fn instructions(&self) -> Option<u32> {
        let Explanation { device, .. } = self.pipeline.explain();
        let counts = device.iter().filter_map(|line| {
            let (what, count) = line.split_once(':')?.1.split_once(':')?;
            (what.trim() == "instruction(s)").then(|| count.trim().parse::<u32>().ok()).flatten()
        });
        Some(counts.sum()).filter(|&sum| sum > 0)
    }
}
