//! Launches of pipelines.

use crate::backend::Running;
use crate::error::LaunchError;
use crate::limits::launch_size;
use crate::{Error, Pipeline, Result};
use optix_device_rs::data::DeviceData;
use optix_device_rs::host::{HostData, KeepAlive, Kept};
use optix_device_rs::params::LaunchParams;
use optix_device_rs::pipeline::{HasRayGen, Pipeline as PipelineType};

impl<P: PipelineType> Pipeline<P> {
    /// Launches the first ray-generation program over `dimensions` (width, height, depth; at most 2^30 in all).
    ///
    /// The call returns while the launch runs. What the launch writes can be read after it, because a device does its
    /// work in order, and what it uses is kept alive.
    pub fn launch(&self, params: &<P::Params as LaunchParams>::Host, dimensions: [u32; 3]) -> Result<Launch> {
        self.begin(0, params, dimensions)
    }

    /// Launches ray-generation program `Prog`; see [`Pipeline::launch`].
    pub fn launch_program<Prog>(
        &self,
        params: &<P::Params as LaunchParams>::Host,
        dimensions: [u32; 3],
    ) -> Result<Launch>
    where
        P: HasRayGen<Prog>,
    {
        self.begin(<P as HasRayGen<Prog>>::INDEX as usize, params, dimensions)
    }

    fn begin(&self, raygen: usize, params: &<P::Params as LaunchParams>::Host, dimensions: [u32; 3]) -> Result<Launch> {
        let error = |error| Error::Launch { pipeline: self.plan.description.name, error };
        if launch_size(dimensions).is_none() {
            return Err(error(match dimensions.contains(&0) {
                true => LaunchError::Empty { dimensions },
                false => LaunchError::TooLarge { dimensions },
            }));
        }
        // SAFETY: the launch that is given the views keeps the owners.
        let mut keep = unsafe { KeepAlive::new() };
        let device_params = params.lower(&mut keep);
        if let Some(kept) = keep.foreign(self.device.backend.id()) {
            return Err(error(LaunchError::OfAnotherDevice { holds: kept.kind() }));
        }
        let checked = keep.kept().iter().try_for_each(|kept| self.check(kept));
        checked.map_err(|reference| error(LaunchError::Parameters(reference)))?;
        let mut bytes = vec![0; size_of::<P::Params>()];
        device_params.write_to(&mut bytes);
        for bound in &self.plan.bound {
            bound.check(&bytes).map_err(error)?;
        }
        let running = self.linked.launch(raygen, &bytes, keep.kept(), dimensions)?;
        let mut kept = keep.into_kept();
        kept.extend(self.records.iter().cloned());
        Ok(Launch { running, done: false, _keep: kept })
    }
}

/// A launch under way; it keeps alive what it uses. Dropping it waits for its end.
#[must_use = "a launch that is dropped is waited for, and its errors are lost"]
pub struct Launch {
    running: Box<dyn Running>,
    done: bool,
    _keep: Vec<Kept>,
}

impl Launch {
    /// Waits until the launch is done, and says what went wrong in it.
    pub fn wait(mut self) -> Result<()> {
        self.done = true;
        self.running.wait()
    }
}

impl Drop for Launch {
    fn drop(&mut self) {
        if !self.done {
            // Here an error has nobody to go to. `wait` returns it.
            let _ = self.running.wait();
        }
    }
}
