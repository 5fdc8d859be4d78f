//! The built-in mesh: a tube along a torus knot.

use crate::mesh::Mesh;
use std::f32::consts::TAU;

/// A closed tube along the (2, 3) torus knot, with `along` times `around` vertices and twice as many triangles.
///
/// Vertices are shared, so the mesh is watertight; normals are the tube's own.
pub fn torus_knot(along: u32, around: u32) -> Mesh {
    let centre = |t: f32| {
        let r = 2.0 + (3.0 * t).cos();
        [r * (2.0 * t).cos(), r * (2.0 * t).sin(), (3.0 * t).sin()]
    };
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    for i in 0..along {
        let t = i as f32 / along as f32 * TAU;
        let c = centre(t);
        let tangent = sub(centre(t + 1e-3), centre(t - 1e-3));
        // A frame from the radius of the torus: it never turns parallel to the knot, so the tube does not twist.
        let radial = [(2.0 * t).cos(), (2.0 * t).sin(), 0.0];
        let side = unit(cross(tangent, radial));
        let up = unit(cross(side, tangent));
        for j in 0..around {
            let angle = j as f32 / around as f32 * TAU;
            let normal: [f32; 3] = core::array::from_fn(|k| side[k] * angle.cos() + up[k] * angle.sin());
            positions.push(core::array::from_fn(|k| c[k] + 0.42 * normal[k]));
            normals.push(normal);
        }
    }
    let vertex = |i: u32, j: u32| (i % along) * around + j % around;
    let mut indices = Vec::new();
    for i in 0..along {
        for j in 0..around {
            let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
            indices.extend([[a, b, c], [a, c, d]]);
        }
    }
    Mesh { positions, indices, normals: Some(normals), name: "torus knot".into(), ..Mesh::default() }
}

fn sub(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    core::array::from_fn(|k| a[k] - b[k])
}

fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(v: [f32; 3]) -> [f32; 3] {
    let length = v.iter().map(|x| x * x).sum::<f32>().sqrt();
    v.map(|x| x / length)
}
