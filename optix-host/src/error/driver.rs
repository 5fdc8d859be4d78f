//! What can go wrong with the drivers of CUDA and OptiX.

use std::fmt;

/// An error of the OptiX backend: what was asked, what is wrong, what to do.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum DriverError {
    /// A driver library could not be loaded.
    #[error("{library} could not be loaded: {detail}\n  what to do: {remedy}")]
    LibraryNotFound {
        /// The file name that was searched for on the loader's default path.
        library: &'static str,
        /// The loader's own message.
        detail: String,
        /// What to do.
        remedy: &'static str,
    },

    /// The driver serves none of the ABI versions that this crate knows.
    #[error(
        "the driver serves none of the OptiX ABI versions {known:?} (its last answer: {code}), driver {driver}\n  \
         what to do: install NVIDIA driver {needed} or newer"
    )]
    UnsupportedDriver {
        /// The ABI versions asked for, newest first.
        known: Vec<i32>,
        /// The driver's last result code.
        code: i32,
        /// The display driver's version, or `unknown`.
        driver: String,
        /// The oldest driver branch that serves one of them.
        needed: u32,
    },

    /// There is no such GPU.
    #[error(
        "GPU {ordinal} was asked for, but CUDA sees {count}\n  what to do: check CUDA_VISIBLE_DEVICES and nvidia-smi"
    )]
    NoDevice {
        /// The GPU asked for, counted from 0.
        ordinal: usize,
        /// GPUs that CUDA sees.
        count: usize,
    },

    /// An OptiX call failed.
    #[error(transparent)]
    Optix(Box<OptixFailure>),

    /// A CUDA driver call failed.
    #[error(transparent)]
    Cuda(Box<CudaFailure>),

    /// An argument was refused before the driver saw it.
    #[error("{what}: {problem}\n  what to do: {remedy}")]
    Invalid {
        /// What was asked for.
        what: &'static str,
        /// What is wrong, with the values.
        problem: String,
        /// What to do.
        remedy: &'static str,
    },
}

/// As [`Display`](fmt::Display): what `main` prints of an error that it returns, and `unwrap` of one that it meets.
impl fmt::Debug for DriverError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl DriverError {
    pub(crate) fn invalid(what: &'static str, problem: impl Into<String>, remedy: &'static str) -> Self {
        Self::Invalid { what, problem: problem.into(), remedy }
    }

    /// The OptiX or CUDA result code, where a driver call failed.
    pub fn code(&self) -> Option<i32> {
        match self {
            Self::Optix(failure) => Some(failure.code),
            Self::Cuda(failure) => Some(failure.code),
            Self::UnsupportedDriver { code, .. } => Some(*code),
            _ => None,
        }
    }
}

/// A failed OptiX call.
#[derive(Debug)]
pub struct OptixFailure {
    /// The function of the API.
    pub call: &'static str,
    /// The result's name, as the driver gives it.
    pub name: String,
    /// The result's value.
    pub code: i32,
    /// The driver's sentence for it.
    pub text: String,
    /// The likely way out.
    pub remedy: &'static str,
    /// The compile log, where the call compiles.
    pub log: String,
    /// What the driver logged at level 2 (error) or 1 (fatal) since the error before.
    pub messages: Vec<LogMessage>,
}

impl std::error::Error for OptixFailure {}

impl fmt::Display for OptixFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} returned {} ({}): {}", self.call, self.name, self.code, self.text)?;
        write!(f, "\n  what to do: {}", self.remedy)?;
        if !self.log.is_empty() {
            write!(f, "\n  compile log:\n{}", self.log.trim_end())?;
        }
        for message in &self.messages {
            write!(f, "\n  driver log: {message}")?;
        }
        Ok(())
    }
}

/// A failed CUDA driver call.
#[derive(Debug)]
pub struct CudaFailure {
    /// The function of the API.
    pub call: &'static str,
    /// The result's name, as the driver gives it.
    pub name: String,
    /// The result's value.
    pub code: i32,
    /// The driver's sentence for it.
    pub text: String,
    /// The likely way out.
    pub remedy: &'static str,
    /// What OptiX logged at level 2 (error) or 1 (fatal) since the error before.
    pub messages: Vec<LogMessage>,
}

impl std::error::Error for CudaFailure {}

impl fmt::Display for CudaFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} returned {} ({}): {}", self.call, self.name, self.code, self.text)?;
        write!(f, "\n  what to do: {}", self.remedy)?;
        for message in &self.messages {
            write!(f, "\n  OptiX log: {message}")?;
        }
        Ok(())
    }
}

/// One message of the driver.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogMessage {
    /// 1 fatal, 2 error, 3 warning, 4 print.
    pub level: u32,
    /// A short category.
    pub tag: String,
    /// The text, without a trailing newline.
    pub text: String,
}

impl LogMessage {
    /// Whether this is a warning or worse.
    pub fn is_warning_or_worse(&self) -> bool {
        self.level <= 3
    }
}

impl fmt::Display for LogMessage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "level {} [{}] {}", self.level, self.tag, self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_says_call_code_remedy_log_and_messages() {
        let failure = OptixFailure {
            call: "optixModuleCreate",
            name: "OPTIX_ERROR_INVALID_INPUT".into(),
            code: 7200,
            text: "Invalid input".into(),
            remedy: "read the log",
            log: "COMPILE ERROR: line 3\n".into(),
            messages: vec![LogMessage { level: 2, tag: "COMPILER".into(), text: "bad".into() }],
        };
        let text = DriverError::Optix(Box::new(failure)).to_string();
        for part in ["optixModuleCreate", "7200", "what to do: read the log", "line 3", "[COMPILER] bad"] {
            assert!(text.contains(part), "{part} is missing in: {text}");
        }
    }
}
