//! Pictures in files: PNG for looking at, OpenEXR and PFM for measuring.
//!
//! A picture is written beside its target and then renamed, so that a target is either whole or untouched.

mod exr_file;
mod pfm;
mod png_file;
#[cfg(test)]
mod tests;

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

pub use png_file::{encode_rgb, tone_map};

/// Most pixels of a picture: OptiX launches have at most 2^30 threads.
pub const MAX_PIXELS: u64 = 1 << 30;

/// A picture of linear radiance.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Image {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue (linear, Rec. 709 primaries), row by row from the top; `width * height` of them.
    pub pixels: Vec<[f32; 3]>,
}

/// A picture file's format, by its extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageFormat {
    /// 8 bits a channel, sRGB, tone-mapped.
    Png,
    /// OpenEXR, 32-bit float, linear.
    Exr,
    /// Portable float map, 32-bit float, linear.
    Pfm,
}

/// Why a picture could not be read or written. Displays as one line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// The name ends in none of the known extensions.
    #[error("{}: {what} ends in {known}", path.display())]
    Extension {
        /// The file.
        path: PathBuf,
        /// What the file is for.
        what: &'static str,
        /// Extensions it can have.
        known: &'static str,
    },
    /// The operating system refused.
    #[error("{}: cannot be {verb}: {why}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What was tried: `read`, `written`.
        verb: &'static str,
        /// The reason.
        why: String,
    },
    /// The contents are not what the format demands.
    #[error("{}: {why}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where.
        why: String,
    },
    /// The picture has another size than is needed.
    #[error("{}: is {}x{}, {}x{} is needed", path.display(), got.0, got.1, want.0, want.1)]
    Size {
        /// The file.
        path: PathBuf,
        /// Its width and height.
        got: (u32, u32),
        /// Those that are needed.
        want: (u32, u32),
    },
}

impl ImageFormat {
    /// The format that a file's name says it shall have.
    ///
    /// # Errors
    /// [`ImageError::Extension`] for any but `.png`, `.exr` and `.pfm`, in either case.
    pub fn of(path: &Path) -> Result<Self, ImageError> {
        match lower_extension(path).as_str() {
            "png" => Ok(Self::Png),
            "exr" => Ok(Self::Exr),
            "pfm" => Ok(Self::Pfm),
            _ => Err(ImageError::Extension {
                path: path.to_owned(),
                what: "a picture",
                known: ".png (tone-mapped), .exr or .pfm (both linear)",
            }),
        }
    }
}

/// The extension in lower case, without its dot; empty where there is none.
pub fn lower_extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

impl Image {
    /// Writes the picture in the format of its extension. `exposure` is in stops and affects PNG only: radiance is
    /// multiplied by 2 to its power, then [tone-mapped](tone_map).
    ///
    /// # Errors
    /// [`ImageError::Extension`], [`ImageError::Io`], and [`ImageError::Malformed`] where `pixels` has another length than
    /// `width * height` or there are none. The target is then as it was.
    pub fn write(&self, path: &Path, exposure: f32) -> Result<(), ImageError> {
        let format = ImageFormat::of(path)?;
        let pixels = u64::from(self.width) * u64::from(self.height);
        if pixels == 0 || self.pixels.len() as u64 != pixels {
            let why = format!("{} pixels are no picture of {}x{}", self.pixels.len(), self.width, self.height);
            return Err(ImageError::Malformed { path: path.to_owned(), why });
        }
        write_beside(path, |to| match format {
            ImageFormat::Png => png_file::write(self, exposure, to),
            ImageFormat::Exr => exr_file::write(self, to),
            ImageFormat::Pfm => pfm::write(self, to),
        })
    }

    /// Reads a linear picture, `.pfm` or `.exr`, of any size.
    ///
    /// # Errors
    /// [`ImageError::Extension`], [`ImageError::Io`] and [`ImageError::Malformed`].
    pub fn read(path: &Path) -> Result<Self, ImageError> {
        read(path, None)
    }

    /// Reads a linear picture, `.pfm` or `.exr`, that must have a certain size, which is checked before it is decoded.
    ///
    /// # Errors
    /// [`ImageError::Extension`], [`ImageError::Io`], [`ImageError::Malformed`] and [`ImageError::Size`].
    pub fn read_sized(path: &Path, width: u32, height: u32) -> Result<Self, ImageError> {
        read(path, Some((width, height)))
    }
}

fn read(path: &Path, want: Option<(u32, u32)>) -> Result<Image, ImageError> {
    let what = "a linear picture";
    let extension = || ImageError::Extension { path: path.to_owned(), what, known: ".pfm or .exr" };
    let malformed = |why: String| ImageError::Malformed { path: path.to_owned(), why };
    let decode: Decoder = match ImageFormat::of(path) {
        Ok(ImageFormat::Pfm) => (pfm::size, pfm::read),
        Ok(ImageFormat::Exr) => (exr_file::size, exr_file::read),
        _ => return Err(extension()),
    };
    let fail = |why: String| ImageError::Io { path: path.to_owned(), verb: "read", why };
    if !fs::metadata(path).map_err(|e| fail(e.to_string()))?.is_file() {
        return Err(fail("it is not a regular file".into()));
    }
    let bytes = fs::read(path).map_err(|e| fail(e.to_string()))?;
    let got = (decode.0)(&bytes).map_err(malformed)?;
    if u64::from(got.0) * u64::from(got.1) > MAX_PIXELS {
        return Err(malformed(format!("{}x{} is more than 2^30 pixels", got.0, got.1)));
    }
    match want {
        Some(want) if want != got => Err(ImageError::Size { path: path.to_owned(), got, want }),
        _ => (decode.1)(&bytes).map_err(malformed),
    }
}

/// Reads the size, and reads the whole.
type Decoder = (fn(&[u8]) -> Result<(u32, u32), String>, fn(&[u8]) -> Result<Image, String>);

/// Finds out whether a file could be written here, without touching what is there. For the time before a long render.
///
/// # Errors
/// [`ImageError::Io`] with the reason: the folder is missing or closed, the target is a folder or read-only.
pub fn check_writable(path: &Path) -> Result<(), ImageError> {
    let fail = |why: String| ImageError::Io { path: path.to_owned(), verb: "written", why };
    match fs::metadata(path) {
        Ok(target) if target.is_dir() => return Err(fail("it is a folder".into())),
        Ok(target) if !target.is_file() => return Err(fail("it is not a regular file".into())),
        Ok(target) if target.permissions().readonly() => {
            return Err(fail("it is read-only".into()));
        }
        _ => {}
    }
    let folder = folder_of(path);
    match fs::metadata(&folder) {
        Ok(found) if found.is_dir() => {}
        Ok(_) => return Err(fail(format!("{} is not a folder", folder.display()))),
        Err(e) => return Err(fail(format!("the folder {}: {e}", folder.display()))),
    }
    let (beside, _) = create_beside(path).map_err(|e| fail(e.to_string()))?;
    fs::remove_file(beside).map_err(|e| fail(e.to_string()))
}

/// Writes a file through `fill`: to a new file beside it, which takes the target's place once all of it is written. On
/// an error the new file is removed and the target is as it was.
///
/// # Errors
/// [`ImageError::Io`] with the first error of `fill` or of the operating system.
pub fn write_beside(path: &Path, fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> Result<(), ImageError> {
    let fail = |e: io::Error| ImageError::Io { path: path.to_owned(), verb: "written", why: e.to_string() };
    // A link stays a link: what it points to is replaced.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let (beside, file) = create_beside(&target).map_err(fail)?;
    let mut writer = BufWriter::new(file);
    let written = fill(&mut writer).and_then(|()| writer.flush()).and_then(|()| {
        drop(writer);
        fs::rename(&beside, &target)
    });
    written.map_err(|e| {
        let _ = fs::remove_file(&beside);
        fail(e)
    })
}

fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder.to_owned(),
        _ => PathBuf::from("."),
    }
}

/// A new, hidden file in the target's folder.
fn create_beside(path: &Path) -> io::Result<(PathBuf, File)> {
    let name = path.file_name().ok_or_else(|| io::Error::other("it is not the name of a file"))?;
    for attempt in 0..100 {
        let mut hidden = std::ffi::OsString::from(".");
        hidden.push(name);
        hidden.push(format!(".{}-{attempt}.part", std::process::id()));
        let beside = folder_of(path).join(hidden);
        match OpenOptions::new().write(true).create_new(true).open(&beside) {
            Ok(file) => return Ok((beside, file)),
            Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {}
            Err(e) => return Err(e),
        }
    }
    Err(io::Error::other("100 unfinished files lie beside it"))
}
