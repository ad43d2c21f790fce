//! Build time and rays per second on generated meshes, one thread, processor time.
//!
//! `cargo bench --bench rays [-- SCENE]`, where SCENE is part of a name. Every figure is the median
//! of several runs. Figures of different machines do not compare; those of one machine do.

use std::f32::consts::TAU;
use std::io::Write;
use std::time::Duration;

use glam::Vec3;
use rustix::time::{ClockId, clock_gettime};
use softbox::bvh::{BvhKind, BvhSettings};
use softbox::geometry::{Aggregate, Hit, Shapes, TraceCounts};
use softbox::math::{Frame, Ray};

const RUNS: usize = 5;
const RAYS: usize = 1 << 17;
const BATCH: usize = 2048;

fn main() -> std::io::Result<()> {
    // `cargo test --all-targets` runs this program without the flag.
    if !std::env::args().any(|a| a == "--bench") {
        return Ok(());
    }
    let mut out = std::io::stdout().lock();
    let wanted = std::env::args().skip(1).find(|a| !a.starts_with('-'));
    writeln!(
        out,
        "scene        kind    leaf |  build s   Mtri/s  nodes  depth   SAH | Mray/s: primary  bounce  shadow"
    )?;
    for (name, shapes) in [
        ("box 36", room(Shapes::default())),
        ("sphere 10k", room(sphere(72))),
        ("knot 70k", room(knot(700, 50))),
        ("sphere 1M", room(sphere(708))),
    ] {
        if wanted.as_ref().is_some_and(|w| !name.contains(w.as_str())) {
            continue;
        }
        for (kind, leaf_size) in [(BvhKind::Sah, 4), (BvhKind::Sah, 8), (BvhKind::Median, 4)] {
            report(
                &mut out,
                name,
                &shapes,
                BvhSettings {
                    kind,
                    leaf_size,
                    ..BvhSettings::default()
                },
            )?;
        }
    }
    Ok(())
}

fn report(
    out: &mut impl Write,
    name: &str,
    shapes: &Shapes,
    settings: BvhSettings,
) -> std::io::Result<()> {
    let builds = if shapes.len() > 200_000 { 1 } else { RUNS };
    let one = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .expect("a thread");
    let mut built = None;
    let build = median(builds, || {
        let shapes = shapes.clone();
        process_time(|| built = Some(one.install(|| Aggregate::build(shapes, settings))))
    });
    let aggregate = built.expect("built at least once");
    let stats = aggregate.stats();
    let primary = primary();
    let (bounce, shadow) = secondary(&aggregate, &primary);
    let rate = |rays: &[Ray], any: bool| {
        rays.len() as f64 / median(RUNS, || process_time(|| trace(&aggregate, rays, any))) / 1e6
    };
    writeln!(
        out,
        "{name:<12} {:<7} {:>4} | {build:8.3} {:8.2} {:6} {:6} {:5.1} | {:15.2} {:7.2} {:7.2}",
        format!("{:?}", settings.kind),
        settings.leaf_size,
        shapes.len() as f64 / build / 1e6,
        stats.nodes,
        stats.max_depth,
        stats.sah_cost,
        rate(&primary, false),
        rate(&bounce, false),
        rate(&shadow, true),
    )
}

fn trace(aggregate: &Aggregate, rays: &[Ray], any: bool) {
    let mut counts = TraceCounts::default();
    let mut hits = [Hit::MISS; BATCH];
    let mut occluded = [false; BATCH];
    for batch in rays.chunks(BATCH) {
        let n = batch.len();
        if any {
            aggregate.any_hit(batch, &mut occluded[..n], &mut counts);
        } else {
            aggregate.closest_hit(batch, &mut hits[..n], &mut counts);
        }
    }
    std::hint::black_box((counts, hits, occluded));
}

/// Seconds of this process's processor time that `work` takes.
fn process_time(work: impl FnOnce()) -> f64 {
    let now = || {
        let t = clock_gettime(ClockId::ProcessCPUTime);
        let seconds = u64::try_from(t.tv_sec).expect("time is positive");
        Duration::from_secs(seconds) + Duration::from_nanos(t.tv_nsec.unsigned_abs())
    };
    let start = now();
    work();
    (now() - start).as_secs_f64()
}

fn median(runs: usize, mut measure: impl FnMut() -> f64) -> f64 {
    let mut all: Vec<_> = (0..runs).map(|_| measure()).collect();
    all.sort_by(f64::total_cmp);
    all[runs / 2]
}

/// Rays of a camera in front of the room, in scan order.
fn primary() -> Vec<Ray> {
    let (width, height) = (512, RAYS / 512);
    (0..RAYS)
        .map(|i| {
            let x = (i % width) as f32 / width as f32 * 2.0 - 1.0;
            let y = (i / width) as f32 / height as f32 * 2.0 - 1.0;
            Ray::new(
                Vec3::Z * 5.0,
                Vec3::new(x * 0.45, -y * 0.45, -1.0).normalize(),
            )
        })
        .collect()
}

/// From every point that a primary ray hits: one diffuse ray, and one to a point of the ceiling.
fn secondary(aggregate: &Aggregate, primary: &[Ray]) -> (Vec<Ray>, Vec<Ray>) {
    let mut state = 1_u64;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1_u64 << 24) as f32
    };
    let mut rays = (Vec::new(), Vec::new());
    for ray in primary {
        let hit = aggregate.closest(ray);
        if hit.is_miss() {
            continue;
        }
        let [a, b, c] = aggregate.shapes().vertices(hit.primitive as usize);
        let normal = (b - a).cross(c - a).normalize();
        let normal = if normal.dot(ray.direction) > 0.0 {
            -normal
        } else {
            normal
        };
        let origin = ray.at(hit.t) + normal * 1e-4;
        let (radius, angle) = (random().sqrt(), TAU * random());
        let local = Vec3::new(
            radius * angle.cos(),
            radius * angle.sin(),
            (1.0 - radius * radius).max(0.0).sqrt(),
        );
        rays.0
            .push(Ray::new(origin, Frame::from_normal(normal).to_world(local)));
        let light = Vec3::new(random() - 0.5, 1.49, random() - 0.5);
        rays.1.push(Ray::segment(origin, light - origin, 0.9999));
    }
    rays
}

/// Puts `inner` in a box of five walls, the front open, with two blocks.
fn room(mut inner: Shapes) -> Shapes {
    add_box(&mut inner, Vec3::splat(-1.5), Vec3::splat(1.5), 10);
    if inner.triangles.len() < 100 {
        add_box(
            &mut inner,
            Vec3::new(-0.9, -1.5, -0.8),
            Vec3::new(-0.1, 0.5, 0.0),
            12,
        );
        add_box(
            &mut inner,
            Vec3::new(0.2, -1.5, 0.0),
            Vec3::new(0.9, -0.6, 0.7),
            12,
        );
    }
    inner
}

fn add_box(shapes: &mut Shapes, min: Vec3, max: Vec3, triangles: usize) {
    let first = shapes.positions.len() as u32;
    shapes.positions.extend((0..8).map(|i| {
        let pick = |bit: u32, lo: f32, hi: f32| if i >> bit & 1 == 1 { hi } else { lo };
        Vec3::new(
            pick(0, min.x, max.x),
            pick(1, min.y, max.y),
            pick(2, min.z, max.z),
        )
    }));
    // The front (largest z) comes last.
    let faces = [
        [0, 2, 3, 1],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [4, 5, 7, 6],
    ];
    let all = faces
        .iter()
        .flat_map(|&[a, b, c, d]: &[u32; 4]| [[a, b, c], [a, c, d]]);
    shapes
        .triangles
        .extend(all.take(triangles).map(|t| t.map(|i| i + first)));
}

/// A grid of `n` × `m` quads, closed in both directions, with `position(u, v)` for u, v in [0, 1).
fn torus_grid(n: usize, m: usize, position: impl Fn(f32, f32) -> Vec3) -> Shapes {
    let mut shapes = Shapes::default();
    for i in 0..n {
        for j in 0..m {
            shapes
                .positions
                .push(position(i as f32 / n as f32, j as f32 / m as f32));
            let at = |i: usize, j: usize| (i % n * m + j % m) as u32;
            let quad = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            shapes.triangles.push([quad[0], quad[1], quad[2]]);
            shapes.triangles.push([quad[0], quad[2], quad[3]]);
        }
    }
    shapes
}

/// A bumpy sphere of 2n² triangles.
fn sphere(n: usize) -> Shapes {
    torus_grid(n, n, |u, v| {
        let (theta, phi) = ((u * 0.998 + 0.001) * TAU / 2.0, v * TAU);
        let radius = 1.0 + 0.03 * (theta * 25.0).sin() * (phi * 25.0).sin();
        radius
            * Vec3::new(
                theta.sin() * phi.cos(),
                theta.cos(),
                theta.sin() * phi.sin(),
            )
    })
}

/// A tube along a knot.
fn knot(n: usize, m: usize) -> Shapes {
    let curve = |u: f32| {
        let (p, q) = (2.0 * u * TAU, 5.0 * u * TAU);
        0.45 * Vec3::new(
            (2.0 + q.cos()) * p.cos(),
            q.sin() * 1.6,
            (2.0 + q.cos()) * p.sin(),
        )
    };
    torus_grid(n, m, |u, v| {
        let forward = (curve(u + 1e-3) - curve(u)).normalize();
        let side = forward.cross(Vec3::Y).normalize();
        let up = side.cross(forward);
        let (sin, cos) = (v * TAU).sin_cos();
        curve(u) + 0.17 * (side * cos + up * sin)
    })
}
