//! Rates of the CPU's traversal in rays per second, against Embree 3 (single-ray, robust) where its library is installed.
//!
//! `cargo bench -p optix-tests --bench kernel [-- FILTER]`. Criterion gives each contestant's time and rate with its
//! spread. A contestant other than ours takes turns of a millisecond with ours, so that other load on the machine meets
//! both alike; printed after it are the rates of the two by each turn's least time, their ratio, and the median and range
//! of the ratio over criterion's samples. The meshes are generated and, where it is there, the Stanford bunny.

#[path = "kernel/embree.rs"]
mod embree;
#[path = "kernel/scene.rs"]
mod scene;

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, Throughput};
use optix_host::cpu::traversal::{
    Accel, AnyHit, Candidate, Gas, PrimitiveContext, Programs, RayQuery, Reporter, ray_flags, trace, trace_portable,
};
use optix_host::geometry::{BuildInput, GeometryFlags, Records, TriangleArray};
use optix_tests::meshes;
use rayon::prelude::*;
use scene::{Mesh, Rays};

/// No programs: all geometry is opaque.
struct Opaque;

impl Programs for Opaque {
    fn any_hit(&mut self, _: &Candidate<'_>) -> AnyHit {
        AnyHit::Accept
    }

    fn intersect(&mut self, _: &PrimitiveContext<'_>, _: &mut Reporter<'_, '_>) {}
}

/// Rays that each contestant traces in its turn: a millisecond or two.
const TURN: usize = 4096;

fn main() {
    let mut criterion = Criterion::default()
        .sample_size(15)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2))
        .without_plots()
        .configure_from_args();
    let embree = embree::Embree::load();
    match &embree {
        Ok(_) => println!("Embree 3: rtcIntersect1/rtcOccluded1, RTC_SCENE_FLAG_ROBUST"),
        Err(why) => println!("Embree 3 was not there ({why}); rates stand alone"),
    }
    let mut meshes = vec![scene::bumpy_sphere(187, 187)];
    meshes.extend(meshes::real().into_iter().filter(|mesh| mesh.name == "stanford-bunny").map(Mesh::from));
    for mesh in meshes {
        let begin = Instant::now();
        let accel = build(&mesh);
        let built = begin.elapsed();
        let begin = Instant::now();
        let other = embree.as_ref().ok().map(|e| e.scene(&mesh));
        println!(
            "\n{}: {} triangles, built in {:.0} ms (Embree {:.0} ms), {:.1} MB",
            mesh.name,
            mesh.indices.len(),
            built.as_secs_f64() * 1e3,
            begin.elapsed().as_secs_f64() * 1e3,
            accel.memory_bytes() as f64 / 1e6
        );
        let closest =
            |ray: &RayQuery| trace(Some(&accel), ray, &mut Opaque).map(|hit| (hit.t, hit.triangle_vertices()));
        for rays in scene::ray_sets(&mesh, &closest) {
            for threads in [1, rayon::current_num_threads()] {
                compare(&mut criterion, &mesh.name, &accel, other.as_ref(), &rays, threads);
            }
        }
    }
    criterion.final_summary();
}

fn build(mesh: &Mesh) -> Accel {
    let array = TriangleArray::new(mesh.vertices.clone(), Some(mesh.indices.clone())).expect("a valid mesh");
    let input =
        BuildInput::new(array, Records::one(GeometryFlags::DISABLE_ANYHIT)).expect("a record for all triangles");
    Gas::new(vec![input]).expect("no more triangles than a GAS has").into()
}

/// A contestant: traces one ray, and gives the distance of its hit.
type One<'a> = &'a (dyn Fn(&RayQuery) -> Option<f32> + Sync);

/// Seconds that `threads` threads take to trace `rays`.
fn seconds(rays: &[RayQuery], threads: usize, one: impl Fn(&RayQuery) -> Option<f32> + Sync) -> f64 {
    let part = |rays: &[RayQuery]| {
        for ray in rays {
            black_box(one(ray));
        }
    };
    let begin = Instant::now();
    if threads == 1 {
        part(rays)
    } else {
        rays.par_chunks(512).for_each(part)
    }
    begin.elapsed().as_secs_f64()
}

fn compare(
    criterion: &mut Criterion,
    mesh: &str,
    accel: &Accel,
    other: Option<&embree::Scene<'_>>,
    rays: &Rays,
    threads: usize,
) {
    let flags = if rays.occlusion { ray_flags::TERMINATE_ON_FIRST_HIT } else { ray_flags::NONE };
    let queries: Vec<RayQuery> = rays.rays.iter().map(|r| RayQuery { flags, ..*r }).collect();
    let ours = |ray: &RayQuery| trace(Some(accel), ray, &mut Opaque).map(|hit| hit.t);
    let portable = |ray: &RayQuery| trace_portable(Some(accel), ray, &mut Opaque).map(|hit| hit.t);
    for ray in &queries {
        assert_eq!(ours(ray), portable(ray), "the instruction sets disagree");
    }
    let time_ours = |part: &[RayQuery]| seconds(part, threads, ours);

    let plural = if threads == 1 { "" } else { "s" };
    let mut group = criterion.benchmark_group(format!("{mesh}/{}/{threads} thread{plural}", rays.name));
    group.throughput(Throughput::Elements(queries.len() as u64));
    group.bench_function("ours", |b| {
        b.iter_custom(|iters| (0..iters).map(|_| Duration::from_secs_f64(time_ours(&queries))).sum())
    });
    let mut versus = |name: &str, time_theirs: &dyn Fn(&[RayQuery]) -> f64| {
        let mut turns = Turns::new(queries.chunks(TURN * threads).collect());
        group.bench_function(name, |b| b.iter_custom(|iters| turns.take(iters, &time_ours, time_theirs)));
        turns.print(name);
    };
    versus("portable", &|part| seconds(part, threads, portable));
    if let Some(scene) = other {
        if rays.occlusion {
            versus("Embree", &|part| seconds(part, threads, |ray| scene.occluded(ray).then_some(0.0)));
        } else {
            versus("Embree", &|part| seconds(part, threads, |ray| scene.intersect(ray)));
        }
        let hits = |one: One<'_>| queries.iter().filter(|ray| one(ray).is_some()).count();
        let (mine, theirs) = (hits(&ours), hits(&|ray| scene.intersect(ray)));
        println!(
            "    hits {:.1} %, {} of {} rays differ",
            percent(mine, &queries),
            mine.abs_diff(theirs),
            queries.len()
        );
    }
    group.finish();
}

fn percent(part: usize, of: &[RayQuery]) -> f64 {
    100.0 * part as f64 / of.len() as f64
}

/// Times of ours and of another contestant, which trace the same rays in turns.
struct Turns<'a> {
    parts: Vec<&'a [RayQuery]>,
    /// Each part's least seconds, ours and theirs.
    least: Vec<[f64; 2]>,
    /// Theirs over ours, of each of criterion's samples.
    ratios: Vec<f64>,
}

impl<'a> Turns<'a> {
    fn new(parts: Vec<&'a [RayQuery]>) -> Self {
        Self { least: vec![[f64::INFINITY; 2]; parts.len()], parts, ratios: Vec::new() }
    }

    /// Traces all parts `iters` times with both, and gives the other's time.
    fn take(&mut self, iters: u64, ours: &dyn Fn(&[RayQuery]) -> f64, theirs: &dyn Fn(&[RayQuery]) -> f64) -> Duration {
        let mut total = [0.0; 2];
        for _ in 0..iters {
            for (part, least) in self.parts.iter().zip(&mut self.least) {
                for (i, seconds) in [ours(part), theirs(part)].into_iter().enumerate() {
                    least[i] = least[i].min(seconds);
                    total[i] += seconds;
                }
            }
        }
        self.ratios.push(total[1] / total[0]);
        Duration::from_secs_f64(total[1])
    }

    /// Prints nothing where criterion's filter left the contestant out.
    fn print(&mut self, name: &str) {
        self.ratios.sort_by(f64::total_cmp);
        let [Some(low), Some(high)] = [self.ratios.first(), self.ratios.last()] else { return };
        let median = self.ratios[self.ratios.len() / 2];
        let count = self.parts.iter().map(|part| part.len()).sum::<usize>() as f64;
        let [ours, theirs] = [0, 1].map(|i| count / self.least.iter().map(|part| part[i]).sum::<f64>() * 1e-6);
        println!(
            "    ours / {name} by least times {ours:.2} / {theirs:.2} Mray/s = {:.2}; median {median:.2} [{low:.2}, {high:.2}]",
            ours / theirs
        );
    }
}
