//! Legal and wrong inputs.

use super::*;

#[test]
fn nothing_is_legal() {
    let inverted = Aabb::new([1.0; 3], [0.0; 3]);
    for gas in [
        Gas::new(Vec::<BuildInput<TriangleArray>>::new()).unwrap(),
        Gas::new(vec![triangles(vec![], None, OFF)]).unwrap(),
        Gas::new(vec![triangles(vec![[0.0; 3]], Some(vec![]), OFF)]).unwrap(),
        Gas::new(Vec::<BuildInput<CustomPrimitiveArray>>::new()).unwrap(),
        Gas::new(vec![custom(&[], OFF)]).unwrap(),
        Gas::new(vec![custom(&[inverted], OFF)]).unwrap(),
    ] {
        let gas = shared(gas);
        assert!(gas.bounds().is_empty());
        assert!(trace(Some(&gas), &down(), &mut Opaque).is_none());
        let ias = Accel::from(Ias::new(vec![Instance::new(gas)]).unwrap());
        assert!(trace(Some(&ias), &down(), &mut Opaque).is_none());
    }
    assert!(trace(Some(&Accel::from(Ias::new(vec![]).unwrap())), &down(), &mut Opaque).is_none());
}

#[test]
fn too_many_records_are_refused() {
    let input = |records: usize| {
        let corners = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let records = Records::indexed(vec![OFF; records], vec![0]);
        BuildInput::new(TriangleArray::new(corners, None).unwrap(), records).unwrap()
    };
    let error = BuildError::TooMany { what: "hit-group records", count: (1 << 24) + 2, limit: 1 << 24 };
    assert_eq!(Gas::new(vec![input(1), input((1 << 24) + 1)]).unwrap_err(), error);
    assert!(Gas::new(vec![input(1), input((1 << 24) - 1)]).is_ok());
}

#[test]
fn wrong_instances_are_named() {
    let child = shared(stack(&[0.0], OFF));
    let good = || Instance::new(child.clone());
    let below = shared(Ias::new(vec![Instance { sbt_offset: (1 << 28) - 1, ..good() }]).unwrap());
    let cases = [
        (Instance { id: 1 << 28, ..good() }, InstanceError::Id { id: 1 << 28 }),
        (Instance { sbt_offset: 1 << 28, ..good() }, InstanceError::RecordOffset { offset: 1 << 28 }),
        (
            Instance { sbt_offset: 1, child: below, ..good() },
            InstanceError::RecordOffsetSum { offset: 1, sum: 1 << 28 },
        ),
        (Instance { transform: [0.0; 12], ..good() }, InstanceError::SingularTransform { transform: [0.0; 12] }),
    ];
    for (instance, error) in cases {
        assert_eq!(Ias::new(vec![good(), instance]).unwrap_err(), BuildError::Instance { instance: 1, error });
    }
}

#[test]
fn odd_rays_miss() {
    let accel = Accel::from(stack(&[0.0], OFF));
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for axis in 0..3 {
            let (mut origin, mut direction) = (down(), down());
            origin.origin[axis] = bad;
            direction.direction[axis] = bad;
            assert!(trace(Some(&accel), &origin, &mut Opaque).is_none());
            assert!(trace(Some(&accel), &direction, &mut Opaque).is_none());
        }
    }
    for zero in [0.0, -0.0] {
        assert!(trace(Some(&accel), &RayQuery { direction: [zero; 3], ..down() }, &mut Opaque).is_none());
        let query = RayQuery { direction: [zero, -zero, -1.0], ..down() };
        assert_eq!(trace(Some(&accel), &query, &mut Opaque).unwrap().t, 10.0);
    }
    // The shortest and longest directions.
    for length in [1e-44f32, 1e-38, 1e-36, 1e38, f32::MAX] {
        let query = RayQuery { direction: [0.0, 0.0, -length], ..down() };
        let t = trace(Some(&accel), &query, &mut Opaque).map(|hit| hit.t);
        let expected = (10.0 / f64::from(length)) as f32;
        assert_eq!(t, expected.is_finite().then_some(expected), "a t beyond f32 is no hit");
    }
}
