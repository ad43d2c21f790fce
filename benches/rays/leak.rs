//! Rays from inside a closed mesh at its vertices and edges: what finds nothing has leaked.

use std::io::{Result, Write};

use glam::Vec3;
use softbox::geometry::{Hit, Shapes};
use softbox::math::Ray;

use crate::ray_bench::mesh::{append, knot};
use crate::ray_bench::{Kind, Random, System};

/// Quads around the tube, and along it.
const AROUND: u32 = 70;
const ALONG: u32 = 500;

const RAYS: usize = 1_000_000;

/// Prints the leaks of every system, for the mesh at the origin and far from it.
pub(crate) fn report(out: &mut impl Write, systems: &[System]) -> Result<()> {
    let tube = knot(ALONG, AROUND, 0.0);
    for (place, offset) in [
        ("at the origin", Vec3::ZERO),
        ("1300 units away", Vec3::new(1000.0, 500.0, -700.0)),
    ] {
        let mut shapes = Shapes::default();
        append(&mut shapes, &tube, 1.0, offset);
        let rays = rays(&shapes);
        writeln!(
            out,
            "leaks per million rays at vertices and edges of a closed mesh of {} triangles {place}",
            shapes.triangles.len()
        )?;
        // Those that trace everything; a mode for some kinds would be nothing new.
        for system in systems.iter().filter(|s| s.kinds.contains(&Kind::Shadow0)) {
            let tracer = system.prepare(&shapes, 1)();
            let mut hits = vec![Hit::MISS; rays.len()];
            let mut occluded = vec![false; rays.len()];
            tracer.closest_hit(&rays, &mut hits);
            tracer.any_hit(&rays, &mut occluded);
            let closest = hits.iter().filter(|hit| hit.is_miss()).count();
            let any = occluded.iter().filter(|occluded| !**occluded).count();
            let per_million = |leaks: usize| leaks as f64 * 1e6 / rays.len() as f64;
            writeln!(
                out,
                "  {:<16} closest {:>9.0}  any {:>9.0}",
                system.name,
                per_million(closest),
                per_million(any)
            )?;
        }
    }
    Ok(())
}

/// From the middle of a ring of the tube to a vertex (one in four) or edge of a triangle beside it.
fn rays(shapes: &Shapes) -> Vec<Ray> {
    let mut random = Random::new(3);
    let mut below = |n: usize| (f64::from(random.unit()) * n as f64) as usize;
    let mut rays = Vec::with_capacity(RAYS);
    for i in 0..RAYS {
        let triangle = below(shapes.triangles.len());
        let around = AROUND as usize;
        let first = triangle / (2 * around) * around;
        let ring = &shapes.positions[first..first + around];
        let origin = ring.iter().sum::<Vec3>() / around as f32;
        let corners = shapes.vertices(triangle);
        let corner = below(3);
        let part = if i % 4 == 0 {
            0.0
        } else {
            below(1 << 20) as f32 / (1 << 20) as f32
        };
        let target = corners[corner].lerp(corners[(corner + 1) % 3], part);
        rays.push(Ray::new(origin, (target - origin).normalize()));
    }
    rays
}
