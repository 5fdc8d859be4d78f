//! Textures: lookups on the CPU and on OptiX agree over random coordinates, in all modes.

use glam::Vec4;
use optix_device_rs::rng::Pcg32;
use optix_host::texture::{Format, TexelFormat};
use optix_host::{AddressMode, Buffer2d, Device, FilterMode, Pipeline, Scene};
use optix_tests::devices;
use optix_tests::probe::PTX;
use probe_shaders::textures::{Query, TEXTURES, TextureFrameHost, Textures};

const NAMES: [&str; TEXTURES as usize] = ["1D", "2D", "2D, two channels", "2D, one", "3D", "layered", "cube"];

/// How lookups treat the textures.
#[derive(Clone, Copy, Debug)]
struct Mode {
    address: AddressMode,
    filter: FilterMode,
    mip_filter: FilterMode,
    normalized: bool,
    srgb: bool,
}

/// Texels of any kind, made of random bits.
trait Random: TexelFormat + Copy {
    type One: TexelFormat<Texel = f32> + Copy;
    type Two: TexelFormat<Texel = glam::Vec2> + Copy;
    fn random(rng: &mut Pcg32) -> Self;
    fn one(self) -> Self::One;
    fn two(self) -> Self::Two;
}

macro_rules! random {
    ($($ty:ty: $of:expr;)*) => {$(
        impl Random for [$ty; 4] {
            type One = $ty;
            type Two = [$ty; 2];
            fn random(rng: &mut Pcg32) -> Self {
                [(); 4].map(|()| $of(rng))
            }
            fn one(self) -> $ty {
                self[0]
            }
            fn two(self) -> [$ty; 2] {
                [self[0], self[1]]
            }
        }
    )*};
}
random! {
    f32: |rng: &mut Pcg32| 2.0 * rng.next_f32() - 1.0;
    u8: |rng: &mut Pcg32| rng.next_u32() as u8;
    i8: |rng: &mut Pcg32| rng.next_u32() as i8;
    u16: |rng: &mut Pcg32| rng.next_u32() as u16;
    i16: |rng: &mut Pcg32| rng.next_u32() as i16;
}

const WIDTH: u32 = 12;
const HEIGHT: u32 = 7;
const DEPTH: u32 = 5;
const CUBE: u32 = 8;

/// What each texture gives for each query.
fn look_up<F: Random<Texel = Vec4>>(device: &Device, mode: Mode, queries: &[Query]) -> Vec<Vec4> {
    let mut rng = Pcg32::new(7, 8);
    let mut texels = |count: u32| -> Vec<F> { (0..count).map(|_| F::random(&mut rng)).collect() };
    let Mode { address, filter, mip_filter, normalized, srgb } = mode;
    // Only normalized coordinates have levels.
    let levels = if normalized { 3 } else { 1 };
    macro_rules! made {
        ($builder:expr, $levels:expr) => {{
            let mut builder =
                $builder.address(address).filter(filter).mip_filter(mip_filter).border([0.25, 0.5, 0.75, 1.0]);
            for level in $levels {
                builder = builder.mip_level(level);
            }
            if !normalized {
                builder = builder.unnormalized();
            }
            builder
        }};
    }
    let mut pyramid = |[w, h, d]: [u32; 3], layered: bool| -> Vec<Vec<F>> {
        let half = |n: u32, level: u32| (n >> level).max(1);
        (0..levels).map(|l| texels(half(w, l) * half(h, l) * if layered { d } else { half(d, l) })).collect()
    };
    let row = pyramid([WIDTH, 1, 1], false);
    let image = pyramid([WIDTH, HEIGHT, 1], false);
    let volume = pyramid([WIDTH, HEIGHT, DEPTH], false);
    let layers = pyramid([WIDTH, HEIGHT, DEPTH], true);
    let sides = pyramid([CUBE, CUBE, 6], true);
    let one: Vec<Vec<F::One>> = image.iter().map(|level| level.iter().map(|t| t.one()).collect()).collect();
    let two: Vec<Vec<F::Two>> = image.iter().map(|level| level.iter().map(|t| t.two()).collect()).collect();
    let size = [WIDTH, HEIGHT];
    let seen: Buffer2d<Vec4> = device.zeroed_2d([queries.len() as u32, TEXTURES]).unwrap();
    // A cube has normalized coordinates in any mode.
    let mut cube = device.texture_cube(CUBE, &sides[0]).filter(filter).mip_filter(mip_filter);
    for level in &sides[1..] {
        cube = cube.mip_level(level);
    }
    let d2 = made!(device.texture_2d(size, &image[0]), &image[1..]);
    let frame = TextureFrameHost {
        queries: device.buffer(queries).unwrap(),
        seen: seen.clone(),
        d1: made!(device.texture_1d(WIDTH, &row[0]), &row[1..]).build().unwrap(),
        d2: if srgb { d2.srgb() } else { d2 }.build().unwrap(),
        two: made!(device.texture_2d(size, &two[0]), &two[1..]).build().unwrap(),
        one: made!(device.texture_2d(size, &one[0]), &one[1..]).build().unwrap(),
        d3: made!(device.texture_3d([WIDTH, HEIGHT, DEPTH], &volume[0]), &volume[1..]).build().unwrap(),
        array: made!(device.texture_2d_array(size, DEPTH, &layers[0]), &layers[1..]).build().unwrap(),
        cube: cube.build().unwrap(),
    };
    let scene = Scene::<Textures>::new(device);
    let pipeline = Pipeline::for_scene(&scene).ptx(PTX).build().unwrap();
    pipeline.launch(&frame, [queries.len() as u32, 1, 1]).unwrap().wait().unwrap();
    seen.read().unwrap()
}

/// Lookups near texels' middles and edges, between, far outside.
fn queries(count: u32, normalized: bool, how: u32) -> Vec<Query> {
    let mut rng = Pcg32::new(3, u64::from(how));
    let mut coordinate = |size: u32| {
        let size = size as f32;
        let texels = match rng.next_u32() % 8 {
            0 => (rng.next_u32() % (512 * size as u32)) as f32 / 512.0,
            1 => (rng.next_f32() * 6.0 - 3.0) * size,
            2 => ((rng.next_u32() % (4 * size as u32)) as f32 - 2.0 * size).floor(),
            3 => (rng.next_f32() - 0.5) * 2e4,
            _ => rng.next_f32() * size,
        };
        if normalized { texels / size } else { texels }
    };
    let mut lookups: Vec<Query> = (0..count)
        .map(|_| Query {
            at: [coordinate(WIDTH), coordinate(HEIGHT), coordinate(DEPTH)],
            level: 0.0,
            steps: [[0.0; 3]; 2],
            layer: 0,
            how,
        })
        .collect();
    for query in &mut lookups {
        query.level = match rng.next_u32() % 3 {
            0 => (rng.next_u32() % 5) as f32 - 1.0,
            1 => (rng.next_u32() % 1024) as f32 / 256.0,
            _ => rng.next_f32() * 4.0 - 1.0,
        };
        query.steps = [(); 2].map(|()| [(); 3].map(|()| (rng.next_f32() - 0.5) * 0.5));
        query.layer = rng.next_u32() % (DEPTH + 2);
    }
    lookups
}

/// By texture: lookups that differ at all, and the largest difference.
type Differences = [(usize, f32); TEXTURES as usize];

fn differences(cpu: &[Vec4], gpu: &[Vec4]) -> Differences {
    let count = cpu.len() / TEXTURES as usize;
    core::array::from_fn(|texture| {
        let each = cpu.iter().zip(gpu).skip(texture * count).take(count);
        each.fold((0, 0.0f32), |(differ, most), (a, b)| {
            let difference = (*a - *b).abs().max_element();
            (differ + usize::from(a != b), if difference.is_nan() { f32::INFINITY } else { most.max(difference) })
        })
    })
}

/// The most that a lookup may differ by, texels being from -1 to 1. Weights are the same on both machines but for those of boxes,
/// cubes and between levels, which may be one or two 256ths off; sRGB has 8 bits on a GPU; a level by a gradient is approximate.
fn bound(format: Format, mode: Mode, texture: usize, how: u32) -> f32 {
    let range = if matches!(format, Format::Unorm8(_) | Format::Unorm16(_)) { 1.0 } else { 2.0 };
    let linear = mode.filter == FilterMode::Linear;
    let rounding: f32 = match format {
        Format::Float32(_) => 2.5e-7,
        // One step of the border, or of 16 bits.
        Format::Unorm8(_) => 1.001 / 255.0,
        Format::Snorm8(_) => 2.0 / 127.0,
        Format::Unorm16(_) => 1.6e-5,
        Format::Snorm16(_) => 1.3e-4,
    };
    let border = mode.address == AddressMode::Border && texture != 6;
    let exact = match format {
        Format::Float32(_) => rounding,
        _ if border => rounding,
        Format::Snorm8(_) if linear => rounding,
        _ => rounding.min(1.3e-4),
    };
    let weights = match texture {
        4 if linear => 2.0 / 256.0 * range,
        // Where a direction meets a face is rounded: a place may be a 256th off.
        6 if linear => 1.0 / 256.0 * range,
        _ => 0.0,
    };
    let levels = match (how, mode.mip_filter) {
        (0, _) => 0.0,
        (1, FilterMode::Linear) => {
            if linear {
                3.0 / 256.0 * range
            } else {
                1e-6
            }
        }
        (1, FilterMode::Point) => 0.0,
        // Half a level: where the two steps are askew a GPU looks at the ellipse that they span.
        (_, FilterMode::Linear) if texture == 6 => 0.7 * range,
        (_, FilterMode::Linear) => 0.55 * range,
        // Near the middle between two levels either is right.
        (_, FilterMode::Point) => range,
    };
    let srgb = if mode.srgb && texture == 1 { 3.0 / 256.0 } else { 0.0 };
    exact + weights + levels + srgb
}

fn modes() -> Vec<Mode> {
    use AddressMode::*;
    let mut modes = Vec::new();
    for address in [Wrap, Mirror, Clamp, Border] {
        for filter in [FilterMode::Point, FilterMode::Linear] {
            for mip_filter in [FilterMode::Point, FilterMode::Linear] {
                modes.push(Mode { address, filter, mip_filter, normalized: true, srgb: false });
            }
            if matches!(address, Clamp | Border) {
                let mip_filter = FilterMode::Point;
                modes.push(Mode { address, filter, mip_filter, normalized: false, srgb: false });
            }
        }
    }
    modes
}

/// Prints by how much lookups differ; how many of the modes and textures are out of bounds.
fn disagreements<F: Random<Texel = Vec4>>(devices: &[Device], modes: &[Mode]) -> usize {
    let [cpu, others @ ..] = devices else { return 0 };
    let mut outside = 0;
    let mut worst = [(0.0f32, 0.0f32); TEXTURES as usize];
    let (mut differ, mut all) = (0, 0);
    for &mode in modes {
        for how in 0..if mode.normalized { 3 } else { 1 } {
            let queries = queries(2_000, mode.normalized, how);
            let expected = look_up::<F>(cpu, mode, &queries);
            assert!(expected.iter().all(|v| v.is_finite()));
            for device in others {
                let seen = look_up::<F>(device, mode, &queries);
                for (texture, (count, most)) in differences(&expected, &seen).into_iter().enumerate() {
                    let bound = bound(F::FORMAT, mode, texture, how);
                    let name = NAMES[texture];
                    if most > bound {
                        println!("  {:?} {mode:?} {name}, by {how}: {most} > {bound}", F::FORMAT);
                        outside += 1;
                    }
                    if how < 2 {
                        worst[texture].0 = worst[texture].0.max(most);
                        worst[texture].1 = worst[texture].1.max(most / bound);
                        differ += count;
                        all += queries.len();
                    }
                }
            }
        }
    }
    if others.is_empty() {
        return 0;
    }
    for (name, (most, share)) in NAMES.iter().zip(worst) {
        println!("  {:?} {name}: at most {most:.2e}, {share:.2} of the bound", F::FORMAT);
    }
    println!("  {:?}: {differ} of {all} lookups differ at all", F::FORMAT);
    outside
}

#[test]
fn both_machines_see_the_same() {
    let devices = devices::all("both_machines_see_the_same");
    println!("lookups on {}:", devices.iter().map(Device::description).collect::<Vec<_>>().join(" and on "));
    let srgb: Vec<Mode> = modes().into_iter().map(|mode| Mode { srgb: true, ..mode }).collect();
    let outside = disagreements::<[f32; 4]>(&devices, &modes())
        + disagreements::<[u8; 4]>(&devices, &modes())
        + disagreements::<[u8; 4]>(&devices, &srgb)
        + disagreements::<[i8; 4]>(&devices, &modes())
        + disagreements::<[u16; 4]>(&devices, &modes())
        + disagreements::<[i16; 4]>(&devices, &modes());
    assert_eq!(outside, 0);
}
