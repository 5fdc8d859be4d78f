//! Placing a mesh in a box.

use super::Mesh;

/// Moves and scales a mesh uniformly so that it is centred at `center` and as large as fits in a box of extents `size`
/// (positive) about it. Returns the factor.
///
/// The arithmetic is in `f64`, where neither the extents of any `f32` mesh nor the factor can overflow: meshes of 1e30
/// or 1e-30 units fit as well as others, and no position becomes infinite or leaves the box. A mesh with no extent
/// is only moved. Normals keep, as the scale is uniform.
pub fn fit_into(mesh: &mut Mesh, center: [f32; 3], size: [f32; 3]) -> f64 {
    place(mesh, center, size, None)
}

/// As [`fit_into`], but the mesh stands on the box's floor, its side of the lowest y.
pub fn fit_onto(mesh: &mut Mesh, center: [f32; 3], size: [f32; 3]) -> f64 {
    place(mesh, center, size, Some(1))
}

fn place(mesh: &mut Mesh, center: [f32; 3], size: [f32; 3], floor_axis: Option<usize>) -> f64 {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for position in &mesh.positions {
        for axis in 0..3 {
            low[axis] = low[axis].min(f64::from(position[axis]));
            high[axis] = high[axis].max(f64::from(position[axis]));
        }
    }
    let scale = (0..3)
        .filter(|&axis| high[axis] > low[axis])
        .map(|axis| f64::from(size[axis]) / (high[axis] - low[axis]))
        .fold(f64::INFINITY, f64::min);
    let scale = if scale.is_finite() { scale } else { 1.0 };
    for position in &mut mesh.positions {
        for axis in 0..3 {
            let half = f64::from(size[axis]) / 2.0;
            let (from, to) = if floor_axis == Some(axis) {
                (low[axis], f64::from(center[axis]) - half)
            } else {
                ((low[axis] + high[axis]) / 2.0, f64::from(center[axis]))
            };
            let moved = (f64::from(position[axis]) - from) * scale + to;
            let (floor, ceiling) = (center[axis] - half as f32, center[axis] + half as f32);
            position[axis] = (moved as f32).max(floor).min(ceiling);
        }
    }
    scale
}
