//! Meshes that are placed without being copied: the same hits as of copies, from every tree, and
//! every promise of the kernel inside of them.

use std::sync::Arc;

use glam::{DAffine3, DMat4, DQuat, DVec3, EulerRot, Vec3};
use softbox::bvh::{BvhKind, BvhSettings};
use softbox::geometry::{Aggregate, Hit, Placement, Shapes, TraceCounts};
use softbox::math::{Isa, Ray, offset_origin};

use crate::scenes::{self, Random, bits};
use crate::selfhit::{Start, Strays, leaving, weights};

fn placed(scale: DVec3, turn: [f64; 3], translation: DVec3) -> Placement {
    let turn = DQuat::from_euler(EulerRot::XYZ, turn[0], turn[1], turn[2]);
    let map = DMat4::from_scale_rotation_translation(scale, turn, translation);
    Placement::new(DAffine3::from_mat4(map)).expect("it has an inverse")
}

/// `n` places in the unit cube: turned, stretched, every third mirrored.
fn places(n: usize, size: f64, seed: u64) -> Vec<Placement> {
    let mut random = Random::new(seed);
    let mut vector = || random.in_cube().as_dvec3();
    (0..n)
        .map(|i| {
            let mut scale = (vector() * 0.4 + 1.0) * size;
            if i % 3 == 0 {
                scale.x = -scale.x;
            }
            placed(scale, (vector() * 3.0).to_array(), vector())
        })
        .collect()
}

/// The shapes, meshes and places of a scene.
struct Parts {
    own: Shapes,
    meshes: Vec<Shapes>,
    placed: Vec<(usize, Placement)>,
}

impl Parts {
    /// Some shapes, and two meshes of which one is a soup, many times, overlapping.
    fn new() -> Self {
        Self {
            own: scenes::mixed(30),
            meshes: vec![scenes::spiky_sphere(), scenes::random_soup(100, 0.5, 3)],
            placed: places(60, 0.3, 4)
                .into_iter()
                .enumerate()
                .map(|(i, place)| (i % 2, place))
                .collect(),
        }
    }

    fn build(&self, settings: BvhSettings, isa: Isa) -> Aggregate {
        let meshes: Vec<_> = self
            .meshes
            .iter()
            .map(|mesh| Arc::new(Aggregate::build(mesh.clone(), settings)))
            .collect();
        let placed = self.placed.iter();
        Aggregate::build(self.own.clone(), settings)
            .with_isa(isa)
            .with_instances(
                placed
                    .map(|(mesh, place)| (Arc::clone(&meshes[*mesh]), *place))
                    .collect(),
            )
    }

    /// Every triangle where it stands, in single precision; spheres come last.
    fn flattened(&self) -> Shapes {
        let mut shapes = self.own.clone();
        for (mesh, place) in &self.placed {
            let base = shapes.positions.len() as u32;
            let map = place.world_from_object();
            let mesh = &self.meshes[*mesh];
            let positions = mesh.positions.iter();
            shapes
                .positions
                .extend(positions.map(|p| map.transform_point3(p.as_dvec3()).as_vec3()));
            shapes
                .triangles
                .extend(mesh.triangles.iter().map(|&[a, b, c]| {
                    let (b, c) = if place.is_mirrored() { (c, b) } else { (b, c) };
                    [a + base, b + base, c + base]
                }));
        }
        shapes
    }
}

#[test]
fn instances_are_met_where_copies_are() {
    let parts = Parts::new();
    let shared = parts.build(BvhSettings::default(), Isa::best());
    let flat = Aggregate::build(parts.flattened(), BvhSettings::default());
    assert_eq!(shared.primitive_count(), flat.primitive_count());
    let rays = scenes::random_rays(40_000, 8);
    // The copies have ids before the spheres, instances after them.
    let (triangles, spheres) = (parts.own.triangles.len(), parts.own.spheres.len());
    let copy = |id: u32| match id as usize {
        id if id < triangles => id,
        id if id < triangles + spheres => id - triangles + flat.shapes().triangles.len(),
        id => id - spheres,
    };
    let (mut hits, mut different) = (0, 0);
    let answers = scenes::closest(&shared, &rays);
    for ((a, b), ray) in answers.iter().zip(scenes::closest(&flat, &rays)).zip(&rays) {
        if a.is_miss() || b.is_miss() {
            different += usize::from(a.is_miss() != b.is_miss());
            continue;
        }
        hits += 1;
        let is_same = copy(a.primitive) == b.primitive as usize
            && (a.t - b.t).abs() < 1e-4 * (1.0 + b.t)
            && (a.b1 - b.b1).abs() < 1e-2
            && (a.b2 - b.b2).abs() < 1e-2;
        different += usize::from(!is_same);
        if (a.primitive as usize) >= triangles + spheres {
            let point = shared.surface_point(a);
            assert!(point.point.distance(ray.at(a.t)) < 1e-3, "{a:?}");
            let flat = flat.surface_point(&Hit {
                primitive: copy(a.primitive) as u32,
                ..*a
            });
            assert!(point.point.distance(flat.point) < 1e-6);
            assert!(point.normal.dot(flat.normal) > 0.999);
        }
    }
    assert!(hits > 20_000, "only {hits}");
    assert!(different <= 20, "{different} of {hits}");
    let mut occluded = vec![false; rays.len()];
    shared.any_hit(&rays, &mut occluded, &mut TraceCounts::default());
    for (hit, occluded) in answers.iter().zip(occluded) {
        assert_eq!(hit.is_miss(), !occluded);
    }
}

#[test]
fn every_tree_and_batch_gives_the_hits_of_each_instance_alone() {
    let parts = Parts::new();
    let rays = scenes::random_rays(10_000, 9);
    let meshes: Vec<_> = (parts.meshes.iter())
        .map(|mesh| scenes::brute_force(mesh.clone()))
        .collect();
    let own = scenes::brute_force(parts.own.clone());
    let mut expected = scenes::closest(&own, &rays);
    let mut first = parts.own.len() as u32;
    for (mesh, place) in &parts.placed {
        let map = place.object_from_world();
        let inside = rays.iter().map(|ray| Ray {
            origin: map.transform_point3(ray.origin.as_dvec3()).as_vec3(),
            direction: map.transform_vector3(ray.direction.as_dvec3()).as_vec3(),
            ..*ray
        });
        let inside: Vec<_> = inside.collect();
        let hits = scenes::closest(&meshes[*mesh], &inside);
        for (best, mut hit) in expected.iter_mut().zip(hits) {
            if hit.t < best.t {
                hit.primitive += first;
                if place.is_mirrored() {
                    std::mem::swap(&mut hit.b1, &mut hit.b2);
                }
                *best = hit;
            }
        }
        first += parts.meshes[*mesh].len() as u32;
    }
    let expected: Vec<_> = expected.iter().map(bits).collect();
    for isa in Isa::available() {
        for (kind, leaf_size) in [
            (BvhKind::None, 1),
            (BvhKind::Median, 3),
            (BvhKind::Sah, 1),
            (BvhKind::Sah, 8),
        ] {
            let aggregate = parts.build(scenes::settings(kind, leaf_size), isa);
            let refined = aggregate.refined(&|_| std::ops::ControlFlow::Continue(()));
            for aggregate in [aggregate, refined.expect("nothing stops it")] {
                for batch in [1, 3, 100, rays.len()] {
                    let hits = rays
                        .chunks(batch)
                        .flat_map(|rays| scenes::closest(&aggregate, rays));
                    let hits: Vec<_> = hits.map(|hit| bits(&hit)).collect();
                    assert_eq!(hits, expected, "{isa} {kind:?} {leaf_size} {batch}");
                }
            }
        }
    }
}

#[test]
fn where_things_coincide_the_smaller_id_wins() {
    let sphere = scenes::smooth_sphere();
    let mesh = Arc::new(Aggregate::build(sphere.clone(), BvhSettings::default()));
    let here = Placement::new(DAffine3::IDENTITY).expect("it has an inverse");
    let thrice = vec![(Arc::clone(&mesh), here); 3];
    let rays = scenes::random_rays(5_000, 10);
    let alone = scenes::closest(&mesh, &rays);
    let beside = Aggregate::build(sphere, BvhSettings::default()).with_instances(thrice.clone());
    let hits = scenes::closest(&beside, &rays);
    assert!(hits.iter().map(bits).eq(alone.iter().map(bits)));
    let nothing = Aggregate::build(Shapes::default(), BvhSettings::default());
    let hits = scenes::closest(&nothing.with_instances(thrice), &rays);
    assert!(hits.iter().map(bits).eq(alone.iter().map(bits)));
}

/// Ten thousand rays from inside of a closed mesh to its edges and vertices.
#[test]
fn no_ray_leaves_a_closed_mesh_through_an_edge_or_vertex() {
    let mesh = Arc::new(Aggregate::build(
        scenes::spiky_sphere(),
        BvhSettings::default(),
    ));
    let mut random = Random::new(12);
    for (i, place) in places(40, 1.0, 11).into_iter().enumerate() {
        let size = 10.0_f64.powi(i as i32 % 7 - 3);
        let mut map = *place.world_from_object();
        map.matrix3 *= size;
        let place = Placement::new(map).expect("it has an inverse");
        let empty = Aggregate::build(Shapes::default(), BvhSettings::default());
        let aggregate = empty.with_instances(vec![(Arc::clone(&mesh), place)]);
        let rays: Vec<_> = (0..10_000)
            .map(|_| {
                let inside = map.transform_point3(random.in_cube().as_dvec3() * 0.1);
                let [a, b, _] = aggregate.vertices(random.below(mesh.shapes().len()) as u32);
                let target = a.lerp(
                    b,
                    f64::from(random.unit().min(random.unit() * 2.0)).min(1.0),
                );
                let origin = inside.as_vec3();
                Ray::new(origin, (target - origin.as_dvec3()).as_vec3())
            })
            .collect();
        let hits = scenes::closest(&aggregate, &rays);
        let escaped = hits.iter().filter(|hit| hit.is_miss()).count();
        assert_eq!(escaped, 0, "size {size}");
    }
}

/// G10 for instances: rays that leave stay on their side.
fn check_departures(name: &str, mesh: Shapes, place: Placement, n: usize) {
    let count = mesh.len();
    let mesh = Arc::new(Aggregate::build(mesh, BvhSettings::default()));
    let empty = Aggregate::build(Shapes::default(), BvhSettings::default());
    let aggregate = empty.with_instances(vec![(mesh, place)]);
    let mut random = Random::new(13);
    for start in [Start::Anywhere, Start::NearEdge, Start::Edge, Start::Corner] {
        let departures: Vec<_> = (0..n)
            .map(|_| {
                let primitive = random.below(count) as u32;
                let [_, b1, b2] = weights(&mut random, start);
                let hit = Hit {
                    t: 0.0,
                    primitive,
                    b1,
                    b2,
                };
                let at = aggregate.surface_point(&hit);
                let is_inside = random.unit() < 0.5;
                let side = if is_inside { -at.normal } else { at.normal };
                let direction = leaving(&mut random, side);
                let origin = offset_origin(at.departure, at.error, at.normal, direction);
                (primitive, is_inside, Ray::new(origin, direction))
            })
            .collect();
        let rays: Vec<_> = departures.iter().map(|(.., ray)| *ray).collect();
        let mut strays = Strays::default();
        for ((from, is_inside, ray), hit) in
            departures.iter().zip(scenes::closest(&aggregate, &rays))
        {
            if hit.is_miss() {
                strays.escapes += usize::from(*is_inside);
            } else if hit.primitive == *from {
                strays.self_hits += 1;
            } else {
                let met = aggregate.surface_point(&hit).normal;
                let from_inside = ray.direction.dot(met) > 0.0;
                strays.crossings += usize::from(from_inside != *is_inside);
            }
        }
        assert_eq!(strays, Strays::default(), "{name} {start:?}");
    }
}

#[test]
fn g10_rays_from_instances_of_closed_bodies_stay_on_their_side() {
    let turn = [0.3, 0.7, 1.1];
    for size in [1e-3, 1e-1, 1.0, 1e3] {
        for (name, stretch) in [
            ("as it is", DVec3::ONE),
            ("mirrored", DVec3::new(-1.0, 1.0, 1.0)),
            ("stretched", DVec3::new(0.3, 1.0, 2.0)),
            ("plate", DVec3::new(1.0, 0.1, 1.0)),
        ] {
            for (place, offset) in [("here", DVec3::ZERO), ("there", DVec3::new(0.7, -0.4, 0.9))] {
                let place_name = format!("cube {name} {place} size {size}");
                let at = placed(stretch * size, turn, offset);
                check_departures(&place_name, scenes::cube(), at, 20_000);
            }
        }
    }
    // The valleys of the spiky one are too narrow for the rounding of a place far from 0, in copies
    // too.
    for (name, mesh, offset) in [
        ("smooth", scenes::smooth_sphere(), 1.0),
        ("spiky", scenes::spiky_sphere(), 0.01),
    ] {
        let at = placed(DVec3::new(0.02, 0.03, -0.02), turn, DVec3::splat(offset));
        check_departures(name, mesh, at, 50_000);
    }
}

#[test]
fn ids_lead_to_the_instance_and_back() {
    let parts = Parts::new();
    let aggregate = parts.build(BvhSettings::default(), Isa::best());
    let instances = aggregate.instances().expect("there are some");
    assert_eq!(instances.meshes().len(), 2);
    assert!(
        aggregate
            .find_instance(parts.own.len() as u32 - 1)
            .is_none()
    );
    let mut next = parts.own.len() as u32;
    for (number, instance) in instances.list().iter().enumerate() {
        assert_eq!(instance.first_primitive(), next);
        let size = instance.mesh().shapes().len();
        assert_eq!(instances.find(next), Some((number, 0)));
        assert_eq!(
            instances.find(next + size as u32 - 1),
            Some((number, size - 1))
        );
        next += size as u32;
    }
    assert_eq!(instances.find(next), None);
    assert_eq!(aggregate.primitive_count(), next as usize);
    let own = parts.own.vertices(0).map(Vec3::as_dvec3);
    assert_eq!(aggregate.vertices(0), own);
}
