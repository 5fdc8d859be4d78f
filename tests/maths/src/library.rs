//! glam's functions, and `f32`'s by method call, a kernel each: the test looks at what instructions they are made of.

use glam::{Mat4, Quat, Vec2, Vec3};
use optix_device_rs::prelude::Math;

use crate::device::kernels;

kernels! {
    f32:
    "glam_length" |x, y| Vec3::new(x, y, x).length();
    "glam_distance" |x, y| Vec3::new(x, y, x).distance(Vec3::Y);
    "glam_normalize" |x, y| Vec3::new(x, y, x).normalize().element_sum();
    "glam_normalize_or_zero" |x, y| Vec3::new(x, y, x).normalize_or_zero().element_sum();
    "glam_quat_normalize" |x, y| (Quat::from_xyzw(x, y, x, y).normalize() * Vec3::X).element_sum();
    "glam_quat_rotate" |x, y| (Quat::from_xyzw(x, y, x, y) * Vec3::X).element_sum();
    "glam_quat_from_axis_angle" |x, y| (Quat::from_axis_angle(Vec3::Y, x) * Vec3::splat(y)).element_sum();
    "glam_quat_slerp" |x, y| (Quat::from_rotation_x(1.0).slerp(Quat::from_rotation_y(y), x) * Vec3::X).element_sum();
    "glam_from_angle" |x, y| Vec2::from_angle(x).dot(Vec2::splat(y));
    "glam_angle_between" |x, y| Vec3::new(x, y, x).angle_between(Vec3::Y);
    "glam_refract" |x, y| Vec3::new(x, y, x).refract(Vec3::Y, 1.5).element_sum();
    "glam_mat4_inverse" |x, y| (Mat4::from_cols_array(&[x, y, 1., 2., y, x, 3., 4., 5., 6., x, y, 7., y, 8., x]).inverse()).transform_point3(Vec3::X).element_sum();
    "glam_powf" |x, y| Vec3::new(x, y, x).powf(2.4).element_sum();
    "glam_floor" |x, y| Vec3::new(x, y, x).floor().element_sum();
    "method_sqrt" |x, _| x.sqrt();
    "method_floor" |x, _| x.floor();
    "method_mul_add" |x, y| x.mul_add(y, x);
    "method_sin" |x, _| x.sin();
    "method_sin_cos" |x, y| Vec2::from(x.sin_cos()).dot(Vec2::splat(y));
}
