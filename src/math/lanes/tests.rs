use glam::{DVec3, Vec3};

use super::{
    DoubleLanes, FrameLanes, IntLanes, LANES, LaneKernel, Lanes, ROW, Vec3Array, Vec3Lanes,
    offset_origin_lanes, run_lanes,
};
use crate::math::{Frame, Isa, Ray, offset_origin};

const ODD: [f32; ROW] = [
    0.0,
    -0.0,
    1.5,
    -7.25e-20,
    f32::INFINITY,
    f32::NAN,
    1e-42,
    -3e38,
    1.0,
    2.0,
    -3.0,
    0.1,
    1e30,
    f32::NEG_INFINITY,
    -0.0,
    5e-324_f64 as f32,
];
const EVEN: [f32; ROW] = [
    2.0,
    0.0,
    1.5,
    4.0,
    -1.0,
    1.0,
    1e-42,
    2.0,
    f32::NAN,
    -2.0,
    3.0,
    1e-3,
    1e30,
    0.0,
    7.0,
    -1.0,
];
const BITS: [u32; ROW] = [
    0,
    1,
    0x8000_0000,
    0xFFFF_FFFF,
    0x1234_5678,
    77,
    0x7FFF_FFFF,
    6,
    2,
    3,
    77,
    0xDEAD_BEEF,
    99,
    0x5555_5555,
    0xAAAA_AAAA,
    12,
];

/// The numbers of a row from `first` on, at the start of another.
fn from<T: Copy + Default>(row: &[T; ROW], first: usize) -> [T; ROW] {
    std::array::from_fn(|lane| row.get(first + lane).copied().unwrap_or_default())
}

/// What `part` gives for all parts of a row, put together.
fn row_by_row<L: Lanes>(part: impl Fn(usize) -> Vec<[u32; ROW]>) -> Vec<[u32; ROW]> {
    let mut whole = part(0);
    for first in (L::N..ROW).step_by(L::N) {
        for (row, rest) in whole.iter_mut().zip(part(first)) {
            row[first..first + L::N].copy_from_slice(&rest[..L::N]);
        }
    }
    whole
}

/// Every operation on one pair of rows, as bits.
struct All;

impl LaneKernel for All {
    type Answer = Vec<[u32; ROW]>;

    fn run<L: Lanes>(self) -> Self::Answer {
        row_by_row::<L>(all::<L>)
    }
}

fn all<L: Lanes>(first: usize) -> Vec<[u32; ROW]> {
    let (a, b) = (
        L::load_row(&from(&ODD, first)),
        L::load_row(&from(&EVEN, first)),
    );
    let (i, j) = (
        L::Ints::load(&from(&BITS, first)),
        L::Ints::splat(0x9E37_79B9),
    );
    let picked = |mask: L::Mask| L::select(mask, a, b);
    let mut numbers = vec![a + b, a - b, a * b, a / b, a.sqrt(), a.neg(), b.copysign(a)];
    numbers.extend([
        a.abs(),
        L::of_ints(i.shr::<1>()),
        L::from_ints(i),
        a.min(b),
        a.max(b),
    ]);
    numbers.extend([
        picked(a.lt(b)),
        picked(a.le(b)),
        picked(a.eq(b)),
        picked(a.gt(b)),
    ]);
    numbers.extend([
        L::alternate(a, b),
        L::repeat(&[ODD[3], ODD[4], ODD[5], EVEN[0]]),
    ]);
    numbers.push(picked(L::ints_eq(i, L::Ints::splat(77))));
    numbers.push(picked(L::mask_of_bits(0xA553 >> first)));
    numbers.push(picked(L::without(a.lt(b), a.lt(L::splat(0.0)))));
    let wide = L::Doubles::widen(a) / L::Doubles::splat(3.0) + L::Doubles::widen(b);
    numbers.extend([wide.narrow(), wide.sqrt().narrow()]);
    let v = Vec3Lanes::new(a, b, b);
    let w = Vec3Lanes::new(b, a, a);
    let unit = v.unit_cross(w);
    numbers.extend([unit.x, unit.y, unit.z, v.normalize_or(w).x]);
    let mut all: Vec<_> = numbers
        .into_iter()
        .map(|n| n.to_array().map(bits))
        .collect();
    let ints = [
        i + j,
        i * j,
        i & j,
        i | j,
        i ^ j,
        i.shl::<5>(),
        i.shr::<7>(),
        i.sar::<31>(),
    ];
    all.extend(ints.map(L::Ints::to_array));
    all.push(i.reverse_bits().to_array());
    all.push(L::select_ints(a.lt(b), i, j).to_array());
    assert_eq!(L::bits(L::mask_of_bits(0x53)), 0x53);
    assert_eq!(L::bits(L::mask_of_bits(L::ALL)), L::ALL);
    all
}

/// Rays in and out again.
struct Rays;

impl LaneKernel for Rays {
    type Answer = Vec<Ray>;

    fn run<L: Lanes>(self) -> Self::Answer {
        let given: [Ray; ROW] = std::array::from_fn(|lane| {
            let at = |i: usize| (10 * lane + i) as f32;
            let ray = Ray::new(
                Vec3::new(at(0), at(1), at(2)),
                Vec3::new(at(3), at(4), at(5)),
            );
            Ray {
                t_min: at(6),
                t_max: at(7),
                ..ray
            }
        });
        let numbers = L::of_rays(&given.each_ref());
        assert_eq!(numbers[4].to_array()[1], 14.0);
        let mut rays = [Ray::new(Vec3::ZERO, Vec3::ZERO); ROW];
        L::to_rays(numbers, &mut rays);
        assert_eq!(rays[..L::N], given[..L::N]);
        rays[..LANES].to_vec()
    }
}

/// The bits, the same for every NaN.
fn bits(value: f32) -> u32 {
    if value.is_nan() {
        f32::NAN.to_bits()
    } else {
        value.to_bits()
    }
}

#[test]
fn every_instruction_set_gives_the_same_bits() {
    let portable = run_lanes(Isa::Portable, All);
    for isa in Isa::available() {
        assert_eq!(run_lanes(isa, All), portable, "{isa}");
        assert_eq!(
            run_lanes(isa, Rays),
            run_lanes(Isa::Portable, Rays),
            "{isa}"
        );
    }
    let sums: [u32; ROW] = std::array::from_fn(|lane| bits(ODD[lane] + EVEN[lane]));
    let roots = ODD.map(|value| bits(value.sqrt()));
    assert_eq!((portable[0], portable[4]), (sums, roots));
    assert!(portable.contains(&BITS.map(u32::reverse_bits)));
}

/// Triangles of all shapes and sizes, some without area.
fn edges() -> impl Iterator<Item = Pairs> {
    let number = |i: u32| (i.wrapping_mul(0x9E37_79B9) >> 8) as f32 / 8_388_608.0 - 1.0;
    let vector = move |i: u32| Vec3::new(number(i), number(i + 1), number(i + 2));
    (0..200_u32).map(move |group| {
        std::array::from_fn(|lane| {
            let i = 100 * group + 10 * lane as u32;
            let (a, b) = (vector(i), vector(i + 5));
            match i % 3 {
                0 => (a, b),
                1 => (a, a * 3.0 + b * 1e-6),
                _ => (
                    a * 1e-20,
                    if i.is_multiple_of(7) {
                        Vec3::ZERO
                    } else {
                        b * 1e-20
                    },
                ),
            }
        })
    })
}

type Pairs = [(Vec3, Vec3); LANES];

/// The first and the second vectors of pairs.
fn loaded<L: Lanes>(pairs: &Pairs) -> (Vec3Lanes<L>, Vec3Lanes<L>) {
    let (mut a, mut b) = (Vec3Array::ZERO, Vec3Array::ZERO);
    for (lane, pair) in pairs.iter().enumerate() {
        a.set(lane, pair.0);
        b.set(lane, pair.1);
    }
    (Vec3Lanes::load(&a), Vec3Lanes::load(&b))
}

struct Units(Pairs);

impl LaneKernel for Units {
    type Answer = [Vec3Array; 2];

    fn run<L: Lanes>(self) -> Self::Answer {
        let (a, b) = loaded::<L>(&self.0);
        [a.unit_cross(b), a.cross(b).normalize_or(a)].map(Vec3Lanes::store)
    }
}

#[test]
fn vectors_are_those_of_glam() {
    for group in edges() {
        for isa in Isa::available() {
            let [wide, narrow] = run_lanes(isa, Units(group));
            for (lane, (a, b)) in group.into_iter().enumerate() {
                let cross = a.as_dvec3().cross(b.as_dvec3());
                let expected = cross.normalize_or(DVec3::Z).as_vec3();
                assert_eq!(wide.get(lane), expected);
                let expected = a.cross(b).normalize_or(a);
                assert_eq!(narrow.get(lane), expected);
            }
        }
    }
}

struct Leave(Pairs);

impl LaneKernel for Leave {
    type Answer = [Vec3Array; 3];

    fn run<L: Lanes>(self) -> Self::Answer {
        let (point, normal) = loaded::<L>(&self.0);
        let normal = normal.normalize_or(Vec3Lanes::splat(Vec3::Y));
        let error = point.abs().scale(L::splat(1e-6));
        let frame = FrameLanes::from_normal(normal);
        [
            offset_origin_lanes(point, error, normal, point),
            frame.to_world(point),
            frame.y,
        ]
        .map(Vec3Lanes::store)
    }
}

#[test]
fn frames_and_origins_are_those_of_single_points() {
    for group in edges() {
        for isa in Isa::available() {
            let lanes = run_lanes(isa, Leave(group));
            for (lane, (point, normal)) in group.into_iter().enumerate() {
                let normal = normal.normalize_or(Vec3::Y);
                let frame = Frame::from_normal(normal);
                let origin = offset_origin(point, point.abs() * 1e-6, normal, point);
                for (found, expected) in lanes.iter().zip([origin, frame.to_world(point), frame.y])
                {
                    let found = found.get(lane).to_array().map(f32::to_bits);
                    assert_eq!(found, expected.to_array().map(f32::to_bits));
                }
            }
        }
    }
}
