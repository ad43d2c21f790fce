use glam::{Vec2, Vec3};

use super::bundles::spheres;
use super::cells::{CellTable, LEVELS, key, width};
use super::{Guide, LOBES, Photon};
use crate::sampling::{PathSampler, Slot};

fn random(number: u32) -> Vec3 {
    let sampler = PathSampler::new(1, [number, 0], 0);
    let place = sampler.get_2d(0, Slot::Scatter);
    place.extend(sampler.get_1d(0, Slot::Lobe))
}

#[test]
fn the_table_finds_what_was_put_in_and_the_smallest_cell() {
    let mut table = CellTable::new();
    let places: Vec<Vec3> = (0..5000).map(|i| 2.0 * random(i) - 1.0).collect();
    let mut keys: Vec<u64> = (places.iter().step_by(2))
        .map(|&place| key(0, place, Vec3::Y))
        .collect();
    keys.sort_unstable();
    keys.dedup();
    for (&key, cell) in keys.iter().zip(0..) {
        table.insert(key, cell, false);
    }
    for &place in &places {
        let expected = keys.binary_search(&key(0, place, Vec3::Y)).ok();
        assert_eq!(table.find(place, Vec3::Y), expected.map(|cell| cell as u32));
        assert_eq!(table.find(place, Vec3::NEG_Y), None);
    }
    let (inner, outer) = (Vec3::new(0.31, 0.42, 0.53), Vec3::X);
    table.insert(key(0, inner, outer), 7000, true);
    table.insert(key(1, inner, outer), 7001, false);
    assert_eq!(table.find(inner, outer), Some(7001));
    let beside = (0..2000).map(|i| inner + width(0) * (random(i) - 0.5));
    let found: Vec<_> = beside.map(|place| table.find(place, outer)).collect();
    for cell in [None, Some(7000), Some(7001)] {
        assert!(found.contains(&cell), "{cell:?}");
    }
}

#[test]
fn all_that_was_seen_is_inside_some_lobe() {
    for count in [1, 2, 3, 10, 500] {
        let mut seen: Vec<(Vec3, f32)> = (0..count)
            .map(|i| (random(i) * Vec3::new(1.0, 0.2, 0.1), 1.0))
            .collect();
        let lobes = spheres(&mut seen, 0.1);
        assert!(lobes.len() <= LOBES && (count < 10 || lobes.len() == LOBES));
        let total: f32 = lobes.iter().map(|lobe| lobe.weight).sum();
        assert!((total - 1.0).abs() < 1e-5);
        for (place, _) in seen {
            let inside = |center: Vec3| place.distance_squared(center);
            assert!(
                lobes
                    .iter()
                    .any(|lobe| inside(lobe.center) <= lobe.radius2 * 1.000_01)
            );
        }
    }
    // All at one place: nothing to split.
    let mut same = vec![(Vec3::ONE, 2.0); 40];
    assert_eq!(spheres(&mut same, 0.1).len(), 1);
}

#[test]
fn rays_aim_at_what_was_seen_and_crowded_cells_are_smaller() {
    let photon = |i: u32| Photon {
        point: Vec3::new(0.4, -0.3, 0.2) + width(1) * random(i) * Vec3::new(1.0, 0.0, 1.0),
        normal: Vec3::Y,
        seen: Vec3::new(0.5, 0.5, 0.5) + 0.01 * random(i + 100_000),
        weight: 1e-3,
        shift: Vec3::ZERO,
    };
    let photons: Vec<Photon> = (0..2000).map(photon).collect();
    let guide = Guide::new(&photons, 1.0).expect("there are photons");
    assert!(guide.len() > 4 && !guide.is_empty());
    for photon in &photons {
        let lobes = guide
            .at(photon.point, photon.normal)
            .expect("a photon came here");
        let aimed = lobes.sample(photon.point, 0.5, Vec2::splat(0.5));
        assert!(aimed.angle_between(photon.seen - photon.point) < 0.2);
        assert!(lobes.share() > 0.0 && lobes.share() < 1.0);
    }
    assert!(Guide::new(&[], 1.0).is_none());
    assert!(width(LEVELS - 1) > 0.0);
}
