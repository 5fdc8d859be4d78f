//! Any-hit decisions, culling, masks, reports.

use super::*;

/// What the guide says, case by case rather than by formula (guide 5.1, 5.4, 13.2).
fn expected(geometry_off: bool, instance: InstanceFlags, ray: u32) -> Verdict {
    use Verdict::*;
    let state = match instance {
        InstanceFlags::DISABLE_ANYHIT => false,
        InstanceFlags::ENFORCE_ANYHIT => true,
        _ => !geometry_off,
    };
    match (ray, state) {
        (ray_flags::DISABLE_ANYHIT, _) => Opaque,
        (ray_flags::ENFORCE_ANYHIT, _) => AnyHit,
        (ray_flags::CULL_DISABLED_ANYHIT, false) | (ray_flags::CULL_ENFORCED_ANYHIT, true) => Cull,
        (_, true) => AnyHit,
        (_, false) => Opaque,
    }
}

#[test]
fn any_hit_decision_table() {
    let instances = [InstanceFlags::NONE, InstanceFlags::DISABLE_ANYHIT, InstanceFlags::ENFORCE_ANYHIT];
    let rays = [
        ray_flags::NONE,
        ray_flags::DISABLE_ANYHIT,
        ray_flags::ENFORCE_ANYHIT,
        ray_flags::CULL_DISABLED_ANYHIT,
        ray_flags::CULL_ENFORCED_ANYHIT,
    ];
    for geometry in [ON, OFF] {
        let gas = shared(stack(&[0.0], geometry));
        let boxes = vec![Aabb::new([0.0; 3], [1.0; 3])];
        let custom = shared(Gas::new(vec![custom(&boxes, geometry)]).unwrap());
        for flags in instances {
            for ray in rays {
                let verdict = expected(geometry == OFF, flags, ray);
                let name = format!("{geometry:?} {flags:?} ray {ray}");
                assert_eq!(any_hit_verdict(geometry, flags, ray), verdict, "{name}");
                for child in [&gas, &custom] {
                    let instance = Instance { flags, ..Instance::new(child.clone()) };
                    let accel = Accel::from(Ias::new(vec![instance]).unwrap());
                    for answer in [AnyHit::Accept, AnyHit::Ignore] {
                        let mut programs = Scripted { reports: vec![(9.5, 3)], ..Scripted::new(answer) };
                        let query = RayQuery { flags: ray, ..down() };
                        let hit = trace(Some(&accel), &query, &mut programs).is_some();
                        assert_eq!(programs.calls.len(), usize::from(verdict == Verdict::AnyHit), "{name}");
                        let ignored = verdict == Verdict::AnyHit && answer == AnyHit::Ignore;
                        assert_eq!(hit, verdict != Verdict::Cull && !ignored, "{name}");
                    }
                }
            }
        }
    }
}

#[test]
fn flags_have_the_abi_values() {
    use ray_flags::*;
    let all = [
        DISABLE_ANYHIT,
        ENFORCE_ANYHIT,
        TERMINATE_ON_FIRST_HIT,
        CULL_BACK_FACING_TRIANGLES,
        CULL_FRONT_FACING_TRIANGLES,
        CULL_DISABLED_ANYHIT,
        CULL_ENFORCED_ANYHIT,
    ];
    assert_eq!(all, [1, 2, 4, 16, 32, 64, 128]);
    assert_eq!((FRONT_FACE, BACK_FACE), (254, 255));
}

#[test]
fn faces_flips_and_culling() {
    for from_front in [true, false] {
        for flip in [false, true] {
            for disable in [false, true] {
                for by_geometry in [false, true] {
                    for (cull, culls_front) in [
                        (ray_flags::NONE, None),
                        (ray_flags::CULL_BACK_FACING_TRIANGLES, Some(false)),
                        (ray_flags::CULL_FRONT_FACING_TRIANGLES, Some(true)),
                    ] {
                        let mut flags = OFF;
                        if by_geometry {
                            flags = flags | GeometryFlags::DISABLE_TRIANGLE_FACE_CULLING;
                        }
                        let mut of_instance = InstanceFlags::NONE;
                        if flip {
                            of_instance = of_instance | InstanceFlags::FLIP_TRIANGLE_FACING;
                        }
                        if disable {
                            of_instance = of_instance | InstanceFlags::DISABLE_TRIANGLE_FACE_CULLING;
                        }
                        let child = shared(stack(&[0.0], flags));
                        let accel = Accel::from(
                            Ias::new(vec![Instance { flags: of_instance, ..Instance::new(child) }]).unwrap(),
                        );
                        let side = if from_front { 1.0 } else { -1.0 };
                        let ray =
                            RayQuery { flags: cull, ..RayQuery::new([0.25, 0.25, 10.0 * side], [0.0, 0.0, -side]) };
                        let kind = trace(Some(&accel), &ray, &mut Opaque).map(|hit| hit.hit_kind);
                        let front = from_front != flip;
                        let culled = culls_front == Some(front) && !disable && !by_geometry;
                        let expected = (!culled).then_some(if front { FRONT_FACE } else { BACK_FACE });
                        assert_eq!(
                            kind, expected,
                            "front {from_front} flip {flip} off {disable} {by_geometry} ray {cull}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn front_is_counter_clockwise_along_every_axis() {
    let mut random = Random(7);
    for _ in 0..2000 {
        let ray = RayQuery::new(random.sphere().map(|x| x as f32), random.sphere().map(|x| x as f32));
        let [a, b, c] = [(); 3].map(|()| random.sphere().map(|x| (3.0 * x) as f32));
        let accel = mesh(&[a, b, c], &[[0, 1, 2]]);
        let Some(hit) = trace(Some(&accel), &ray, &mut Opaque) else { continue };
        let [d, e] = [b, c].map(|v| [0, 1, 2].map(|i| f64::from(v[i]) - f64::from(a[i])));
        let normal = [0, 1, 2].map(|i| d[(i + 1) % 3] * e[(i + 2) % 3] - d[(i + 2) % 3] * e[(i + 1) % 3]);
        let along: f64 = (0..3).map(|i| normal[i] * f64::from(ray.direction[i])).sum();
        assert_eq!(hit.hit_kind == FRONT_FACE, along < 0.0);
        // Barycentrics: u for the second corner, v for the third.
        let [u, v] = hit.barycentrics();
        for i in 0..3 {
            let p = f64::from(a[i]) + f64::from(u) * d[i] + f64::from(v) * e[i];
            let q = f64::from(ray.origin[i]) + f64::from(hit.t) * f64::from(ray.direction[i]);
            assert!((p - q).abs() < 1e-4, "{p} {q}");
        }
    }
}

#[test]
fn visibility_masks() {
    let child = shared(stack(&[0.0], OFF));
    for (ray, instance) in [(0xff, 0), (0, 0xff), (1, 2), (0xf0, 0x0f), (3, 2), (0x80, 0xff), (0xff, 1)] {
        let accel = Accel::from(
            Ias::new(vec![Instance { visibility_mask: instance, ..Instance::new(child.clone()) }]).unwrap(),
        );
        let hit = trace(Some(&accel), &RayQuery { mask: ray, ..down() }, &mut Opaque).is_some();
        assert_eq!(hit, ray & instance != 0);
    }
    // A lone GAS has no mask.
    assert!(trace(Some(&child), &RayQuery { mask: 0, ..down() }, &mut Opaque).is_some());
}

#[test]
fn ignore_terminate_and_first_hit() {
    let depths: Vec<f32> = (0..40).map(|i| ((i * 17) % 40) as f32 / 8.0).collect();
    let accel = Accel::from(stack(&depths, ON));

    let mut ignore = Scripted::new(AnyHit::Ignore);
    assert!(trace(Some(&accel), &down(), &mut ignore).is_none());
    let mut seen: Vec<u32> = ignore.calls.iter().map(|call| call.0).collect();
    seen.sort_unstable();
    assert_eq!(seen, (0..40).collect::<Vec<_>>(), "each primitive exactly once");

    let mut accept = Scripted::new(AnyHit::Accept);
    let hit = trace(Some(&accel), &down(), &mut accept).unwrap();
    assert_eq!(hit.t, 10.0 - 39.0 / 8.0);

    for (answer, flags) in [(AnyHit::Terminate, 0), (AnyHit::Accept, ray_flags::TERMINATE_ON_FIRST_HIT)] {
        let mut programs = Scripted::new(answer);
        let hit = trace(Some(&accel), &RayQuery { flags, ..down() }, &mut programs).unwrap();
        assert_eq!(programs.calls.len(), 1);
        assert_eq!((hit.primitive_index, hit.t), (programs.calls[0].0, programs.calls[0].1));
    }
    // An ignored candidate is no hit, so the ray goes on.
    let mut programs = Scripted::new(AnyHit::Ignore);
    let query = RayQuery { flags: ray_flags::TERMINATE_ON_FIRST_HIT, ..down() };
    assert!(trace(Some(&accel), &query, &mut programs).is_none());
    assert_eq!(programs.calls.len(), 40);
}

#[test]
fn the_interval_is_closed() {
    let accel = Accel::from(stack(&[0.0, 2.0, 4.0], OFF));
    for (tmin, tmax, t) in [
        (0.0, 100.0, Some(6.0)),
        (6.0, 6.0, Some(6.0)),
        (6.0f32.next_up(), 100.0, Some(8.0)),
        (0.0, 6.0f32.next_down(), None),
        (8.0, 8.0, Some(8.0)),
        (7.0, 5.0, None),
        (11.0, f32::INFINITY, None),
        (f32::NAN, 100.0, None),
        (0.0, f32::NAN, None),
        (-1.0, 100.0, Some(6.0)),
    ] {
        let hit = trace(Some(&accel), &RayQuery { tmin, tmax, ..down() }, &mut Opaque);
        assert_eq!(hit.map(|hit| hit.t), t, "[{tmin}, {tmax}]");
    }
    assert!(trace(None, &down(), &mut Opaque).is_none());
}

#[test]
fn ties_go_to_the_first_path_and_primitive() {
    let same = shared(stack(&[1.0; 30], ON));
    let mut programs = Scripted::new(AnyHit::Accept);
    assert_eq!(trace(Some(&same), &down(), &mut programs).unwrap().primitive_index, 0);

    let two = shared(Ias::new(vec![Instance::new(same.clone()), Instance::new(same.clone())]).unwrap());
    let all: Vec<Instance> = (0..9).map(|_| Instance::new(two.clone())).collect();
    let accel = Accel::from(Ias::new(all).unwrap());
    let hit = trace(Some(&accel), &down(), &mut programs).unwrap();
    assert_eq!((hit.path.indices(), hit.primitive_index), (&[0, 0][..], 0));
}

#[test]
fn reports() {
    let input = custom(&[Aabb::new([0.0; 3], [1.0; 3])], ON).with_primitive_index_offset(5);
    let accel = Accel::from(Gas::new(vec![input.unwrap()]).unwrap());
    let run = |programs: &mut Scripted, flags| {
        let query = RayQuery { tmin: 1.0, tmax: 20.0, flags, ..down() };
        trace(Some(&accel), &query, programs).map(|hit| (hit.t, hit.hit_kind, hit.primitive_index, hit.attributes[0]))
    };

    // Outside the interval, NaN, accepted, behind the accepted one, nearer, tied: the first report wins.
    let reports = vec![(0.5, 1), (21.0, 2), (f32::NAN, 3), (15.0, 4), (16.0, 5), (10.0, 0x80 | 6), (10.0, 7)];
    let mut programs = Scripted { reports, ..Scripted::new(AnyHit::Accept) };
    assert_eq!(run(&mut programs, 0), Some((10.0, 6, 5, 0x86)));
    assert_eq!(programs.accepted, [false, false, false, true, false, true, false]);
    assert_eq!(programs.calls.iter().map(|c| (c.0, c.1)).collect::<Vec<_>>(), [(5, 15.0), (5, 10.0)]);

    // Ignored reports do not shrink the interval.
    let mut programs = Scripted { reports: vec![(10.0, 1), (12.0, 2)], ..Scripted::new(AnyHit::Ignore) };
    assert_eq!(run(&mut programs, 0), None);
    assert_eq!((programs.calls.len(), programs.accepted.as_slice()), (2, &[false, false][..]));

    // After the end nothing is taken.
    for (answer, flags) in [(AnyHit::Terminate, 0), (AnyHit::Accept, ray_flags::TERMINATE_ON_FIRST_HIT)] {
        let mut programs = Scripted { reports: vec![(12.0, 1), (10.0, 2)], ..Scripted::new(answer) };
        assert_eq!(run(&mut programs, flags), Some((12.0, 1, 5, 1)));
        assert_eq!((programs.calls.len(), programs.accepted.as_slice()), (1, &[true, false][..]));
    }

    // A ray beside the box does not run the program.
    let mut programs = Scripted { reports: vec![(10.0, 1)], ..Scripted::new(AnyHit::Accept) };
    assert!(trace(Some(&accel), &RayQuery { origin: [1.5, 0.5, 10.0], ..down() }, &mut programs).is_none());
    assert_eq!(programs.sites, 0);
}
