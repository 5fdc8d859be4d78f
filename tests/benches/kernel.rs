//! Rates of the CPU kernel in rays per second, against Embree 3 (single-ray, robust) where its library is installed.
//!
//! `cargo bench -p optix-tests --bench kernel [-- FILTER]`. Both trace the same rays in the same run, in turns of a
//! millisecond. Printed are rates from each turn's least time over all repeats, their ratio, and the median and range of
//! each repeat's ratio. The meshes are generated and, where it is there, the Stanford bunny.

#[path = "kernel/embree.rs"]
mod embree;
#[path = "kernel/scene.rs"]
mod scene;

use std::hint::black_box;
use std::time::Instant;

use optix_host::cpu::kernel::{
    Accel, AnyHit, Candidate, Gas, GeometryFlags, Portable, Programs, RayQuery, Reporter, SbtMapping, Site,
    TriangleInput, ray_flags, trace, trace_with,
};
use optix_tests::meshes;
use rayon::prelude::*;
use scene::{Mesh, Rays};

/// No programs: all geometry is opaque.
struct Opaque;

impl Programs for Opaque {
    fn any_hit(&mut self, _: &Candidate<'_>) -> AnyHit {
        AnyHit::Accept
    }

    fn intersect(&mut self, _: &Site<'_>, _: &mut Reporter<'_, '_>) {}
}

const REPEATS: usize = 15;
/// Rays that each contestant traces in its turn: a millisecond or two.
const PART: usize = 4096;

fn main() {
    let filter = std::env::args().skip(1).find(|a| !a.starts_with('-')).unwrap_or_default();
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
        println!(
            "\n{}: {} triangles, built in {:.0} ms, {:.1} MB",
            mesh.name,
            mesh.indices.len(),
            built.as_secs_f64() * 1e3,
            accel.memory_bytes() as f64 / 1e6
        );
        let begin = Instant::now();
        let other = embree.as_ref().ok().map(|e| e.scene(&mesh));
        if other.is_some() {
            println!("  (Embree built in {:.0} ms)", begin.elapsed().as_secs_f64() * 1e3);
        }
        println!(
            "{:30} {:>9} {:>9} {:>9} {:>9} {:>9} [min, max] of ours/Embree",
            "Mray/s, least times", "ours", "portable", "Embree", "ratio", "median"
        );
        for rays in scene::ray_sets(&mesh, &|ray| {
            trace(Some(&accel), ray, &mut Opaque).map(|hit| (hit.t, hit.triangle_vertices()))
        }) {
            for threads in [1, rayon::current_num_threads()] {
                let label = format!("{}, {threads} thread{}", rays.name, if threads == 1 { "" } else { "s" });
                if label.contains(&filter) {
                    compare(&label, &accel, other.as_ref(), &rays, threads);
                }
            }
        }
    }
}

fn build(mesh: &Mesh) -> Accel {
    Gas::triangles(vec![TriangleInput {
        vertices: mesh.vertices.clone(),
        indices: Some(mesh.indices.clone()),
        sbt: SbtMapping::single(GeometryFlags { disable_anyhit: true, ..GeometryFlags::default() }),
        primitive_index_offset: 0,
    }])
    .expect("a valid mesh")
    .into()
}

/// Hits and the sum of their distances.
type Tally = (usize, f64);

/// Traces all rays and gives the seconds it took.
fn run(rays: &[RayQuery], threads: usize, one: impl Fn(&RayQuery) -> Option<f32> + Sync) -> (f64, Tally) {
    let part = |rays: &[RayQuery]| {
        rays.iter().fold((0, 0.0), |(hits, sum), ray| match black_box(one(ray)) {
            Some(t) => (hits + 1, sum + f64::from(t)),
            None => (hits, sum),
        })
    };
    let begin = Instant::now();
    let tally = if threads == 1 {
        part(rays)
    } else {
        rays.par_chunks(512).map(part).reduce(|| (0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1))
    };
    (begin.elapsed().as_secs_f64(), tally)
}

/// Traces `rays` with each contestant in turn, a small part at a time, so that other load on the machine meets all of
/// them alike. A rate is that of the sum of each part's least time over the repeats.
fn compare(label: &str, accel: &Accel, other: Option<&embree::Scene<'_>>, rays: &Rays, threads: usize) {
    let flags = if rays.occlusion { ray_flags::TERMINATE_ON_FIRST_HIT } else { ray_flags::NONE };
    let queries: Vec<RayQuery> = rays.rays.iter().map(|r| RayQuery { flags, ..*r }).collect();
    let parts: Vec<&[RayQuery]> = queries.chunks(PART * threads).collect();
    let mut least = vec![[f64::INFINITY; 3]; parts.len()];
    let mut ratios = Vec::new();
    let mut hits = [0; 3];
    for _ in 0..REPEATS {
        let mut total = [0.0; 3];
        hits = [0; 3];
        for (part, least) in parts.iter().zip(&mut least) {
            let ours = run(part, threads, |ray| trace(Some(accel), ray, &mut Opaque).map(|h| h.t));
            let theirs = other.map(|scene| {
                if rays.occlusion {
                    run(part, threads, |ray| scene.occluded(ray).then_some(0.0))
                } else {
                    run(part, threads, |ray| scene.intersect(ray))
                }
            });
            let portable = run(part, threads, |ray| trace_with(Portable, Some(accel), ray, &mut Opaque).map(|h| h.t));
            if threads == 1 {
                assert_eq!(ours.1, portable.1, "the instruction sets disagree");
            }
            for (i, run) in [Some(ours), Some(portable), theirs].into_iter().enumerate() {
                if let Some((seconds, tally)) = run {
                    least[i] = least[i].min(seconds);
                    total[i] += seconds;
                    hits[i] += tally.0;
                }
            }
        }
        ratios.push(total[2] / total[0]);
    }
    ratios.sort_by(f64::total_cmp);
    let count = queries.len() as f64;
    let rate = |i: usize| count / least.iter().map(|part| part[i]).sum::<f64>() * 1e-6;
    print!("{label:30} {:9.2} {:9.2}", rate(0), rate(1));
    if other.is_some() {
        let (low, median, high) = (ratios[0], ratios[REPEATS / 2], ratios[REPEATS - 1]);
        print!(" {:9.2} {:9.2} {median:9.2} [{low:.2}, {high:.2}]", rate(2), rate(0) / rate(2));
        print!("   hits {:.1} %, {} of {count} differ", 100.0 * hits[0] as f64 / count, hits[0].abs_diff(hits[2]));
    }
    println!();
}
