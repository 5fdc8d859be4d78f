//! Triangle meshes from files: Wavefront OBJ, glTF and GLB.
//!
//! [`load`] merges everything a file draws into one [`Mesh`] that holds what the renderer relies on: every position is
//! finite, every index is in range, every normal has unit length. A file that cannot give that is refused with an
//! error that names the file and the place in it.

mod fit;
mod gltf;
mod obj;
mod polygon;
#[cfg(test)]
mod tests;

use std::fs;
use std::path::{Path, PathBuf};

pub use fit::fit_into;

/// Most triangles of one geometry acceleration structure (OptiX: 2^29 primitives).
const MAX_TRIANGLES: usize = 1 << 29;

/// A triangle mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertex positions, finite.
    pub positions: Vec<[f32; 3]>,
    /// Three vertices a triangle, counter-clockwise seen from outside; each less than `positions.len()`.
    pub indices: Vec<[u32; 3]>,
    /// One unit vector a vertex, where the file has a normal for all of them.
    pub normals: Option<Vec<[f32; 3]>>,
    /// What to call it: the file's name without its extension.
    pub name: String,
    /// What of the file is not in it, in words.
    pub left_out: Vec<String>,
}

/// Why a mesh could not be loaded. Displays as one line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// The file, or a buffer beside it, could not be read.
    #[error("{}: cannot be read: {why}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The operating system's reason.
        why: String,
    },
    /// The name ends in none of the known extensions.
    #[error("{}: a mesh file ends in .obj, .gltf or .glb", path.display())]
    Extension {
        /// The file.
        path: PathBuf,
    },
    /// The contents are not what the format demands.
    #[error("{}, {place}: {why}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Line, object or element.
        place: String,
        /// What is wrong there.
        why: String,
    },
    /// There is nothing to draw.
    #[error("{}: holds no triangles{}", path.display(), in_parentheses(left_out))]
    Empty {
        /// The file.
        path: PathBuf,
        /// What it holds that can't be drawn, in words.
        left_out: Vec<String>,
    },
}

fn in_parentheses(left_out: &[String]) -> String {
    if left_out.is_empty() { String::new() } else { format!(" ({})", left_out.join("; ")) }
}

/// A mesh file's format, by its extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    /// Wavefront OBJ.
    Obj,
    /// glTF 2.0, as JSON or binary.
    Gltf,
}

impl MeshFormat {
    /// The format that a file's name says it has, in either case.
    ///
    /// # Errors
    /// [`MeshError::Extension`] for any but `.obj`, `.gltf` and `.glb`.
    pub fn of(path: &Path) -> Result<Self, MeshError> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        match extension.as_str() {
            "obj" => Ok(Self::Obj),
            "gltf" | "glb" => Ok(Self::Gltf),
            _ => Err(MeshError::Extension { path: path.to_owned() }),
        }
    }
}

/// A fault in a file's contents: where, and what.
#[derive(Debug)]
struct Fault {
    place: String,
    why: String,
}

impl Fault {
    fn new(place: impl Into<String>, why: impl Into<String>) -> Self {
        Self { place: place.into(), why: why.into() }
    }
}

/// Loads a mesh file; all its objects become one mesh.
///
/// Polygons, also those that are not convex, are cut into triangles. Of glTF, the default scene is taken (the first where none
/// is marked), with its nodes' transforms; strips and fans become triangles. What is not a part of the shape, such as
/// materials, is not looked at; [`Mesh::left_out`] says which shapes are missing: lines, points, curves, morph targets.
///
/// # Errors
/// See [`MeshError`]. Never panics, whatever the bytes.
pub fn load(path: &Path) -> Result<Mesh, MeshError> {
    let format = MeshFormat::of(path)?;
    let bytes = read_file(path)?;
    let parsed = match format {
        MeshFormat::Obj => obj::parse(&bytes),
        MeshFormat::Gltf => gltf::parse(&bytes, path.parent().unwrap_or(Path::new(""))),
    };
    let mut mesh =
        parsed.map_err(|fault| MeshError::Malformed { path: path.to_owned(), place: fault.place, why: fault.why })?;
    if mesh.indices.is_empty() {
        return Err(MeshError::Empty { path: path.to_owned(), left_out: mesh.left_out });
    }
    normalize_normals(&mut mesh);
    mesh.name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    Ok(mesh)
}

/// Reads a whole regular file. Anything else (a directory, a pipe, a device) might never end.
fn read_file(path: &Path) -> Result<Vec<u8>, MeshError> {
    let fail = |why: String| MeshError::Read { path: path.to_owned(), why };
    let metadata = fs::metadata(path).map_err(|e| fail(e.to_string()))?;
    if !metadata.is_file() {
        return Err(fail("it is not a regular file".into()));
    }
    fs::read(path).map_err(|e| fail(e.to_string()))
}

/// Appends `part` to `mesh`, which keeps normals only while every part has them.
fn append(mesh: &mut Mesh, part: Mesh, place: &str) -> Result<(), Fault> {
    let first = mesh.positions.len();
    let triangles = mesh.indices.len() + part.indices.len();
    if triangles > MAX_TRIANGLES || first + part.positions.len() > u32::MAX as usize {
        return Err(Fault::new(place, format!("more than {MAX_TRIANGLES} triangles in all, OptiX's limit")));
    }
    mesh.normals = match (mesh.normals.take(), part.normals) {
        (None, normals) if first == 0 => normals,
        (Some(mut all), Some(more)) => {
            all.extend(more);
            Some(all)
        }
        _ => None,
    };
    // The check above keeps every sum within u32.
    mesh.indices.extend(part.indices.iter().map(|t| t.map(|i| i + first as u32)));
    mesh.positions.extend(part.positions);
    Ok(())
}

/// Gives every normal unit length. One that has no direction becomes that of a triangle at its vertex, or +z.
fn normalize_normals(mesh: &mut Mesh) {
    let Some(normals) = &mut mesh.normals else {
        return;
    };
    for normal in normals.iter_mut() {
        *normal = unit(normal.map(f64::from)).unwrap_or([0.0; 3]);
    }
    for triangle in &mesh.indices {
        for &i in triangle {
            if normals[i as usize] == [0.0; 3] {
                let [a, b, c] = triangle.map(|i| mesh.positions[i as usize].map(f64::from));
                normals[i as usize] = unit(cross(sub(b, a), sub(c, a))).unwrap_or([0.0, 0.0, 1.0]);
            }
        }
    }
    for normal in normals.iter_mut().filter(|n| **n == [0.0; 3]) {
        *normal = [0.0, 0.0, 1.0];
    }
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The unit vector along `v`; `None` where it has no finite direction. Scaling first keeps the squares in range.
fn unit(v: [f64; 3]) -> Option<[f32; 3]> {
    let largest = v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if !(largest > 0.0 && v.iter().all(|x| x.is_finite())) {
        return None;
    }
    let v = v.map(|x| x / largest);
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    Some(v.map(|x| (x / length) as f32))
}
