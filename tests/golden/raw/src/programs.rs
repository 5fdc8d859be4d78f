//! One function per entry; the last part of its name is that of the typed program.

use crate::intrinsics::*;

core::arch::global_asm!(".visible .const .align 8 .b8 raw_params[56];");

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    trap()
}

/// Four numbers, aligned as one load or store of them wants it.
#[repr(C, align(16))]
struct Float4([f32; 4]);

/// The film: the first parameters are its address and its length.
struct Film(u64, u64);

impl Film {
    #[inline(always)]
    fn new() -> Self {
        Self(param!("ld.const.b64", reg64, u64, 0), param!("ld.const.b64", reg64, u64, 8))
    }

    #[inline(always)]
    fn set(self, index: u32, value: [f32; 4]) {
        let at = address_if(index, self.1 as u32, self.0 + u64::from(index) * size_of::<Float4>() as u64);
        // SAFETY: inside of the film, or nowhere.
        unsafe { (at as *mut Float4).write(Float4(value)) }
    }
}

#[inline(always)]
fn sun() -> [f32; 3] {
    [
        param!("ld.const.b32", reg32, f32, 32),
        param!("ld.const.b32", reg32, f32, 36),
        param!("ld.const.b32", reg32, f32, 40),
    ]
}

#[inline(always)]
fn scale() -> f32 {
    param!("ld.const.b32", reg32, f32, 24)
}

#[unsafe(no_mangle)]
pub unsafe extern "ptx-kernel" fn __raygen__index() {
    let (x, y) = (get_u32!("_optix_get_launch_index_x"), get_u32!("_optix_get_launch_index_y"));
    let (w, h) = (get_u32!("_optix_get_launch_dimension_x"), get_u32!("_optix_get_launch_dimension_y"));
    Film::new().set(y * w + x, [x as f32, y as f32, w as f32, h as f32]);
}

#[unsafe(no_mangle)]
pub unsafe extern "ptx-kernel" fn __raygen__words() {
    let ([x, y, z], scale) = (sun(), scale());
    Film::new().set(param!("ld.const.b32", reg32, u32, 28), [x * scale, y * scale, z * scale, 1.0]);
}

#[unsafe(no_mangle)]
pub unsafe extern "ptx-kernel" fn __raygen__bytes() {
    let flag = param!("ld.const.u8", reg32, u32, 44) as u8;
    // SAFETY: 0 or 1, as the host has written it.
    let flag: bool = unsafe { core::mem::transmute(flag) };
    let value = if flag { scale() } else { f32::from(param!("ld.const.u16", reg32, u32, 46) as u16) };
    Film::new().set(get_u32!("_optix_get_launch_index_x"), [value; 4]);
}

#[unsafe(no_mangle)]
pub unsafe extern "ptx-kernel" fn __raygen__wide() {
    let seed = param!("ld.const.b64", reg64, u64, 48);
    let state = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
    Film::new().set(get_u32!("_optix_get_launch_index_x"), [(state >> 40) as f32; 4]);
}

#[unsafe(no_mangle)]
pub unsafe extern "ptx-kernel" fn __raygen__caller() {
    let (x, y) = (get_u32!("_optix_get_launch_index_x"), get_u32!("_optix_get_launch_index_y"));
    let call = Trace {
        types: 1,
        handle: param!("ld.const.b64", reg64, u64, 16),
        origin: [x as f32, y as f32, 0.0],
        direction: sun(),
        interval: [0.5, 100.0],
        time: 0.0,
        mask: 255,
        flags: 0,
        sbt_offset: 0,
        sbt_stride: 1,
        miss_index: 0,
    };
    let [r, g, b, seed, _] = trace_5(&call, [0, 0, 0, x, 7]);
    Film::new().set(x, [f32::from_bits(r), f32::from_bits(g), f32::from_bits(b), seed as f32]);
}

/// Sets three words after all three are known: a call ends what loads may be moved across.
#[inline(always)]
fn set_payload_0_to_2([x, y, z]: [f32; 3]) {
    set_payload(0, x.to_bits());
    set_payload(1, y.to_bits());
    set_payload(2, z.to_bits());
}

#[repr(C)]
struct Lambert {
    albedo: [f32; 3],
    id: u32,
}

#[unsafe(no_mangle)]
pub unsafe extern "ptx-kernel" fn __closesthit__shade() {
    set_payload_types(1);
    let (seed, layers) = (get_payload(3), get_payload(4));
    // SAFETY: this program's record.
    let record = unsafe { &*record::<Lambert>() };
    let seed = seed.wrapping_mul(747_796_405).wrapping_add(layers ^ record.id);
    let t = get_f32!("_optix_get_ray_tmax");
    set_payload_0_to_2(record.albedo.map(|albedo| albedo * t));
    set_payload(3, seed);
}

#[repr(u8)]
enum Decision {
    Accept,
    Ignore,
    Terminate,
}

fn cut_out(layers: u32) -> (Decision, u32) {
    // SAFETY: this program's record.
    let record = unsafe { &*record::<Lambert>() };
    let layers = layers + 1;
    let decision = if get_u32!("_optix_read_primitive_idx") == record.id {
        Decision::Ignore
    } else if barycentrics()[0] > 0.5 {
        Decision::Terminate
    } else {
        Decision::Accept
    };
    (decision, layers)
}

#[unsafe(no_mangle)]
pub unsafe extern "ptx-kernel" fn __anyhit__cut_out() {
    set_payload_types(1);
    let (decision, layers) = cut_out(get_payload(4));
    // Before the calls that end the program.
    set_payload(4, layers);
    match decision {
        Decision::Accept => {}
        Decision::Ignore | Decision::Terminate => {
            if let Decision::Terminate = decision {
                terminate_ray();
            }
            // Not reached after the other: a branch less than to the end.
            ignore_intersection();
        }
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "ptx-kernel" fn __closesthit__corners() {
    set_payload_types(1);
    let seed = get_payload(3);
    // SAFETY: this program's record.
    let weight = unsafe { *record::<f32>() };
    let [a, b, c] = triangle_vertices();
    set_payload_0_to_2([0, 1, 2].map(|i| (a[i] + b[i] + c[i]) * weight));
    set_payload(3, seed);
}

#[unsafe(no_mangle)]
pub unsafe extern "ptx-kernel" fn __intersection__ball() {
    set_payload_types(1);
    // SAFETY: this program's record.
    let radius = unsafe { *record::<f32>() };
    let t = radius - get_f32!("_optix_get_object_ray_origin_x");
    let direction = [
        get_f32!("_optix_get_object_ray_direction_x"),
        get_f32!("_optix_get_object_ray_direction_y"),
        get_f32!("_optix_get_object_ray_direction_z"),
    ];
    let [x, y, z] = direction.map(|component| (component * t).to_bits());
    report_intersection_4(t, 3, [x, y, z, get_u32!("_optix_read_primitive_idx")]);
}

#[unsafe(no_mangle)]
pub unsafe extern "ptx-kernel" fn __closesthit__ball_shade() {
    set_payload_types(1);
    let seed = get_payload(3);
    // SAFETY: this program's record.
    let radius = unsafe { *record::<f32>() };
    let attributes = [
        get_u32!("_optix_get_attribute_0"),
        get_u32!("_optix_get_attribute_1"),
        get_u32!("_optix_get_attribute_2"),
        get_u32!("_optix_get_attribute_3"),
    ];
    set_payload_0_to_2([0, 1, 2].map(|i| f32::from_bits(attributes[i]) * radius));
    set_payload(3, seed ^ attributes[3]);
}

#[unsafe(no_mangle)]
pub unsafe extern "ptx-kernel" fn __miss__sky() {
    set_payload_types(1);
    // SAFETY: this program's record.
    let light = unsafe { *record::<[f32; 3]>() };
    let y = get_f32!("_optix_get_world_ray_direction_y");
    set_payload_0_to_2(light.map(|light| light * y));
}

#[repr(C)]
struct Blend {
    of: u32,
    scale: f32,
}

#[repr(C)]
pub struct Arguments([f32; 3], f32);

#[repr(C)]
pub struct Colour([f32; 3]);

#[unsafe(no_mangle)]
pub unsafe extern "C" fn __direct_callable__blend(Arguments(at, share): Arguments) -> Colour {
    // SAFETY: this program's record.
    let record = unsafe { &*record::<Blend>() };
    // SAFETY: a callable with these arguments and this result.
    let callee = unsafe {
        core::mem::transmute::<*const (), extern "C" fn(Arguments) -> Colour>(direct_callable(record.of) as *const ())
    };
    let Colour(colour) = callee(Arguments(at.map(|x| x * record.scale), share));
    Colour(colour.map(|channel| channel * share))
}
