use glam::Vec3;

use super::{of_triangles, seen_from};
use crate::color::Rgb;
use crate::geometry::Shapes;
use crate::light::{AreaLight, AreaPart, Light, LightHit};

fn light_of(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> (Shapes, AreaLight) {
    let positions = positions.iter().map(|&p| p.into()).collect();
    let (shapes, shape) = of_triangles(positions, triangles);
    let light = AreaLight::new(&shapes, shape, Rgb::ONE, false);
    (shapes, light)
}

fn is_whole(light: &AreaLight, part: usize) -> bool {
    matches!(light.part(part), AreaPart::Parallelogram { .. })
}

const SLANTED: [[f32; 3]; 4] = [
    [0.1, 0.2, 0.3],
    [0.9, 0.3, 0.3],
    [1.1, 0.9, 0.5],
    [0.3, 0.8, 0.5],
];

/// However the two triangles begin, and though each has its own copies of the corners.
#[test]
fn two_triangles_are_one_parallelogram() {
    for (first, second) in [
        ([0, 1, 2], [0, 2, 3]),
        ([1, 2, 0], [3, 0, 2]),
        ([2, 3, 0], [1, 2, 0]),
        ([0, 1, 3], [1, 2, 3]),
    ] {
        let (_, light) = light_of(&SLANTED, &[first, second]);
        assert_eq!(light.part_count(), 1, "{first:?} {second:?}");
        assert!(is_whole(&light, 0));
        assert_eq!(
            [0, 1, 2].map(|id| light.part_of(id)),
            [Some(0), Some(0), None]
        );
        let copies: Vec<[f32; 3]> = [first, second]
            .concat()
            .into_iter()
            .map(|i: u32| SLANTED[i as usize])
            .collect();
        let (_, copied) = light_of(&copies, &[[0, 1, 2], [3, 4, 5]]);
        assert_eq!(copied.part_count(), 1);
        let (_, single) = light_of(&SLANTED, &[first]);
        assert!((light.area() / single.area() - 2.0).abs() < 1e-6);
    }
}

#[test]
fn what_is_no_parallelogram_stays_apart() {
    let mut bent = SLANTED;
    bent[3][2] += 1e-3;
    let mut kite = SLANTED;
    kite[3][0] -= 0.1;
    let cases: [(&[[f32; 3]], [u32; 3]); 5] = [
        // Reversed winding: the other side shines.
        (&SLANTED, [0, 3, 2]),
        (&bent, [0, 2, 3]),
        (&kite, [0, 2, 3]),
        // The same triangle twice, and one without area.
        (&SLANTED, [0, 1, 2]),
        (&SLANTED, [0, 2, 2]),
    ];
    for (positions, second) in cases {
        let (_, light) = light_of(positions, &[[0, 1, 2], second]);
        assert_eq!(light.part_count(), 2, "{second:?}");
        assert!(!is_whole(&light, 0) && !is_whole(&light, 1));
    }
}

/// A strip of three triangles makes one parallelogram and leaves one triangle; of a grid every cell
/// becomes a rectangle, though triangles of neighbouring cells make parallelograms too.
#[test]
fn strips_and_grids() {
    let strip = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [2.0, 1.0, 0.0],
    ];
    let (_, light) = light_of(&strip, &[[1, 4, 2], [0, 1, 2], [0, 2, 3]]);
    assert_eq!(light.part_count(), 2);

    let n = 4_u32;
    let positions: Vec<[f32; 3]> = (0..(n + 1) * (n + 1))
        .map(|i| {
            [
                (i % (n + 1)) as f32 / n as f32,
                0.0,
                (i / (n + 1)) as f32 / n as f32,
            ]
        })
        .collect();
    let triangles: Vec<[u32; 3]> = (0..n * n)
        .flat_map(|i| {
            let a = i / n * (n + 1) + i % n;
            let (b, c, d) = (a + 1, a + n + 2, a + n + 1);
            [[a, c, b], [a, d, c]]
        })
        .collect();
    let (_, light) = light_of(&positions, &triangles);
    assert_eq!(light.part_count(), (n * n) as usize);
    for index in 0..light.part_count() {
        let AreaPart::Parallelogram { edge_1, edge_2, .. } = light.part(index) else {
            panic!("part {index} is a triangle");
        };
        assert_eq!(edge_1.dot(edge_2), 0.0);
    }
    assert!((light.area() - 1.0).abs() < 1e-5);
}

/// Vertices that were rounded one by one far from the origin.
#[test]
fn rounded_corners_still_merge() {
    let (u, v) = (
        glam::DVec3::new(0.31, 0.02, -0.17),
        glam::DVec3::new(-0.05, 0.23, 0.11),
    );
    for i in 0..500 {
        let a = glam::DVec3::new(0.7, -0.8, 0.6) + f64::from(i) * 1e-3;
        let corners = [a, a + u, a + u + v, a + v].map(|p| p.as_vec3().to_array());
        assert_eq!(
            light_of(&corners, &[[0, 1, 2], [0, 2, 3]]).1.part_count(),
            1
        );
    }
}

/// Both triangles of a pair have the density of the whole, so that it has no seam at the diagonal.
#[test]
fn the_density_is_that_of_the_whole() {
    let (shapes, light) = light_of(&SLANTED, &[[0, 1, 2], [0, 2, 3]]);
    let [a, _, c, _] = SLANTED.map(Vec3::from);
    let normal = (Vec3::from(SLANTED[1]) - a).cross(c - a).normalize();
    let light = Light::Area(light);
    for distance in [0.05, 0.5, 3.0] {
        let from = seen_from(0.5 * (a + c) + normal * distance);
        let point = a + 0.4 * (c - a);
        let pdf = [0, 1].map(|primitive| {
            let segment = point - from.point;
            let hit = LightHit {
                point,
                normal,
                distance: segment.length(),
                primitive,
            };
            light.pdf(&shapes, &from, segment.normalize(), hit)
        });
        assert!(pdf[0] > 0.0);
        assert_eq!(pdf[0], pdf[1]);
    }
}
