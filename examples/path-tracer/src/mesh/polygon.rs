//! Polygons to triangles.

use earcut::Earcut;
use earcut::utils3d::project3d_to_2d;

use super::{cross, sub};

/// Most corners of one polygon.
pub(super) const MAX_CORNERS: usize = 1 << 20;

/// Cuts polygons; keeps its memory from one to the next.
pub(super) struct Cutter {
    ears: Earcut<f64>,
    flat: Vec<[f64; 2]>,
}

/// The triangles of a polygon, by its corners' places.
pub(super) struct Cut {
    /// In the polygon's own direction.
    pub triangles: Vec<[u32; 3]>,
    /// Whether they cover the polygon. One whose sides cross has no inside that all programs agree on.
    pub covers: bool,
}

impl Cutter {
    pub fn new() -> Self {
        Self { ears: Earcut::new(), flat: Vec::new() }
    }

    /// The triangles of a polygon of at most [`MAX_CORNERS`] finite corners, which need not lie in one plane.
    ///
    /// The fan from the first corner where that is right, as it is for every convex polygon.
    pub fn cut(&mut self, corners: &[[f32; 3]]) -> Cut {
        let count = corners.len() as u32;
        let fan: Vec<[u32; 3]> = (2..count).map(|i| [0, i - 1, i]).collect();
        // Of a size for which squares neither overflow nor vanish.
        let origin = corners.first().map_or([0.0; 3], |first| first.map(f64::from));
        let mut moved: Vec<[f64; 3]> = corners.iter().map(|corner| sub(corner.map(f64::from), origin)).collect();
        let largest = moved.iter().flatten().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        if count <= 3 || largest == 0.0 {
            return Cut { triangles: fan, covers: true };
        }
        moved.iter_mut().flatten().for_each(|x| *x /= largest);
        // Corners on a line have no area to cut, and no side to be seen from.
        if !project3d_to_2d(&moved, moved.len(), &mut self.flat) {
            return Cut { triangles: fan, covers: true };
        }
        let whole: f64 = fan.iter().map(|triangle| self.area(triangle)).sum();
        if fan.iter().all(|triangle| self.area(triangle) >= -1e-12 * whole) && self.turns_once() {
            return Cut { triangles: fan, covers: true };
        }
        let mut corners: Vec<u32> = Vec::new();
        self.ears.earcut(self.flat.iter().copied(), &[], &mut corners);
        let (triangles, _) = corners.as_chunks::<3>();
        let turned = triangles.iter().map(|&[a, b, c]| if self.area(&[a, b, c]) < 0.0 { [a, c, b] } else { [a, b, c] });
        let triangles: Vec<[u32; 3]> = turned.collect();
        let covered: f64 = triangles.iter().map(|triangle| self.area(triangle)).sum();
        Cut { covers: (covered - whole).abs() <= 1e-6 * whole, triangles }
    }

    /// Twice the area of a triangle in the plane, negative where it turns the other way.
    fn area(&self, triangle: &[u32; 3]) -> f64 {
        let [a, b, c] = triangle.map(|i| {
            let [x, y] = self.flat[i as usize];
            [x, y, 0.0]
        });
        cross(sub(b, a), sub(c, a))[2]
    }

    /// Whether its corners go round the first one less than once: the fan's triangles don't overlap then.
    fn turns_once(&self) -> bool {
        let Some((first, others)) = self.flat.split_first() else { return true };
        let direction = |[x, y]: [f64; 2]| (y - first[1]).atan2(x - first[0]);
        let angles: Vec<f64> = others.iter().filter(|other| *other != first).map(|other| direction(*other)).collect();
        let turn = |pair: &[f64]| (pair[1] - pair[0]).rem_euclid(std::f64::consts::TAU);
        // A step back by rounding is no turn.
        let turns = angles.windows(2).map(turn).map(|turn| if turn > std::f64::consts::PI + 1e-9 { 0.0 } else { turn });
        turns.sum::<f64>() < std::f64::consts::TAU - 1e-9
    }
}
