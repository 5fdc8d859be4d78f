//! Meshes for tests: generated ones, and real ones where they are there.

use glam::Vec3;
use path_tracer::mesh;
use std::path::PathBuf;

/// A mesh and its name.
pub struct Model {
    /// For messages.
    pub name: String,
    /// Positions.
    pub positions: Vec<Vec3>,
    /// Three per triangle.
    pub indices: Vec<[u32; 3]>,
}

/// A unit sphere of `2 * rings * segments` triangles or so, closed by shared vertices.
pub fn sphere(rings: u32, segments: u32) -> Model {
    let mut positions = vec![Vec3::Y];
    for ring in 1..rings {
        let (sin, cos) = (std::f32::consts::PI * ring as f32 / rings as f32).sin_cos();
        for segment in 0..segments {
            let (s, c) = (std::f32::consts::TAU * segment as f32 / segments as f32).sin_cos();
            positions.push(Vec3::new(sin * c, cos, sin * s));
        }
    }
    positions.push(Vec3::NEG_Y);
    let (top, bottom) = (0, positions.len() as u32 - 1);
    let vertex = |ring: u32, segment: u32| match ring {
        0 => top,
        r if r == rings => bottom,
        r => 1 + (r - 1) * segments + segment % segments,
    };
    let mut indices = Vec::new();
    for ring in 0..rings {
        for segment in 0..segments {
            let [a, b, c, d] = [
                vertex(ring, segment),
                vertex(ring, segment + 1),
                vertex(ring + 1, segment + 1),
                vertex(ring + 1, segment),
            ];
            indices.extend([[a, b, c], [a, c, d]].into_iter().filter(|[i, j, k]| i != j && j != k && k != i));
        }
    }
    Model { name: format!("sphere of {} triangles", indices.len()), positions, indices }
}

/// The meshes in `OPTIX_TEST_DATA`, or in `../shared/data` beside the repository; none where there are none.
pub fn real() -> Vec<Model> {
    let folder = std::env::var_os("OPTIX_TEST_DATA")
        .map_or_else(|| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data")), PathBuf::from);
    let Ok(files) = std::fs::read_dir(&folder) else {
        println!("no real meshes: {} is not there", folder.display());
        return Vec::new();
    };
    let mut paths: Vec<_> = files.flatten().map(|file| file.path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "obj"));
    paths.sort();
    let load = |path: &PathBuf| {
        let mesh = mesh::load(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        Model { name: mesh.name, positions: mesh.positions.iter().map(|&p| p.into()).collect(), indices: mesh.indices }
    };
    paths.iter().map(load).collect()
}

impl Model {
    /// Each position scaled, then moved, rounded to `f32`.
    pub fn placed(&self, scale: f64, by: [f64; 3]) -> Self {
        let place = |p: &Vec3| {
            let p = p.to_array();
            Vec3::from_array(core::array::from_fn(|k| (f64::from(p[k]) * scale + by[k]) as f32))
        };
        let positions = self.positions.iter().map(place).collect();
        Self {
            name: format!("{}, scaled by {scale:e}, moved by {by:?}", self.name),
            positions,
            indices: self.indices.clone(),
        }
    }

    /// Whether every edge has as many triangles on one side as on the other: no ray from inside can leave.
    pub fn is_closed(&self) -> bool {
        let mut sides = std::collections::HashMap::new();
        for [a, b, c] in &self.indices {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *sides.entry((from.min(to), from.max(to))).or_insert(0) += if from < to { 1 } else { -1 };
            }
        }
        sides.values().all(|&n| n == 0)
    }
}
