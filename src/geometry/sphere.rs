use glam::Vec3;

use crate::math::{Aabb, Ray, gamma};

/// An analytic sphere in scene space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre.
    pub center: Vec3,
    /// Radius, positive.
    pub radius: f32,
}

impl Sphere {
    /// Its box; [`Aabb::EMPTY`] if the radius is not positive or a number is not finite.
    pub fn bounds(&self) -> Aabb {
        if !(self.radius > 0.0 && self.radius.is_finite() && self.center.is_finite()) {
            return Aabb::EMPTY;
        }
        Aabb {
            min: self.center - self.radius,
            max: self.center + self.radius,
        }
    }

    /// The ray parameters at which the line of `ray` meets the sphere, in order; `None` if it does
    /// not. The ray's interval plays no part.
    ///
    /// The discriminant comes from the offset of the centre from the line, the smaller root from
    /// the product of both: Haines, Günther, Akenine-Möller 2019, "Precision Improvements for
    /// Ray/Sphere Intersection", Ray Tracing Gems, chapter 7. In double precision, because only
    /// spheres pay for it.
    pub fn meet(&self, ray: &Ray) -> Option<[f32; 2]> {
        let d = ray.direction.as_dvec3();
        let to_center = self.center.as_dvec3() - ray.origin.as_dvec3();
        let radius = f64::from(self.radius);
        let a = d.length_squared();
        let b = to_center.dot(d);
        let from_line = (to_center - d * (b / a)).length_squared();
        let discriminant = radius * radius - from_line;
        if !(discriminant >= 0.0 && a > 0.0) {
            return None;
        }
        let c = to_center.length_squared() - radius * radius;
        let q = b + (a * discriminant).sqrt().copysign(b);
        // q is zero only if the ray starts in the centre of a sphere without extent.
        let (t0, t1) = (c / q, q / a);
        (!t0.is_nan()).then(|| [t0.min(t1) as f32, t0.max(t1) as f32])
    }

    /// The point of the sphere nearest to `point` (other than the centre), and a bound of the
    /// absolute rounding error of each of its coordinates.
    pub fn point_and_error(&self, point: Vec3) -> (Vec3, Vec3) {
        let center = self.center.as_dvec3();
        let outward = (point.as_dvec3() - center).normalize_or_zero();
        let point = (center + outward * f64::from(self.radius)).as_vec3();
        // The radius counts too: the point may be exact where the test of a leaving ray is not.
        (point, (point.abs() + Vec3::splat(self.radius)) * gamma(2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_crossings_come_in_order_for_any_length_of_direction() {
        let sphere = Sphere {
            center: Vec3::new(1.0, 2.0, 3.0),
            radius: 0.5,
        };
        for scale in [1e-3_f32, 1.0, 1e3] {
            for side in [1.0, -1.0] {
                let ray = Ray::new(Vec3::new(1.0, 2.0, 0.0), Vec3::Z * (side * scale));
                let [near, far] = sphere.meet(&ray).expect("through the centre");
                let mut expected = [2.5 * side / scale, 3.5 * side / scale];
                expected.sort_by(f32::total_cmp);
                assert!((near / expected[0] - 1.0).abs() < 1e-6);
                assert!((far / expected[1] - 1.0).abs() < 1e-6);
            }
        }
    }

    /// Test G8 of the stress list: far away, the hit is still on the sphere.
    #[test]
    fn distant_spheres_keep_their_shape() {
        let sphere = Sphere {
            center: Vec3::new(0.3, -0.2, 0.1),
            radius: 1.0,
        };
        let mut worst = 0.0_f64;
        for i in 0..100_000 {
            let spin = i as f32 * 2.399_963;
            let height = 1.0 - 2.0 * (i as f32 + 0.5) / 100_000.0;
            let ring = (1.0 - height * height).sqrt();
            let from = Vec3::new(ring * spin.cos(), ring * spin.sin(), height);
            let side = from.cross(Vec3::new(0.3, 0.5, 0.8)).normalize();
            let distance = 10.0_f32.powi(1 + i % 5);
            // A third beyond the rim: the test must know which rays miss.
            let miss = i % 3 == 0;
            let aim = if miss {
                1.05
            } else {
                0.95 * (i % 97) as f32 / 97.0
            };
            let origin = sphere.center + from * distance;
            // Aimed in double precision, so that the direction is the only rounding.
            let target = sphere.center + side * aim;
            let direction = (target.as_dvec3() - origin.as_dvec3())
                .normalize()
                .as_vec3();
            let ray = Ray::new(origin, direction);
            let hit = sphere.meet(&ray);
            assert_eq!(hit.is_none(), miss, "at distance {distance}, aim {aim}");
            let Some([near, _]) = hit else { continue };
            let raw = ray.at(near).as_dvec3() - sphere.center.as_dvec3();
            assert!((raw.length() - 1.0).abs() < 2e-7 * f64::from(distance) + 1e-6);
            let (point, error) = sphere.point_and_error(ray.at(near));
            let off = (point.as_dvec3() - sphere.center.as_dvec3()).length() - 1.0;
            assert!(off.abs() <= f64::from(error.length()));
            worst = worst.max(off.abs());
        }
        assert!(worst < 1e-6, "{worst:e}");
    }

    #[test]
    fn a_sphere_without_size_has_no_box() {
        for radius in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            let center = Vec3::ONE;
            assert!(Sphere { center, radius }.bounds().is_empty());
        }
    }
}
