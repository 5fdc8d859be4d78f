//! Chooses a libNVVM whose PTX the driver on this machine accepts.

use std::ffi::c_int;
use std::fmt;
use std::path::{Path, PathBuf};

use super::{Failure, Library, find};

const CUDA: &str = if cfg!(windows) { "nvcuda.dll" } else { "libcuda.so.1" };

/// A version of PTX, as in `.version 9.0`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct PtxVersion {
    /// 9
    pub major: u32,
    /// 0
    pub minor: u32,
}

impl PtxVersion {
    /// Reads `9.0`.
    pub fn parse(text: &str) -> Option<Self> {
        let (major, minor) = text.trim().split_once('.')?;
        Some(Self { major: major.parse().ok()?, minor: minor.parse().ok()? })
    }

    /// The newest version that a driver for this version of CUDA accepts.
    pub fn of_cuda(major: u32, minor: u32) -> Self {
        // CUDA 12.6 kept the PTX version of 12.5, so later releases of CUDA 12 are one behind. Otherwise each release
        // of CUDA has a new version.
        let of = |major, minor| Self { major, minor };
        match (major, minor) {
            (12, 6) => of(8, 5),
            (12, 7..) => of(8, minor - 1),
            (12, _) => of(8, minor),
            (11, _) => of(7, minor),
            (13.., _) => of(major - 4, minor),
            (_, _) => of(6, 5),
        }
    }

    /// The newest version that the driver on this machine accepts. `None` if there is no driver.
    pub fn of_driver() -> Option<Self> {
        type GetVersion = unsafe extern "system" fn(*mut c_int) -> c_int;
        // SAFETY: this is NVIDIA's driver, whose initialisers have no precondition.
        let library = unsafe { libloading::Library::new(CUDA) }.ok()?;
        let mut version = 0;
        // SAFETY: this is the function's type in every version of CUDA, and the pointer is to a live integer.
        let result = unsafe { library.get::<GetVersion>("cuDriverGetVersion").ok()?(&mut version) };
        let version = u32::try_from(version).ok().filter(|version| result == 0 && *version != 0)?;
        Some(Self::of_cuda(version / 1000, version % 1000 / 10))
    }
}

impl fmt::Display for PtxVersion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.major, self.minor)
    }
}

/// The libNVVM to use: the newest whose PTX the driver accepts; if there is no driver, the one with the oldest PTX,
/// which most drivers accept. It looks in the same places as [`libraries`](crate::libraries).
pub fn choose(cache: Option<&Path>) -> Result<Library, NoLibrary> {
    let driver = PtxVersion::of_driver();
    let mut rejected = Vec::new();
    let mut best: Option<(PtxVersion, Library)> = None;
    for path in find::libraries(cache) {
        let loaded = Library::open(&path).and_then(|library| Ok((library.ptx_version()?, library)));
        let (version, library) = match loaded {
            Ok(loaded) => loaded,
            Err(failure) => {
                rejected.push(Rejected { path, why: Why::Failed(failure) });
                continue;
            }
        };
        if let Some(driver) = driver
            && version > driver
        {
            rejected.push(Rejected { path, why: Why::TooNew { writes: version, driver } });
            continue;
        }
        let is_better = |best: PtxVersion| if driver.is_some() { version > best } else { version < best };
        if best.as_ref().is_none_or(|(best, _)| is_better(*best)) {
            best = Some((version, library));
        }
    }
    best.map(|(_, library)| library).ok_or(NoLibrary { rejected })
}

/// There is no libNVVM that can be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoLibrary {
    /// Those that are there, and why they can't be used.
    pub rejected: Vec<Rejected>,
}

/// A libNVVM that can't be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rejected {
    /// The library.
    pub path: PathBuf,
    /// Why not.
    pub why: Why,
}

/// Why a libNVVM can't be used.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Why {
    /// It can't be loaded, or does not tell its version.
    Failed(Failure),
    /// The driver does not accept the PTX that it writes.
    TooNew {
        /// The version that it writes.
        writes: PtxVersion,
        /// The newest version that the driver accepts.
        driver: PtxVersion,
    },
}

impl fmt::Display for NoLibrary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.rejected.is_empty() {
            return f.write_str("none found");
        }
        for (i, Rejected { path, why }) in self.rejected.iter().enumerate() {
            write!(f, "{}{}", if i == 0 { "" } else { "; " }, path.display())?;
            match why {
                Why::Failed(failure) => write!(f, ": {failure}")?,
                Why::TooNew { writes, driver } => {
                    write!(f, " writes PTX {writes}, and the driver takes up to {driver}")?;
                }
            }
        }
        Ok(())
    }
}

impl std::error::Error for NoLibrary {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cuda_says_which_ptx() {
        // From the table of releases in the PTX ISA manual.
        let table = [((11, 8), "7.8"), ((12, 0), "8.0"), ((12, 4), "8.4"), ((12, 5), "8.5"), ((12, 6), "8.5")];
        let newer = [((12, 8), "8.7"), ((12, 9), "8.8"), ((13, 0), "9.0")];
        for ((major, minor), ptx) in table.into_iter().chain(newer) {
            assert_eq!(PtxVersion::of_cuda(major, minor).to_string(), ptx, "CUDA {major}.{minor}");
        }
        assert!(PtxVersion::parse("9.10") > PtxVersion::parse("9.9"));
    }
}
