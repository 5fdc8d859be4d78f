//! Installs libNVVM and ptxas from NVIDIA's Python wheels, for `cargo optix setup --nvvm`.

use std::process::Command;

use optix_toolchain::nvvm;

use super::libraries::Driver;
use super::{Failure, setup};

/// The version of CUDA whose wheels are installed if there is no driver. It is the oldest with a wheel that has only
/// libNVVM.
const WITHOUT_DRIVER: (i32, i32) = (13, 0);

/// Installs them into a folder of the toolkit; the user's Python installation stays as it is.
pub(super) fn install() -> Result<(), Failure> {
    let cuda = Driver::query().map_or(WITHOUT_DRIVER, |driver| driver.cuda);
    let cache =
        optix_toolchain::cache().ok_or_else(|| Failure("no HOME, so no cache folder; set XDG_CACHE_HOME".into()))?;
    let folder = cache.join(format!("nvidia-nvvm-{}.{}", cuda.0, cuda.1));
    let packages = packages(cuda).ok_or_else(|| {
        Failure(format!("the driver here is for CUDA {}.{}; libNVVM's wheels begin with 12.0", cuda.0, cuda.1))
    })?;
    let mut pip = Command::new("python3");
    pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps", "--upgrade", "--target"]);
    setup::show(pip.arg(&folder).args(&packages)).map_err(|reason| {
        Failure(format!(
            "{reason}; it takes python3 with pip (`apt-get install python3-pip`) and a way to pypi.org. By hand: install a CUDA \
             toolkit (https://developer.nvidia.com/cuda-downloads), or name its libnvvm.so by OPTIX_NVVM"
        ))
    })?;
    let library = nvvm::choose().map_err(|reason| Failure(format!("no libNVVM can be used: {reason}")))?;
    say!("libNVVM: {}", library.path.display());
    Ok(())
}

/// The newest packages that a driver for this version of CUDA accepts.
fn packages((major, minor): (i32, i32)) -> Option<Vec<String>> {
    let below = format!("<{major}.{}", minor + 1);
    match major {
        ..12 => None,
        // Older versions have both in one package.
        12 => Some(vec![format!("nvidia-cuda-nvcc-cu12{below}")]),
        _ => Some(["nvidia-nvvm", "nvidia-cuda-nvcc"].map(|name| format!("{name}{below}")).to_vec()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packages_are_no_newer_than_the_driver() {
        assert_eq!(packages((13, 0)), Some(vec!["nvidia-nvvm<13.1".into(), "nvidia-cuda-nvcc<13.1".into()]));
        assert_eq!(packages((12, 8)), Some(vec!["nvidia-cuda-nvcc-cu12<12.9".into()]));
        assert_eq!(packages((11, 8)), None);
    }
}
