//! Meshes and rays of the bench.

use optix_host::cpu::traversal::RayQuery;
use optix_tests::meshes::Model;

pub struct Mesh {
    pub name: String,
    pub vertices: Vec<[f32; 3]>,
    pub indices: Vec<[u32; 3]>,
}

pub struct Rays {
    pub name: &'static str,
    pub rays: Vec<RayQuery>,
    /// Only whether something is hit matters.
    pub occlusion: bool,
}

/// A closed sphere with ripples, `2 * rings * segments` triangles or a little less.
pub fn bumpy_sphere(rings: u32, segments: u32) -> Mesh {
    let mut vertices = vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    for i in 1..rings {
        for j in 0..segments {
            let theta = f64::from(i) / f64::from(rings) * std::f64::consts::PI;
            let phi = f64::from(j) / f64::from(segments) * std::f64::consts::TAU;
            let r =
                1.0 + 0.15 * (9.0 * theta).sin() * (7.0 * phi).sin() + 0.03 * (31.0 * theta).cos() * (37.0 * phi).cos();
            let p = [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()];
            vertices.push(p.map(|x| (x * r) as f32));
        }
    }
    let at = |i: u32, j: u32| 2 + (i - 1) * segments + j % segments;
    let mut indices = Vec::new();
    for j in 0..segments {
        indices.push([0, at(1, j), at(1, j + 1)]);
        indices.push([1, at(rings - 1, j + 1), at(rings - 1, j)]);
        for i in 1..rings - 1 {
            indices.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            indices.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    Mesh { name: "rippled sphere".into(), vertices, indices }
}

impl From<Model> for Mesh {
    fn from(model: Model) -> Self {
        let vertices = model.positions.iter().map(|p| p.to_array()).collect();
        Self { name: model.name, vertices, indices: model.indices }
    }
}

/// A small generator (Steele, Lea and Flood, SplitMix64).
pub struct Random(pub u64);

impl Random {
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    fn sphere(&mut self) -> [f64; 3] {
        let (z, phi) = (2.0 * self.unit() - 1.0, std::f64::consts::TAU * self.unit());
        let r = (1.0 - z * z).sqrt();
        [r * phi.cos(), r * phi.sin(), z]
    }
}

type Cast<'c> = &'c dyn Fn(&RayQuery) -> Option<(f32, Option<[[f32; 3]; 3]>)>;

const SIDE: usize = 448;

pub fn ray_sets(mesh: &Mesh, cast: Cast<'_>) -> Vec<Rays> {
    let low: [f64; 3] = std::array::from_fn(|a| mesh.vertices.iter().map(|v| f64::from(v[a])).fold(f64::MAX, f64::min));
    let high: [f64; 3] =
        std::array::from_fn(|a| mesh.vertices.iter().map(|v| f64::from(v[a])).fold(f64::MIN, f64::max));
    let centre: [f64; 3] = std::array::from_fn(|a| 0.5 * (low[a] + high[a]));
    let size = (0..3).map(|a| high[a] - low[a]).fold(0.0, f64::max);
    let mut random = Random(1);

    // A pinhole in front of the mesh that it fills well.
    let eye = [centre[0] + 0.3 * size, centre[1] + 0.4 * size, centre[2] + 1.3 * size];
    let forward = normalise(sub(centre, eye));
    let right = normalise(cross(forward, [0.0, 1.0, 0.0]));
    let up = cross(right, forward);
    let primary: Vec<RayQuery> = (0..SIDE * SIDE)
        .map(|i| {
            let offset = |k: usize| (k as f64 + 0.5) / SIDE as f64 - 0.5;
            let (x, y) = (0.85 * offset(i % SIDE), -0.85 * offset(i / SIDE));
            let direction = std::array::from_fn(|a| (forward[a] + x * right[a] + y * up[a]) as f32);
            RayQuery::new(eye.map(|x| x as f32), direction)
        })
        .collect();

    let (mut ambient, mut diffuse) = (Vec::new(), Vec::new());
    for ray in &primary {
        let Some((t, Some(corners))) = cast(ray) else { continue };
        let [a, b, c] = corners.map(|v| v.map(f64::from));
        let mut normal = normalise(cross(sub(b, a), sub(c, a)));
        let direction = ray.direction.map(f64::from);
        if dot(normal, direction) > 0.0 {
            normal = normal.map(|x| -x);
        }
        let point: [f64; 3] =
            std::array::from_fn(|a| f64::from(ray.origin[a]) + f64::from(t) * direction[a] + 1e-4 * size * normal[a]);
        for bounce in [&mut ambient, &mut diffuse] {
            let s = random.sphere();
            let direction = normalise(std::array::from_fn(|a| normal[a] + 0.999 * s[a]));
            bounce.push(RayQuery::new(point.map(|x| x as f32), direction.map(|x| x as f32)));
        }
    }
    for ray in &mut ambient {
        ray.tmax = (0.3 * size) as f32;
    }

    let random: Vec<RayQuery> = (0..SIDE * SIDE)
        .map(|_| {
            let origin = std::array::from_fn(|a| (low[a] + random.unit() * (high[a] - low[a])) as f32);
            RayQuery::new(origin, random.sphere().map(|x| x as f32))
        })
        .collect();

    vec![
        Rays { name: "primary", rays: primary, occlusion: false },
        Rays { name: "ambient occlusion", rays: ambient, occlusion: true },
        Rays { name: "diffuse bounce", rays: diffuse, occlusion: false },
        Rays { name: "random closest", rays: random.clone(), occlusion: false },
        Rays { name: "random occlusion", rays: random, occlusion: true },
    ]
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

fn normalise(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    if length > 0.0 { a.map(|x| x / length) } else { [0.0, 0.0, 1.0] }
}
