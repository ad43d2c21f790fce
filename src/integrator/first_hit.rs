//! Views that need only the first surface of each camera ray, and no light.

use glam::Vec2;

use crate::camera::RayCamera;
use crate::color::Rgb;
use crate::geometry::{Hit, TraceCounts};
use crate::math::Ray;
use crate::scene::PreparedScene;
use crate::settings::View;

/// What `view` shows where `position` (pixels, y down) of the picture looks: normals mapped to
/// 0.5 n + 0.5, albedo, or in all channels the distance in file units (infinite for a miss) or the
/// number of box and primitive tests. Lens and pixel filter play no part.
pub fn first_hit(scene: &PreparedScene, camera: &RayCamera, view: View, position: Vec2) -> Rgb {
    let ray: Ray = camera.generate_ray(position, || Vec2::ZERO);
    let mut hit = [Hit::MISS];
    let mut counts = TraceCounts::default();
    scene.aggregate().closest_hit(&[ray], &mut hit, &mut counts);
    let hit = hit[0];
    match view {
        View::Cost => Rgb::splat((counts.box_tests + counts.primitive_tests) as f32),
        View::Depth if hit.is_miss() => Rgb::INFINITY,
        View::Depth => Rgb::splat(scene.normalization().length_to_file(f64::from(hit.t)) as f32),
        _ if hit.is_miss() => Rgb::ZERO,
        View::Normals => 0.5 * scene.interaction(&ray, &hit).shading_normal + 0.5,
        View::GeometricNormals => 0.5 * scene.interaction(&ray, &hit).geometric_normal + 0.5,
        View::Albedo => scene.albedo(hit.primitive),
        View::Render | View::Samples | View::Noise => Rgb::ZERO,
    }
}
