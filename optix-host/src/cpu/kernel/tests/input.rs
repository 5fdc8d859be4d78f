//! Legal and wrong inputs.

use super::*;

#[test]
fn nothing_is_legal() {
    let boxes = AabbInput { boxes: vec![], sbt: SbtMapping::single(OFF), primitive_index_offset: 0 };
    let inverted = AabbInput { boxes: vec![Aabb::new([1.0; 3], [0.0; 3])], ..boxes.clone() };
    for gas in [
        Gas::triangles(vec![]).unwrap(),
        Gas::triangles(vec![triangles(vec![], None, OFF)]).unwrap(),
        Gas::triangles(vec![triangles(vec![[0.0; 3]], Some(vec![]), OFF)]).unwrap(),
        Gas::custom(vec![]).unwrap(),
        Gas::custom(vec![boxes]).unwrap(),
        Gas::custom(vec![inverted]).unwrap(),
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
fn wrong_geometry_is_named() {
    let good = || triangles(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], Some(vec![[0, 1, 2]]), OFF);
    let sbt = |records: usize, per_primitive| SbtMapping { flags: vec![OFF; records], per_primitive };
    let cases = [
        (
            TriangleInput { indices: Some(vec![[0, 1, 2], [2, 3, 1]]), ..good() },
            BuildError::IndexOutOfRange { input: 1, triangle: 1, corner: 1, index: 3, vertices: 3 },
        ),
        (
            TriangleInput { vertices: vec![[0.0; 3]; 4], indices: None, ..good() },
            BuildError::IncompleteTriangle { input: 1, vertices: 4 },
        ),
        (
            TriangleInput { vertices: vec![[0.0; 3], [0.0, f32::INFINITY, 0.0], [0.0; 3]], ..good() },
            BuildError::NonFiniteVertex { input: 1, vertex: 1, position: [0.0, f32::INFINITY, 0.0] },
        ),
        (TriangleInput { sbt: sbt(0, None), ..good() }, BuildError::NoSbtRecord { input: 1 }),
        (TriangleInput { sbt: sbt(2, None), ..good() }, BuildError::NoPerPrimitiveIndex { input: 1, records: 2 }),
        (
            TriangleInput { sbt: sbt(2, Some(vec![0, 1])), ..good() },
            BuildError::PerPrimitiveLength { input: 1, primitives: 1, indices: 2 },
        ),
        (
            TriangleInput { sbt: sbt(2, Some(vec![2])), ..good() },
            BuildError::SbtIndexOutOfRange { input: 1, primitive: 0, index: 2, records: 2 },
        ),
        (
            TriangleInput { sbt: sbt((1 << 24) + 1, Some(vec![2])), ..good() },
            BuildError::TooMany { what: "SBT records", count: (1 << 24) + 2, limit: 1 << 24 },
        ),
    ];
    for (input, error) in cases {
        assert_eq!(Gas::triangles(vec![good(), input]).unwrap_err(), error);
    }
    let message =
        Gas::triangles(vec![TriangleInput { indices: Some(vec![[0, 1, 9]]), ..good() }]).unwrap_err().to_string();
    assert!(message.contains("corner 2 of triangle 0 has vertex index 9") && message.contains("3 vertices (0 to 2)"));

    let offset = TriangleInput { primitive_index_offset: u32::MAX, ..good() };
    assert!(Gas::triangles(vec![offset]).is_ok(), "the last index still fits");
    let boxes = vec![Aabb::new([0.0; 3], [1.0; 3]), Aabb::new([0.0; 3], [f32::NAN; 3])];
    let input = AabbInput { boxes, sbt: SbtMapping::single(OFF), primitive_index_offset: 0 };
    assert!(matches!(Gas::custom(vec![input]), Err(BuildError::NonFiniteBox { input: 0, primitive: 1, .. })));
}

#[test]
fn wrong_instances_are_named() {
    let child = shared(stack(&[0.0], OFF));
    let good = || Instance::new(child.clone());
    let below = shared(Ias::new(vec![Instance { sbt_offset: (1 << 28) - 1, ..good() }]).unwrap());
    let flat = [1., 2., 3., 0., 4., 5., 6., 0., 7., 8., 9., 0.];
    let mut nan = flat;
    nan[3] = f32::NAN;
    let both = InstanceFlags::DISABLE_ANYHIT | InstanceFlags::ENFORCE_ANYHIT;
    let cases = [
        (
            Instance { instance_id: 1 << 28, ..good() },
            BuildError::Exceeds28Bits { instance: 1, field: "instance_id", value: 1 << 28 },
        ),
        (
            Instance { sbt_offset: 1 << 28, ..good() },
            BuildError::Exceeds28Bits { instance: 1, field: "sbt_offset", value: 1 << 28 },
        ),
        (
            Instance { sbt_offset: 1, child: below, ..good() },
            BuildError::SbtOffsetSum { instance: 1, offset: 1, sum: 1 << 28 },
        ),
        (Instance { transform: flat, ..good() }, BuildError::SingularTransform { instance: 1, transform: flat }),
        (
            Instance { transform: [0.0; 12], ..good() },
            BuildError::SingularTransform { instance: 1, transform: [0.0; 12] },
        ),
        (Instance { flags: both, ..good() }, BuildError::AnyHitFlags { instance: 1 }),
    ];
    for (instance, error) in cases {
        assert_eq!(Ias::new(vec![good(), instance]).unwrap_err(), error);
    }
    let error = Ias::new(vec![Instance { transform: nan, ..good() }]).unwrap_err();
    assert!(matches!(error, BuildError::NonFiniteTransform { instance: 0, .. }));
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
