//! Directions on the faces of a cube.

use optix_device_rs::texture::{Level, Lookup};

/// A lookup by direction as one on the face that it meets: coordinates on that, its number as the layer (+x, -x, +y, -y, +z, -z),
/// and the level. Where it meets an edge the face is that of z, or else of y (measured on a GPU).
pub fn on_face(lookup: &Lookup) -> ([f64; 3], u32, Level) {
    let [x, y, z] = lookup.coordinates.map(f64::from);
    let (axis, face) = if z.abs() >= x.abs() && z.abs() >= y.abs() {
        (z, 4)
    } else if y.abs() >= x.abs() {
        (y, 2)
    } else {
        (x, 0)
    };
    let face = face + u32::from(axis < 0.0);
    // Across the face, down it, and towards it.
    let turned = |[x, y, z]: [f64; 3]| match face {
        0 => [-z, -y, x],
        1 => [z, -y, -x],
        2 => [x, z, y],
        3 => [x, -z, -y],
        4 => [x, -y, z],
        _ => [-x, -y, -z],
    };
    let [s, t, m] = turned([x, y, z]);
    // No direction at all is the middle of a face.
    let on = |s: f64| if m > 0.0 { (s / m + 1.0) / 2.0 } else { 0.5 };
    let level = match lookup.level {
        Level::Lod(lod) => Level::Lod(lod),
        // By the quotient rule.
        Level::Gradient(steps) => Level::Gradient(steps.map(|step| {
            let [ds, dt, dm] = turned(step.map(f64::from));
            let change = |s: f64, ds: f64| if m > 0.0 { ((ds * m - s * dm) / (2.0 * m * m)) as f32 } else { 0.0 };
            [change(s, ds), change(t, dt), 0.0]
        })),
    };
    ([on(s), on(t), 0.0], face, level)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_axis_is_the_middle_of_its_face() {
        for axis in 0..3 {
            for (sign, length) in [(1.0, 1e-30), (-1.0, 1e30)] {
                let mut coordinates = [0.0; 3];
                coordinates[axis] = sign * length;
                let (on, face, _) = on_face(&Lookup { coordinates, layer: 0, level: Level::Lod(0.0) });
                assert_eq!(face, 2 * axis as u32 + u32::from(sign < 0.0));
                assert_eq!(on, [0.5, 0.5, 0.0]);
            }
        }
    }
}
