//! Placing a mesh in a box.

use super::Mesh;

/// Moves and scales a mesh uniformly so that it is as large as fits in a box of extents `size` (positive) about `center`,
/// stands on the box's floor (its lowest y), and is centred in x and z. Returns the factor.
///
/// The arithmetic is in `f64`, where neither the extents of any `f32` mesh nor the factor can overflow: meshes of 1e30
/// or 1e-30 units fit as well as others, and no position becomes infinite or leaves the box. A mesh with no extent
/// is only moved. Normals keep, as the scale is uniform.
pub fn fit_into(mesh: &mut Mesh, center: [f32; 3], size: [f32; 3]) -> f64 {
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
    let floor: [f64; 3] = std::array::from_fn(|a| f64::from(center[a]) - f64::from(size[a]) / 2.0);
    let ceiling: [f64; 3] = std::array::from_fn(|a| f64::from(center[a]) + f64::from(size[a]) / 2.0);
    // What goes where: the lowest y to the floor, the middle of x and z to the middle.
    let from = [(low[0] + high[0]) / 2.0, low[1], (low[2] + high[2]) / 2.0];
    let to = [f64::from(center[0]), floor[1], f64::from(center[2])];
    for position in &mut mesh.positions {
        for axis in 0..3 {
            let moved = (f64::from(position[axis]) - from[axis]) * scale + to[axis];
            position[axis] = moved.max(floor[axis]).min(ceiling[axis]) as f32;
        }
    }
    scale
}
