//! Camera motion as pure functions: a gesture and a camera give the next camera.

use glam::{DQuat, DVec2, DVec3};
use softbox::camera::Camera;

/// The steepest angle between the view and the horizon.
const POLE: f64 = 89.5 / 180.0 * std::f64::consts::PI;
/// Turning per width of the view, as in the course: half a turn.
pub(super) const TURN_PER_VIEW: f64 = std::f64::consts::PI;

/// One movement of the hand over the picture. Lengths are fractions of the picture's height, x to
/// the right, y down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Gesture {
    /// Turntable about the target.
    Orbit(DVec2),
    /// The scene follows the hand in the plane of the target.
    Pan(DVec2),
    /// Towards (factor below 1) or away from `towards`, a point in file coordinates.
    Dolly {
        /// The point that keeps its place in the picture.
        towards: DVec3,
        /// Distance after over distance before.
        factor: f64,
    },
    /// Turns the head.
    Look(DVec2),
    /// Moves the eye: right, up and forward, in file units.
    Fly(DVec3),
    /// Looks at a point in file coordinates and turns about it from now on.
    Pivot(DVec3),
}

/// The camera after `gesture`, never closer than a hundred-thousandth of `scene_size` (file units)
/// to its target; `size` is the picture's in pixels. Returns the camera unchanged where the result would not be usable.
pub(super) fn apply(camera: &Camera, gesture: Gesture, scene_size: f64, size: [u32; 2]) -> Camera {
    let moved = match gesture {
        Gesture::Orbit(delta) => orbit(camera, delta),
        Gesture::Pan(delta) => pan(camera, delta, size),
        Gesture::Dolly { towards, factor } => dolly(camera, towards, factor),
        Gesture::Look(delta) => look(camera, delta),
        Gesture::Fly(motion) => fly(camera, motion),
        Gesture::Pivot(point) => Camera {
            target: point,
            ..*camera
        },
    };
    let distance = moved.eye.distance(moved.target);
    let limits = scene_size * 1e-5..scene_size * 1e4;
    if moved.is_valid() && limits.contains(&distance) {
        moved
    } else {
        *camera
    }
}

/// The camera in the same direction, with the box `min`..`max` inside a picture of
/// `size` pixels.
pub(super) fn frame(camera: &Camera, bounds: (DVec3, DVec3), size: [u32; 2]) -> Camera {
    let (min, max) = bounds;
    let center = min * 0.5 + max * 0.5;
    let radius = ((max - min).length() * 0.5).max(f64::MIN_POSITIVE);
    let (half_width, half_height) = camera.half_extent(size[0], size[1]);
    let half_angle = half_width.min(half_height).atan();
    let (.., back) = camera.basis();
    Camera {
        eye: center + back * (radius / half_angle.sin()),
        target: center,
        ..*camera
    }
}

fn vertical(camera: &Camera) -> DVec3 {
    camera.up.try_normalize().unwrap_or(DVec3::Y)
}

/// `direction` turned by `yaw` about `axis` and raised by `pitch`, short of the poles.
fn turned(direction: DVec3, axis: DVec3, yaw: f64, pitch: f64) -> DVec3 {
    let length = direction.length();
    let height = (direction.dot(axis) / length).clamp(-1.0, 1.0).asin();
    let level = (direction - axis * direction.dot(axis))
        .try_normalize()
        .unwrap_or_else(|| axis.any_orthonormal_vector());
    let level = DQuat::from_axis_angle(axis, yaw) * level;
    let height = (height + pitch).clamp(-POLE, POLE);
    (level * height.cos() + axis * height.sin()) * length
}

fn orbit(camera: &Camera, delta: DVec2) -> Camera {
    let offset = turned(
        camera.eye - camera.target,
        vertical(camera),
        -delta.x * TURN_PER_VIEW,
        delta.y * TURN_PER_VIEW,
    );
    Camera {
        eye: camera.target + offset,
        ..*camera
    }
}

fn look(camera: &Camera, delta: DVec2) -> Camera {
    let forward = turned(
        camera.target - camera.eye,
        vertical(camera),
        -delta.x * TURN_PER_VIEW * 0.5,
        -delta.y * TURN_PER_VIEW * 0.5,
    );
    Camera {
        target: camera.eye + forward,
        ..*camera
    }
}

fn pan(camera: &Camera, delta: DVec2, size: [u32; 2]) -> Camera {
    let (right, up, _) = camera.basis();
    let (_, half_height) = camera.half_extent(size[0], size[1]);
    let height = 2.0 * half_height * camera.eye.distance(camera.target);
    let shift = (up * delta.y - right * delta.x) * height;
    Camera {
        eye: camera.eye + shift,
        target: camera.target + shift,
        ..*camera
    }
}

fn dolly(camera: &Camera, towards: DVec3, factor: f64) -> Camera {
    let scaled = |point: DVec3| towards + (point - towards) * factor;
    Camera {
        eye: scaled(camera.eye),
        target: scaled(camera.target),
        ..*camera
    }
}

fn fly(camera: &Camera, motion: DVec3) -> Camera {
    let (right, up, back) = camera.basis();
    let shift = right * motion.x + up * motion.y - back * motion.z;
    Camera {
        eye: camera.eye + shift,
        target: camera.target + shift,
        ..*camera
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [800, 600];

    fn camera() -> Camera {
        Camera {
            eye: DVec3::new(0.0, 1.0, 5.0),
            target: DVec3::new(0.0, 1.0, 0.0),
            ..Camera::default()
        }
    }

    #[test]
    fn orbiting_over_the_pole_stops_short_of_it() {
        let mut moved = camera();
        for _ in 0..100 {
            moved = apply(&moved, Gesture::Orbit(DVec2::new(0.0, 0.1)), 1.0, SIZE);
        }
        let offset = moved.eye - moved.target;
        let height = (offset.y / offset.length()).asin().to_degrees();
        assert!((height - 89.5).abs() < 1e-6, "{height}");
        let back = apply(&moved, Gesture::Orbit(DVec2::new(0.0, -0.5)), 1.0, SIZE);
        assert!(back.eye.y < moved.eye.y && back.is_valid());
    }

    #[test]
    fn a_full_turn_comes_back() {
        let mut moved = camera();
        for _ in 0..8 {
            moved = apply(&moved, Gesture::Orbit(DVec2::new(0.25, 0.0)), 1.0, SIZE);
        }
        assert!(moved.eye.distance(camera().eye) < 1e-9);
    }

    #[test]
    fn panning_moves_the_target_under_the_hand() {
        let moved = apply(&camera(), Gesture::Pan(DVec2::new(0.0, 1.0)), 1.0, SIZE);
        // One picture height down at the target's distance: the old target is at the lower edge.
        let (_, half_height) = camera().half_extent(SIZE[0], SIZE[1]);
        assert!((moved.target.y - 1.0 - 2.0 * half_height * 5.0).abs() < 1e-9);
        assert_eq!(moved.eye - moved.target, camera().eye - camera().target);
    }

    #[test]
    fn dolly_keeps_the_point_in_its_place_and_stops_in_front_of_it() {
        let towards = DVec3::new(0.3, 0.8, 1.0);
        let mut moved = camera();
        let dolly = Gesture::Dolly {
            towards,
            factor: 0.5,
        };
        let direction = (towards - moved.eye).normalize();
        for _ in 0..200 {
            moved = apply(&moved, dolly, 1.0, SIZE);
            assert!((towards - moved.eye).normalize().distance(direction) < 1e-6);
        }
        assert!(moved.is_valid() && moved.eye.distance(moved.target) >= 1e-5);
    }

    #[test]
    fn looking_keeps_the_eye_and_flying_keeps_the_direction() {
        let looked = apply(&camera(), Gesture::Look(DVec2::new(0.2, 0.1)), 1.0, SIZE);
        assert_eq!(looked.eye, camera().eye);
        // To the right and down.
        assert!(looked.target.x > 0.0 && looked.target.y < 1.0);
        let flown = apply(
            &camera(),
            Gesture::Fly(DVec3::new(1.0, 2.0, 3.0)),
            1.0,
            SIZE,
        );
        assert_eq!(flown.eye, DVec3::new(1.0, 3.0, 2.0));
    }

    #[test]
    fn framing_brings_all_corners_into_the_picture() {
        let bounds = (DVec3::splat(-2.0), DVec3::new(3.0, 4.0, 5.0));
        let framed = frame(&camera(), bounds, SIZE);
        let (right, up, back) = framed.basis();
        let (half_width, half_height) = framed.half_extent(SIZE[0], SIZE[1]);
        for i in 0..8 {
            let pick = |bit: u32, a: f64, b: f64| if i & bit == 0 { a } else { b };
            let (a, b) = bounds;
            let corner = DVec3::new(pick(1, a.x, b.x), pick(2, a.y, b.y), pick(4, a.z, b.z));
            let seen = corner - framed.eye;
            let depth = -seen.dot(back);
            assert!(depth > 0.0);
            assert!((seen.dot(right) / depth).abs() <= half_width);
            assert!((seen.dot(up) / depth).abs() <= half_height);
        }
    }
}
