//! Rates of the CPU kernel in rays per second, against Embree 3 (single-ray, robust) where its library is installed.
//!
//! `cargo bench -p optix-host --bench kernel [-- FILTER]`. Both trace the same rays in the same run, in turns; of the
//! repeats the best rate is printed, and the median and range of the ratio of each pair. `MESH=file.obj` adds a mesh.

#[allow(dead_code, reason = "the executor uses more of the kernel than this bench")]
#[path = "../src/cpu/kernel/mod.rs"]
mod kernel;

#[path = "kernel/embree.rs"]
mod embree;
#[path = "kernel/scene.rs"]
mod scene;

use std::hint::black_box;
use std::time::Instant;

use kernel::{
    Accel, AnyHit, Candidate, Gas, GeometryFlags, Portable, Programs, RayQuery, Reporter, SbtMapping, Site,
    TriangleInput, ray_flags, trace, trace_with,
};
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

const REPEATS: usize = 9;
const CHUNK: usize = 1024;

fn main() {
    let filter = std::env::args().skip(1).find(|a| !a.starts_with('-')).unwrap_or_default();
    let embree = embree::Embree::load();
    match &embree {
        Ok(_) => println!("Embree 3: rtcIntersect1/rtcOccluded1, RTC_SCENE_FLAG_ROBUST"),
        Err(why) => println!("Embree 3 was not there ({why}); rates stand alone"),
    }
    let mut meshes = vec![scene::bumpy_sphere(187, 187)];
    for file in std::env::var("MESH").ok().into_iter().chain(["/work/shared/data/stanford-bunny.obj".into()]) {
        meshes.extend(scene::load_obj(&file));
    }
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
            "{:30} {:>9} {:>9} {:>9}   ours/Embree: median [min, max]",
            "Mray/s, best of repeats", "ours", "portable", "Embree"
        );
        for rays in scene::ray_sets(&mesh, &|ray| trace(Some(&accel), ray, &mut Opaque).map(|hit| (hit.t, hit.triangle_vertices()))) {
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

/// Traces all rays and gives seconds, number of hits and sum of distances.
fn run(rays: &[RayQuery], threads: usize, one: impl Fn(&RayQuery) -> Option<f32> + Sync) -> (f64, usize, f64) {
    let chunk = |rays: &[RayQuery]| {
        rays.iter().fold((0, 0.0), |(hits, sum), ray| match black_box(one(ray)) {
            Some(t) => (hits + 1, sum + f64::from(t)),
            None => (hits, sum),
        })
    };
    let begin = Instant::now();
    let (hits, sum) = if threads == 1 {
        chunk(rays)
    } else {
        rays.par_chunks(CHUNK).map(chunk).reduce(|| (0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1))
    };
    (begin.elapsed().as_secs_f64(), hits, sum)
}

fn compare(label: &str, accel: &Accel, other: Option<&embree::Scene<'_>>, rays: &Rays, threads: usize) {
    let occlusion = rays.occlusion;
    let queries: Vec<RayQuery> = rays
        .rays
        .iter()
        .map(|r| RayQuery { flags: if occlusion { ray_flags::TERMINATE_ON_FIRST_HIT } else { 0 }, ..*r })
        .collect();
    let count = queries.len() as f64;
    let (mut best, mut ratios) = ([f64::INFINITY; 3], Vec::new());
    let mut hits = [0; 3];
    for _ in 0..REPEATS {
        let ours = run(&queries, threads, |ray| trace(Some(accel), ray, &mut Opaque).map(|hit| hit.t));
        let portable = run(&queries, threads, |ray| trace_with(Portable, Some(accel), ray, &mut Opaque).map(|h| h.t));
        let mut runs = vec![ours, portable];
        if let Some(scene) = other {
            let theirs = if occlusion {
                run(&queries, threads, |ray| scene.occluded(ray).then_some(0.0))
            } else {
                run(&queries, threads, |ray| scene.intersect(ray))
            };
            ratios.push(theirs.0 / ours.0);
            runs.push(theirs);
        }
        for (i, run) in runs.iter().enumerate() {
            best[i] = best[i].min(run.0);
            hits[i] = run.1;
        }
        assert_eq!((ours.1, ours.2), (portable.1, portable.2), "the instruction sets disagree");
    }
    ratios.sort_by(f64::total_cmp);
    let rate = |i: usize| count / best[i] * 1e-6;
    print!("{label:30} {:9.2} {:9.2}", rate(0), rate(1));
    if let (Some(low), Some(high)) = (ratios.first(), ratios.last()) {
        let differ = hits[0].abs_diff(hits[2]);
        print!(" {:9.2}   {:.2} [{low:.2}, {high:.2}]", rate(2), ratios[ratios.len() / 2]);
        print!("   hits {:.1} %, {differ} of {count} differ", 100.0 * hits[0] as f64 / count);
    }
    println!();
}
