//! Instances over several levels, SBT indices, what a hit tells.

use super::*;

fn moved(x: f32, y: f32, z: f32) -> [f32; 12] {
    [1., 0., 0., x, 0., 1., 0., y, 0., 0., 1., z]
}

/// Triangles of several records in a row of places `x = 0, 2, 4 ..`.
fn row(records: &[usize], stride: u32) -> Gas {
    let mut x = 0.0;
    let inputs = records
        .iter()
        .enumerate()
        .map(|(i, &count)| {
            let vertices = (0..count)
                .flat_map(|_| {
                    let left = x;
                    x += 2.0;
                    [[left, 0., 0.], [left + 1., 0., 0.], [left, 1., 0.]]
                })
                .collect();
            let records = match count {
                1 => Records::one(OFF),
                _ => Records::indexed(vec![OFF; count], (0..count as u32).collect()),
            };
            let input = BuildInput::new(TriangleArray::new(vertices, None).unwrap(), records).unwrap();
            input.with_primitive_index_offset(stride * i as u32).unwrap()
        })
        .collect::<Vec<_>>();
    Gas::new(inputs).unwrap()
}

fn at(x: f32) -> RayQuery {
    RayQuery::new([x + 0.25, 0.25, 10.0], [0.0, 0.0, -1.0])
}

#[test]
fn gas_indices_follow_build_input_order() {
    // Guide 7.3.2: 4, 1 and 2 records give [0, 3], 4 and [5, 6].
    let accel = Accel::from(row(&[4, 1, 2], 100));
    for place in 0..7 {
        let hit = trace(Some(&accel), &at(2.0 * place as f32), &mut Opaque).unwrap();
        assert_eq!((hit.sbt_gas_index, hit.sbt_index), (place, place));
        let local = [0, 1, 2, 3, 100, 200, 201][place as usize];
        assert_eq!(hit.primitive_index, local);
        assert_eq!(hit.triangle_vertices().unwrap()[0], [2.0 * place as f32, 0., 0.]);
    }
    let Accel::Gas(gas) = &accel else { unreachable!() };
    assert_eq!((gas.primitive_count(), gas.record_count()), (7, 7));
    assert!(gas.triangle_vertices(7, 0).is_none() && gas.triangle_vertices(0, 4).is_none());
    assert!(gas.triangle_vertices(4, 99).is_none() && gas.custom_box(0, 0).is_none());
}

#[test]
fn sbt_index_of_the_guides_example() {
    // Guide 7.3.5: instances with offsets 0 and 6 of a GAS with 1 + 2 records, two ray types.
    let gas = shared(row(&[1, 2], 0));
    let instances = [0, 6].iter().enumerate().map(|(i, &sbt_offset)| Instance {
        transform: moved(100.0 * i as f32, 0.0, 0.0),
        sbt_offset,
        ..Instance::new(gas.clone())
    });
    let accel = Accel::from(Ias::new(instances.collect()).unwrap());
    let mut seen = Vec::new();
    for instance in 0..2 {
        for geometry in 0..3 {
            for ray_type in 0..2 {
                // Bits above the lowest four do not count.
                let x = 100.0 * instance as f32 + 2.0 * geometry as f32;
                let query = RayQuery { sbt_offset: 0x30 | ray_type, sbt_stride: 0x70 | 2, ..at(x) };
                let hit = trace(Some(&accel), &query, &mut Opaque).unwrap();
                assert_eq!(hit.sbt_index, 6 * instance + 2 * geometry + ray_type);
                seen.push(hit.sbt_index);
            }
        }
    }
    assert_eq!(seen, (0..12).collect::<Vec<_>>());
}

#[test]
fn a_lone_gas_has_no_instance() {
    let accel = Accel::from(stack(&[0.0], OFF));
    let hit = trace(Some(&accel), &RayQuery { sbt_offset: 3, ..down() }, &mut Opaque).unwrap();
    assert_eq!((hit.path.instance_id(), hit.path.instance_index(), hit.sbt_index), (!0, 0, 3));
    assert!(hit.path.innermost().is_none());
    assert_eq!(hit.path.object_to_world(), moved(0., 0., 0.));
}

#[test]
fn offsets_flags_and_transforms_over_levels() {
    let gas = shared(row(&[1, 2], 0));
    // The innermost flags count; the outer flip and any-hit flags do not.
    let outer = InstanceFlags::FLIP_TRIANGLE_FACING | InstanceFlags::ENFORCE_ANYHIT;
    let inner = Ias::new(vec![
        Instance { transform: moved(0., 50., 0.), ..Instance::new(gas.clone()) },
        Instance {
            transform: [0., -2., 0., 7., 2., 0., 0., 0., 0., 0., 2., 0.],
            sbt_offset: 20,
            id: 77,
            ..Instance::new(gas)
        },
    ]);
    let inner = shared(inner.unwrap());
    let turn = [1., 0., 0., 0., 0., 0., -1., 0., 0., 1., 0., 0.];
    let middle = Instance { transform: turn, sbt_offset: 300, flags: outer, ..Instance::new(inner) };
    let middle = shared(Ias::new(vec![middle]).unwrap());
    let top = Instance { transform: moved(0., 0., 1000.), sbt_offset: 4000, flags: outer, ..Instance::new(middle) };
    let accel = Accel::from(Ias::new(vec![top]).unwrap());

    // Object (2.25, 0.25, 0) -> (7 - 0.5, 4.5, 0) -> (6.5, 0, 4.5) -> (6.5, 0, 1004.5); the normal +z becomes -y.
    let query = RayQuery { sbt_stride: 2, sbt_offset: 1, ..RayQuery::new([6.5, -10.0, 1004.5], [0.0, 0.5, 0.0]) };
    let hit = trace(Some(&accel), &query, &mut Opaque).unwrap();
    assert_eq!((hit.t, hit.hit_kind), (20.0, FRONT_FACE));
    assert_eq!(hit.path.indices(), [0, 0, 1]);
    assert_eq!((hit.path.instance_id(), hit.path.instance_index()), (77, 1));
    assert_eq!((hit.sbt_gas_index, hit.sbt_index), (1, 4000 + 300 + 20 + 2 + 1));
    assert_eq!(hit.path.object_to_world(), [0., -2., 0., 7., 0., 0., -2., 0., 2., 0., 0., 1000.]);
    assert_eq!(hit.path.world_to_object(), [0., 0., 0.5, -500., -0.5, 0., 0., 3.5, 0., -0.5, 0., 0.]);
    assert_eq!(hit.path.instances().count(), 3);
    assert_eq!(hit.barycentrics(), [0.25, 0.25]);
    assert_eq!(accel.depth(), 4);
}

#[test]
fn programs_see_the_object_ray() {
    struct Look(Vec<Ray>);
    impl Programs for Look {
        fn any_hit(&mut self, candidate: &Candidate<'_>) -> AnyHit {
            self.0.push(candidate.context.object_ray);
            AnyHit::Accept
        }
        fn intersect(&mut self, context: &PrimitiveContext<'_>, reporter: &mut Reporter<'_, '_>) {
            self.0.push(context.object_ray);
            assert_eq!(reporter.tmax(), f32::INFINITY);
            assert!(reporter.report(self, 8.0, 1, &[]));
            assert_eq!((reporter.tmax(), reporter.is_terminated()), (8.0, false));
        }
    }
    let transform = [2., 0., 0., 10., 0., 2., 0., 20., 0., 0., 2., 30.];
    let child = shared(Gas::new(vec![custom(&[Aabb::new([0.0; 3], [1.0; 3])], ON)]).unwrap());
    let accel = Accel::from(Ias::new(vec![Instance { transform, ..Instance::new(child) }]).unwrap());
    let mut look = Look(Vec::new());
    let query = RayQuery::new([11.0, 21.0, 40.0], [0.0, 0.0, -1.0]);
    assert_eq!(trace(Some(&accel), &query, &mut look).unwrap().t, 8.0);
    let expected = Ray { origin: [0.5, 0.5, 5.0], direction: [0.0, 0.0, -0.5] };
    assert_eq!(look.0, [expected, expected]);
}

#[test]
fn a_graph_of_the_greatest_depth() {
    let mut accel = shared(stack(&[0.0], OFF));
    for level in 1..MAX_GRAPH_DEPTH {
        let instance = Instance { transform: moved(0., 0., 1.), sbt_offset: level as u32, ..Instance::new(accel) };
        accel = shared(Ias::new(vec![instance]).unwrap());
    }
    let query = RayQuery::new([0.25, 0.25, 100.0], [0.0, 0.0, -1.0]);
    let hit = trace(Some(&accel), &query, &mut Opaque).unwrap();
    assert_eq!((hit.t, hit.sbt_index, hit.path.indices().len()), (70.0, (1..31).sum(), 30));
    assert_eq!(hit.path.object_to_world(), moved(0., 0., 30.));
    let error = Ias::new(vec![Instance::new(accel)]).unwrap_err();
    let too_deep = InstanceError::TooDeep { depth: 32, limit: 31 };
    assert_eq!(error, BuildError::Instance { instance: 0, error: too_deep });
}

#[test]
fn many_instances_equal_their_flattened_mesh() {
    // Powers of two and integer moves keep all coordinates exact, so t is the same bit for bit.
    let mut random = Random(3);
    let shape: Vec<[f32; 3]> = (0..60).map(|_| random.sphere().map(|x| (x * 64.0).round() as f32 / 64.0)).collect();
    let child = shared(Gas::new(vec![triangles(shape.clone(), None, OFF)]).unwrap());
    let (mut instances, mut flat) = (Vec::new(), Vec::new());
    for _ in 0..50 {
        let [x, y, z] = random.sphere().map(|x| (x * 8.0).round() as f32);
        let s = [0.5, 1.0, 2.0][random.below(3)];
        let transform = [s, 0., 0., x, 0., 0., s, y, 0., -s, 0., z];
        instances.push(Instance { transform, ..Instance::new(child.clone()) });
        flat.extend(shape.iter().map(|v| [s * v[0] + x, s * v[2] + y, -s * v[1] + z]));
    }
    let flat = Accel::from(Gas::new(vec![triangles(flat, None, OFF)]).unwrap());
    let accel = Accel::from(Ias::new(instances).unwrap());
    let mut hits = 0;
    for _ in 0..20_000 {
        let origin = random.sphere().map(|x| (x * 640.0).round() as f32 / 64.0);
        let direction = random.sphere().map(|x| (x * 64.0).round() as f32 / 64.0);
        let query = RayQuery::new(origin, direction);
        let (a, b) = (trace(Some(&accel), &query, &mut Opaque), trace(Some(&flat), &query, &mut Opaque));
        match (a, b) {
            (Some(a), Some(b)) => {
                hits += 1;
                assert!((a.t - b.t).abs() <= 4.0 * f32::EPSILON * b.t, "{} {}", a.t, b.t);
            }
            (None, None) => {}
            // Only at silhouettes, where the rays' slopes round differently.
            (a, b) => panic!("{query:?}: {:?} {:?}", a.map(|h| h.t), b.map(|h| h.t)),
        }
    }
    assert!(hits > 2000, "{hits}");
}
