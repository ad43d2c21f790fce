//! The kernel against textbook intersection in double precision, one primitive after the other.

use glam::DVec3;
use softbox::bvh::BvhSettings;
use softbox::geometry::{Aggregate, Shapes, Sphere};
use softbox::math::Ray;

use crate::scenes;

/// Möller and Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection".
fn triangle([a, b, c]: [DVec3; 3], o: DVec3, d: DVec3) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let p = d.cross(ac);
    let det = ab.dot(p);
    let u = (o - a).dot(p) / det;
    let q = (o - a).cross(ab);
    let v = d.dot(q) / det;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| ac.dot(q) / det)
}

fn sphere(sphere: &Sphere, o: DVec3, d: DVec3) -> [f64; 2] {
    let o = o - sphere.center.as_dvec3();
    let (a, b) = (d.dot(d), o.dot(d));
    let root = (b * b - a * (o.dot(o) - f64::from(sphere.radius).powi(2))).sqrt();
    [(-b - root) / a, (-b + root) / a]
}

/// Parameter and id of the closest hit.
fn closest(shapes: &Shapes, ray: &Ray) -> Option<(f64, u32)> {
    let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let triangles = (0..shapes.triangles.len()).map(|i| {
        triangle(shapes.vertices(i).map(|v| v.as_dvec3()), o, d)
            .into_iter()
            .collect()
    });
    let spheres = shapes.spheres.iter().map(|s| sphere(s, o, d).to_vec());
    (0..)
        .zip(triangles.chain(spheres))
        .flat_map(|(id, ts): (u32, Vec<f64>)| ts.into_iter().map(move |t| (t, id)))
        .filter(|(t, _)| *t > f64::from(ray.t_min) && *t < f64::from(ray.t_max))
        .min_by(|a, b| a.0.total_cmp(&b.0))
}

#[test]
fn hits_agree_with_textbook_formulas_in_double_precision() {
    let shapes = scenes::mixed(200);
    for (_, aggregate) in scenes::aggregates(&shapes, BvhSettings::default()) {
        agree(&shapes, &aggregate);
    }
}

fn agree(shapes: &Shapes, aggregate: &Aggregate) {
    let (mut hits, mut different) = (0, 0);
    let rays = scenes::random_rays(20_000, 21);
    for (ray, hit) in rays.iter().zip(scenes::closest(aggregate, &rays)) {
        let want = closest(shapes, ray);
        hits += usize::from(want.is_some());
        let same = match want {
            None => hit.is_miss(),
            Some((t, id)) => hit.primitive == id && (f64::from(hit.t) - t).abs() < 1e-5 * (1.0 + t),
        };
        different += usize::from(!same);
        if let Some(sphere) = shapes.sphere(hit.primitive) {
            let off = ray.at(hit.t).distance(sphere.center) - sphere.radius;
            assert!(off.abs() < 1e-5, "{ray:?} {hit:?}");
        } else if !hit.is_miss() {
            let [a, b, c] = shapes.vertices(hit.primitive as usize);
            let point = a * (1.0 - hit.b1 - hit.b2) + b * hit.b1 + c * hit.b2;
            assert!(point.distance(ray.at(hit.t)) < 1e-3, "{ray:?} {hit:?}");
        }
    }
    assert!(hits > 10_000, "only {hits} hits");
    // Single precision may decide otherwise within a rounding of an edge.
    assert!(different <= 3, "{different} of {hits}");
}
