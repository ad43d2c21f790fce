use std::f64::consts::PI;

use glam::Vec3;

use super::{Aggregate, Shapes};

impl Aggregate {
    /// The end-point overlap of the hierarchy: the number of nodes and blocks that a ray which ends
    /// on a surface visits there without need, on average over `samples` points spread evenly over
    /// all surfaces. The same points every time; 0 if there are no surfaces.
    ///
    /// Aila, Karras, Laine 2013, "On Quality Metrics of Bounding Volume Hierarchies".
    pub fn end_point_overlap(&self, samples: usize) -> f64 {
        let shapes = self.shapes();
        let areas: Vec<f64> = (0..shapes.len() as u32)
            .map(|id| area(shapes, id))
            .collect();
        let total: f64 = areas.iter().sum();
        if !(total > 0.0 && total.is_finite()) || samples == 0 {
            return 0.0;
        }
        let (mut overlap, mut below, mut id) = (0, 0.0, 0);
        for sample in 0..samples {
            let at = (sample as f64 + 0.5) / samples as f64 * total;
            while id + 1 < areas.len() && below + areas[id] < at {
                below += areas[id];
                id += 1;
            }
            let point = point(shapes, id as u32, sample);
            overlap += self
                .bvh()
                .overlap_at(point, &|places| self.holds(places, id as u32));
        }
        overlap as f64 / samples as f64
    }
}

/// The area of a primitive; 0 if nothing can hit it.
fn area(shapes: &Shapes, id: u32) -> f64 {
    let area = match shapes.sphere(id) {
        Some(sphere) => 4.0 * PI * f64::from(sphere.radius).powi(2),
        None => {
            let [a, b, c] = shapes.vertices(id as usize).map(Vec3::as_dvec3);
            0.5 * (b - a).cross(c - a).length()
        }
    };
    if area.is_finite() { area } else { 0.0 }
}

/// Point number `sample` of a sequence on the surface of a primitive.
fn point(shapes: &Shapes, id: u32, sample: usize) -> Vec3 {
    // Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences".
    let part = |step: f64| ((sample as f64 * step) % 1.0) as f32;
    let (u, v) = (part(0.754_877_666_246_692_7), part(0.569_840_290_998_053_2));
    if let Some(sphere) = shapes.sphere(id) {
        let (sin, cos) = (2.0 * std::f32::consts::PI * u).sin_cos();
        let (z, ring) = (2.0 * v - 1.0, 2.0 * (v * (1.0 - v)).sqrt());
        return sphere.center + sphere.radius * Vec3::new(ring * cos, ring * sin, z);
    }
    let (u, v) = if u + v > 1.0 {
        (1.0 - u, 1.0 - v)
    } else {
        (u, v)
    };
    let [a, b, c] = shapes.vertices(id as usize);
    a * (1.0 - u - v) + b * u + c * v
}
