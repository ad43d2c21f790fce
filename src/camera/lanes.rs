use super::RayCamera;
use crate::math::{DoubleLanes, Lanes, Vec3Lanes};

impl RayCamera {
    /// True when all rays start at one point, so that [`Self::directions_lanes`] applies.
    pub fn is_pinhole(&self) -> bool {
        self.lens_radius == 0.0
    }

    /// The directions of [`Self::generate_ray`] of a camera without a lens through eight positions,
    /// the same bits.
    #[inline(always)]
    pub fn directions_lanes<L: Lanes>(&self, [x, y]: [L; 2]) -> Vec3Lanes<L> {
        let number = |value: f64| L::Doubles::splat(value);
        let (one, two) = (number(1.0), number(2.0));
        let x = two * L::Doubles::widen(x) / number(self.width) - one;
        let y = one - two * L::Doubles::widen(y) / number(self.height);
        let (x, y) = (x * number(self.half_width), y * number(self.half_height));
        let (right, up, forward) = (self.right, self.up, self.forward);
        let direction = [
            number(right.x) * x + number(up.x) * y + number(forward.x),
            number(right.y) * x + number(up.y) * y + number(forward.y),
            number(right.z) * x + number(up.z) * y + number(forward.z),
        ];
        let [x, y, z] = Vec3Lanes::<L>::unit_or(direction, [0.0, 0.0, -1.0]);
        Vec3Lanes::new(x.narrow(), y.narrow(), z.narrow())
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec2};

    use crate::camera::{Camera, RayCamera};
    use crate::math::{Isa, LaneKernel, Lanes, Normalization, ROW, Vec3Array, run_lanes};

    struct Directions<'a>(&'a RayCamera, [[f32; ROW]; 2]);

    impl LaneKernel for Directions<'_> {
        type Answer = Vec3Array;

        fn run<L: Lanes>(self) -> Vec3Array {
            let [x, y] = self.1;
            self.0
                .directions_lanes([L::load_row(&x), L::load_row(&y)])
                .store()
        }
    }

    #[test]
    fn lanes_are_single_rays() {
        let camera = Camera {
            eye: DVec3::new(0.3, -0.2, 2.0),
            ..Camera::default()
        };
        let camera = RayCamera::new(&camera, 201, 97, &Normalization::IDENTITY);
        for i in 0..500 {
            let x: [f32; ROW] = std::array::from_fn(|lane| i as f32 * 0.37 + lane as f32);
            let y = x.map(|x| 97.0 - 0.49 * x);
            for isa in Isa::available() {
                let lanes = run_lanes(isa, Directions(&camera, [x, y]));
                for lane in 0..8 {
                    let ray = camera.generate_ray(Vec2::new(x[lane], y[lane]), || Vec2::ZERO);
                    assert_eq!(lanes.get(lane), ray.direction);
                }
            }
        }
    }
}
