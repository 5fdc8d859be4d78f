//! Coordinates up to the largest there is: planes without end, and what lies beside them.

use super::*;

/// Custom primitives that are their boxes.
struct Solid<'a>(&'a [Aabb]);

impl Programs for Solid<'_> {
    fn any_hit(&mut self, _: &Candidate<'_>) -> AnyHit {
        AnyHit::Accept
    }

    fn intersect(&mut self, context: &PrimitiveContext<'_>, reporter: &mut Reporter<'_, '_>) {
        let (Aabb { min, max }, ray) = (self.0[context.primitive_index as usize], context.object_ray);
        let (mut near, mut far) = (0.0f64, f64::INFINITY);
        for a in 0..3 {
            let at = |plane: f32| (f64::from(plane) - f64::from(ray.origin[a])) / f64::from(ray.direction[a]);
            let (x, y) = (at(min[a]), at(max[a]));
            (near, far) = (near.max(x.min(y)), far.min(x.max(y)));
        }
        if near <= far {
            reporter.report(self, near as f32, 0, &[]);
        }
    }
}

/// Small boxes around the origin, above `y = 0`.
fn small(random: &mut Random, count: usize) -> Vec<Aabb> {
    let small = (0..count).map(|_| {
        let at = [random.signed() * 8.0, random.unit() * 8.0, random.signed() * 8.0];
        Aabb::new(at.map(|x| x as f32), at.map(|x| (x + 0.5) as f32))
    });
    small.collect()
}

/// Four corners of a plane `y = -1` that reaches so far.
fn corners(far: f32) -> [[f32; 3]; 4] {
    [[-far, -1.0, -far], [far, -1.0, -far], [far, -1.0, far], [-far, -1.0, far]]
}

const PLANE: [[u32; 3]; 2] = [[0, 2, 1], [0, 3, 2]];

/// Sizes on both sides of where sums begin to overflow.
const SIZES: [f32; 9] = [1e3, 1e30, 4e37, 4.2e37, 4.3e37, 1e38, 2e38, 3.4e38, f32::MAX];

/// The structure itself, and under instances that move nothing, by a reflection, by scales and by a turn.
fn placed(accel: Accel) -> Vec<Accel> {
    let child = shared(accel);
    let under =
        |transform: [f32; 12]| Ias::new(vec![Instance { transform, ..Instance::new(child.clone()) }]).unwrap().into();
    let scale = |s: f32| [s, 0., 0., 0., 0., s, 0., 0., 0., 0., s, 0.];
    let mut all: Vec<Accel> =
        [scale(1.0), scale(0.5), scale(3.0), [-1., 0., 0., 0., 0., 1., 0., 0., 0., 0., -1., 0.]].map(under).into();
    // About the y axis, so that the plane stays one.
    all.push(under([0.6, 0., 0.8, 0.25, 0., 1., 0., 0.5, -0.8, 0., 0.6, 0.75]));
    let root = Instance::new(shared(Ias::new(vec![Instance::new(child)]).unwrap()));
    all.push(Ias::new(vec![root]).unwrap().into());
    all
}

fn rays(random: &mut Random, count: usize) -> Vec<RayQuery> {
    let rays = (0..count).map(|_| {
        let origin = [random.signed() * 20.0, random.unit() * 20.0, random.signed() * 20.0].map(|x| x as f32);
        RayQuery { tmax: f32::MAX, ..RayQuery::new(origin, random.sphere().map(|x| x as f32)) }
    });
    rays.collect()
}

/// The nearest hit with each instruction set, which agree: primitive and `t`.
fn nearest(accel: &Accel, ray: &RayQuery, mut programs: impl Programs) -> Option<(u32, f32)> {
    let portable = trace_portable(Some(accel), ray, &mut programs).map(|hit| (hit.primitive_index, hit.t));
    assert_eq!(trace(Some(accel), ray, &mut programs).map(|hit| (hit.primitive_index, hit.t)), portable);
    portable
}

/// Whatever reaches how far, rays meet the same neighbours as without it, and it where there are none.
#[test]
fn boxes_without_end() {
    let mut random = Random(1);
    for count in [1, 5, 60] {
        let boxes = small(&mut random, count);
        for ray in rays(&mut random, 40) {
            let of = |far: f32, which: usize| {
                let plane = Aabb::new([-far, -2.0, -far], [far, -1.0, far]);
                let all = [&boxes[..], &[plane]].concat();
                nearest(&placed(Gas::new(vec![custom(&all, OFF)]).unwrap().into())[which], &ray, Solid(&all))
            };
            for which in 0..6 {
                let expected = of(1e30, which);
                for far in SIZES.into_iter().skip(1) {
                    assert_eq!(of(far, which), expected, "{far:e}, {which}, {ray:?}");
                }
                let down = ray.direction[1] < -1e-3;
                assert!(!down || expected.is_some(), "{ray:?}");
            }
        }
    }
}

#[test]
fn triangles_without_end() {
    let mut random = Random(2);
    // With and without nodes.
    for count in [1, 40] {
        let near: Vec<[f32; 3]> = small(&mut random, count)
            .iter()
            .flat_map(|b| [b.min, [b.max[0], b.min[1], b.min[2]], [b.min[0], b.max[1], b.max[2]]])
            .collect();
        let mesh = |far: Option<f32>| {
            let mut inputs = vec![triangles(near.clone(), None, OFF)];
            inputs.extend(far.map(|far| {
                let plane = triangles(corners(far).to_vec(), Some(PLANE.to_vec()), OFF);
                plane.with_primitive_index_offset(1000).unwrap()
            }));
            placed(Gas::new(inputs).unwrap().into())
        };
        let alone = mesh(None);
        let planes = SIZES.map(|far| mesh(Some(far)));
        let (mut neighbours, mut ground) = (0, 0);
        for i in 0..300 {
            // Downwards most of all, and half of them at a triangle: elsewhere what a plane of this size loses to rounding is
            // more than its distance.
            let [x, _, z] = random.sphere().map(|x| x as f32);
            let origin = [x * 20.0, 20.0, z * 20.0];
            let target = match i % 2 {
                0 => near[random.below(near.len() / 3) * 3].map(|x| x + 0.1),
                _ => [origin[0] + x * 15.0, 0.0, origin[2] + z * 15.0],
            };
            let direction = core::array::from_fn(|a| target[a] - origin[a]);
            if direction[1].abs() <= direction[0].abs().max(direction[2].abs()) {
                continue;
            }
            let ray = RayQuery::new(origin, direction);
            for (size, with) in SIZES.iter().zip(&planes) {
                for (which, (with, alone)) in with.iter().zip(&alone).enumerate() {
                    let (hit, without) = (nearest(with, &ray, Opaque), nearest(alone, &ray, Opaque));
                    // In f64, where the ray meets the plane.
                    let height = [-1.0, -0.5, -3.0, -1.0, -0.5, -1.0][which];
                    let t = (height - f64::from(ray.origin[1])) / f64::from(ray.direction[1]);
                    let meets = t > 0.0 && t * 1.8 < f64::from(*size) && ray.direction[1] < -1e-2;
                    if without.is_some_and(|(_, near)| !meets || f64::from(near) < t * 0.999) {
                        assert_eq!(hit, without, "{size:e}, {which}, {ray:?}");
                        neighbours += 1;
                    } else if meets && without.is_none() {
                        let (primitive, _) = hit.unwrap_or_else(|| panic!("{size:e}, {which}, {ray:?} meets no plane"));
                        assert!(primitive >= 1000);
                        ground += 1;
                    }
                }
            }
        }
        assert!(neighbours > 200 && ground > 2000, "{neighbours}, {ground}");
    }
}

/// Rays that begin far away meet large things.
#[test]
fn origins_far_away() {
    for size in [4e37f32, 1e38, 2e38, f32::MAX] {
        for distance in [4e37f32, 1e38, 3e38, f32::MAX] {
            // Twice as large, an origin may be no number in object space.
            for (which, accel) in placed(mesh(&corners(size), &PLANE)).into_iter().enumerate().take(4) {
                if which == 1 && distance > f32::MAX / 2.0 {
                    continue;
                }
                let ray = RayQuery::new([0.25, distance, 0.5], [0.0, -1.0, 0.0]);
                let (_, t) = nearest(&accel, &ray, Opaque).unwrap_or_else(|| panic!("{size:e} from {distance:e}"));
                assert!((t / distance - 1.0).abs() < 1e-6, "{t:e} for {distance:e}");
            }
        }
    }
}

/// A ray that is none in one instance's space misses that instance, which is said, and meets its neighbours as without it.
#[test]
fn rays_that_are_none_in_an_instance() {
    #[derive(Default)]
    struct Told(Vec<(Vec<u32>, Ray)>);
    impl Programs for Told {
        fn any_hit(&mut self, _: &Candidate<'_>) -> AnyHit {
            AnyHit::Accept
        }
        fn intersect(&mut self, _: &PrimitiveContext<'_>, _: &mut Reporter<'_, '_>) {}
        fn no_ray(&mut self, path: &InstancePath<'_>, object_ray: &Ray) {
            self.0.push((path.indices().to_vec(), *object_ray));
        }
    }
    let floor = shared(mesh(&corners(1.0), &PLANE));
    let scaled = |s: f32, y: f32, child: &Arc<Accel>| Instance {
        transform: [s, 0., 0., 0., 0., s, 0., y, 0., 0., s, 0.],
        ..Instance::new(child.clone())
    };
    // Above the floor, a tiny one, or one that is tiny by two scales.
    let inner = shared(Ias::new(vec![scaled(1e-20, 0.0, &floor)]).unwrap());
    for (tiny, at) in [(scaled(3e-39, 1.0, &floor), vec![0]), (scaled(1e-20, 1.0, &inner), vec![0, 0])] {
        let ray = RayQuery::new([0.0, 3.0, 0.0], [0.0, -1.0, 0.0]);
        let neighbours = [scaled(1.0, 0.0, &floor), scaled(2.0, -1.0, &floor)];
        let without = Ias::new(neighbours.to_vec()).unwrap().into();
        let with = Ias::new([&[tiny][..], &neighbours].concat()).unwrap().into();
        let expected = nearest(&without, &ray, Opaque);
        assert_eq!(expected.map(|(_, t)| t), Some(4.0));
        assert_eq!(nearest(&with, &ray, Opaque), expected);
        let mut told = Told::default();
        trace(Some(&with), &ray, &mut told);
        let [(path, object_ray)] = &told.0[..] else { panic!("{:?}", told.0) };
        assert_eq!((path, object_ray.origin[1]), (&at, f32::INFINITY));
    }
}

#[test]
fn empty_boxes_stay_empty() {
    let boxes = [Aabb::new([1.0; 3], [-1.0; 3]), Aabb::new([f32::MAX; 3], [f32::MIN; 3])];
    let gas = Gas::new(vec![custom(&boxes, OFF)]);
    for accel in placed(gas.unwrap().into()) {
        let mut programs = Scripted::new(AnyHit::Accept);
        assert!(trace(Some(&accel), &down(), &mut programs).is_none());
        assert_eq!(programs.sites, 0);
    }
}
