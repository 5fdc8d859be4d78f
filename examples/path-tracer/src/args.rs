//! The command line: what can be asked for, and what is refused before anything is rendered.

#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{CommandFactory, FromArgMatches, Parser, ValueEnum};

use crate::image_file::{Image, ImageError, ImageFormat, MAX_PIXELS, check_writable, lower_extension};
use crate::mesh::{MeshError, MeshFormat};

/// Renders a Cornell box by path tracing, with one shader crate that runs on the CPU and on OptiX.
///
/// Without options it renders the built-in scene: a diffuse mesh, a ball that is a custom primitive, an alpha-cut leaf
/// and an area light.
#[derive(Clone, Debug, PartialEq, Parser)]
#[command(name = "path-tracer", version, max_term_width = 100)]
pub struct Args {
    /// Where to render: on OptiX, on the embedded CPU executor, or on OptiX if the driver has it.
    #[arg(long, value_enum, default_value_t = DeviceChoice::Auto)]
    pub device: DeviceChoice,

    /// Mesh to stand in the box, scaled to fit: Wavefront .obj, .gltf or .glb.
    #[arg(long, value_name = "FILE")]
    pub mesh: Option<PathBuf>,

    /// Size of the picture in pixels; width times height is at most 2^30.
    #[arg(long, value_name = "WxH", default_value = "512x512")]
    pub size: Size,

    /// Samples per pixel. Four times as many halve the error.
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 64, value_parser = clap::value_parser!(u64).range(1..=1 << 32))]
    pub samples: u64,

    /// Most bounces of a path; 0 shows only what emits light.
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 8, value_parser = clap::value_parser!(u32).range(0..=1024))]
    pub bounces: u32,

    /// Seed of the random numbers. The same seed gives the same picture, for any number of threads.
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 0)]
    pub seed: u64,

    /// Picture to write: .png (8 bits, tone-mapped), .exr or .pfm (both linear radiance).
    #[arg(long, value_name = "FILE", default_value = "path-tracer.png")]
    pub out: PathBuf,

    /// Report of error against run time: .csv (a table) or .png (a plot). May be given more than once.
    #[arg(long, value_name = "FILE")]
    pub report: Vec<PathBuf>,

    /// Converged linear picture of the same scene and size, .pfm or .exr, to report true RMSE and bias against.
    /// Render it with another seed.
    #[arg(long, value_name = "FILE")]
    pub reference: Option<PathBuf>,

    /// Print what the pipeline left out for this scene, and why.
    #[arg(long)]
    pub explain: bool,

    /// Threads of the CPU executor; 0 takes one per core.
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=1024))]
    pub threads: u32,

    /// Trap what OptiX calls undefined: validation mode on OptiX, checked mode on the CPU. Slower.
    #[arg(long)]
    pub validate: bool,
}

/// Where to render.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DeviceChoice {
    /// OptiX if the NVIDIA driver has it, otherwise the CPU
    Auto,
    /// The embedded CPU executor
    Cpu,
    /// OptiX; an error where there is no driver
    Optix,
}

/// Size of a picture, at least 1x1 and at most [`MAX_PIXELS`] pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Size {
    /// Pixels.
    #[must_use]
    pub fn pixels(self) -> usize {
        self.width as usize * self.height as usize
    }
}

impl std::str::FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let whole = |digits: &str, what| match digits.parse::<u32>() {
            Ok(0) => Err(format!("the {what} is zero")),
            Ok(extent) => Ok(extent),
            Err(e) => Err(format!("the {what}: {e}")),
        };
        let (width, height) = text.split_once(['x', 'X']).ok_or("WIDTHxHEIGHT is needed, such as 640x480")?;
        let (width, height) = (whole(width, "width")?, whole(height, "height")?);
        if u64::from(width) * u64::from(height) > MAX_PIXELS {
            return Err(format!("more than {MAX_PIXELS} pixels (2^30), the limit of an OptiX launch"));
        }
        Ok(Self { width, height })
    }
}

/// What a report is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReportFormat {
    /// A table.
    Csv,
    /// A plot.
    Png,
}

/// What is needed to render, and was found to be in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Checked {
    /// Files and formats of `--report`.
    pub reports: Vec<(PathBuf, ReportFormat)>,
    /// The picture of `--reference`, of the size that is rendered.
    pub reference: Option<Image>,
}

/// Why a command line is refused. Displays as one line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ArgsError {
    /// `--out` cannot be written.
    #[error("--out {0}")]
    Out(ImageError),
    /// A `--report` cannot be written.
    #[error("--report {0}")]
    Report(ImageError),
    /// `--reference` cannot be read, or has another size.
    #[error("--reference {0}")]
    Reference(ImageError),
    /// `--mesh` is of no known format.
    #[error("--mesh {0}")]
    Mesh(MeshError),
    /// Two options name one file.
    #[error("{first} and {second} are the same file, {}", path.display())]
    SameFile {
        /// An option.
        first: &'static str,
        /// Another.
        second: &'static str,
        /// The file.
        path: PathBuf,
    },
    /// The picture does not fit in memory.
    #[error("--size {}x{} needs about {needed} MiB of memory, {free} MiB are free", size.width, size.height)]
    Memory {
        /// The picture's size.
        size: Size,
        /// MiB it takes.
        needed: u64,
        /// MiB there are.
        free: u64,
    },
}

/// Bytes a pixel on the host: two films of 16 in two buffers, moments of 56, the picture and an encoded copy.
const BYTES_PER_PIXEL: u64 = 160;

impl Args {
    /// Parses the process's command line.
    ///
    /// # Errors
    /// The code to leave with, after help or version (0), or after a message of one line on standard error (2).
    pub fn from_command_line() -> Result<Self, ExitCode> {
        Self::parse_words(std::env::args_os()).map_err(|refused| match refused {
            Refused::Shown(text) => {
                // A closed pipe is no reason to fail.
                let _ = text.print();
                ExitCode::SUCCESS
            }
            Refused::Wrong(line) => {
                eprintln!("{line}");
                ExitCode::from(2)
            }
        })
    }

    fn parse_words<T: Into<std::ffi::OsString> + Clone>(words: impl IntoIterator<Item = T>) -> Result<Self, Refused> {
        let parsed = Self::command().try_get_matches_from(words).and_then(|m| Self::from_arg_matches(&m));
        parsed.map_err(|e| match e.kind() {
            ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => Refused::Shown(e),
            _ => Refused::Wrong(one_line(&e.render().to_string())),
        })
    }

    /// Checks all that can be checked before rendering: formats, that the targets can be written, that the reference can be
    /// read and has the right size, that the picture fits in memory.
    ///
    /// # Errors
    /// See [`ArgsError`]. Nothing was written.
    pub fn check(&self) -> Result<Checked, ArgsError> {
        self.check_memory(free_memory())?;
        if let Some(mesh) = &self.mesh {
            MeshFormat::of(mesh).map_err(ArgsError::Mesh)?;
        }
        ImageFormat::of(&self.out).map_err(ArgsError::Out)?;
        check_writable(&self.out).map_err(ArgsError::Out)?;
        let mut reports = Vec::new();
        for path in &self.report {
            let format = report_format(path).map_err(ArgsError::Report)?;
            check_writable(path).map_err(ArgsError::Report)?;
            reports.push((path.clone(), format));
        }
        self.check_distinct()?;
        let Size { width, height } = self.size;
        let read = |path: &PathBuf| Image::read_sized(path, width, height).map_err(ArgsError::Reference);
        let reference = self.reference.as_ref().map(read).transpose()?;
        Ok(Checked { reports, reference })
    }

    fn check_memory(&self, free: Option<u64>) -> Result<(), ArgsError> {
        let needed = self.size.pixels() as u64 * BYTES_PER_PIXEL;
        match free {
            Some(free) if needed > free => {
                Err(ArgsError::Memory { size: self.size, needed: needed >> 20, free: free >> 20 })
            }
            _ => Ok(()),
        }
    }

    /// No file is written twice, or written over what is read.
    fn check_distinct(&self) -> Result<(), ArgsError> {
        let reports = self.report.iter().map(|p| ("--report", p));
        let inputs = [("--reference", &self.reference), ("--mesh", &self.mesh)];
        let inputs = inputs.into_iter().filter_map(|(name, path)| Some((name, path.as_ref()?)));
        let files: Vec<_> = [("--out", &self.out)].into_iter().chain(reports).chain(inputs).collect();
        for (i, &(second, path)) in files.iter().enumerate() {
            if let Some(&(first, _)) = files[..i].iter().find(|(_, other)| same_file(other, path)) {
                return Err(ArgsError::SameFile { first, second, path: path.clone() });
            }
        }
        Ok(())
    }
}

#[derive(Debug)]
enum Refused {
    /// Help or version, for standard output.
    Shown(clap::Error),
    /// One line, for standard error.
    Wrong(String),
}

/// clap's message without usage and advice, its paragraphs joined.
fn one_line(message: &str) -> String {
    let useful = message
        .lines()
        .map(str::trim)
        .filter(|l| !l.is_empty() && !l.starts_with("Usage:") && !l.starts_with("For more information"));
    let line = useful.collect::<Vec<_>>().join("; ");
    format!("{} (try --help)", line.replace(":; ", ": "))
}

fn report_format(path: &Path) -> Result<ReportFormat, ImageError> {
    match lower_extension(path).as_str() {
        "csv" => Ok(ReportFormat::Csv),
        "png" => Ok(ReportFormat::Png),
        _ => Err(ImageError::Extension {
            path: path.to_owned(),
            what: "a report",
            known: ".csv (a table) or .png (a plot)",
        }),
    }
}

/// Whether two names lead to one place; for files that are not there yet, by their folder.
fn same_file(a: &Path, b: &Path) -> bool {
    let resolved = |path: &Path| {
        path.canonicalize().ok().or_else(|| {
            let parent = path.parent().filter(|p| *p != Path::new("")).unwrap_or(Path::new("."));
            Some(parent.canonicalize().ok()?.join(path.file_name()?))
        })
    };
    a == b || resolved(a).zip(resolved(b)).is_some_and(|(a, b)| a == b)
}

/// Bytes of memory that can still be had, where the system tells (Linux: what is free or can be freed, and what the
/// control group leaves).
fn free_memory() -> Option<u64> {
    let read = |path: &str| std::fs::read_to_string(path).ok();
    let info = read("/proc/meminfo")?;
    let line = info.lines().find_map(|l| l.strip_prefix("MemAvailable:"))?;
    let available = line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? * 1024;
    let number = |path| read(path)?.trim().parse::<u64>().ok();
    let group = number("/sys/fs/cgroup/memory.max")
        .map(|most| most.saturating_sub(number("/sys/fs/cgroup/memory.current").unwrap_or(0)));
    Some(group.map_or(available, |left| left.min(available)))
}
