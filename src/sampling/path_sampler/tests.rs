//! Tests S16 and S17 of the stress list.

use super::*;

fn correlation(pairs: impl Iterator<Item = (f32, f32)>) -> f64 {
    let (mut n, mut sx, mut sy, mut sxx, mut syy, mut sxy) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (x, y) in pairs {
        let (x, y) = (f64::from(x), f64::from(y));
        n += 1.0;
        sx += x;
        sy += y;
        sxx += x * x;
        syy += y * y;
        sxy += x * y;
    }
    let cov = sxy / n - sx / n * (sy / n);
    cov / ((sxx / n - (sx / n).powi(2)) * (syy / n - (sy / n).powi(2))).sqrt()
}

/// Every kind of dimension: pairs of the net, shuffled points, independent ones.
const SLOTS: [Slot; 7] = [
    Slot::Pixel,
    Slot::Lens,
    Slot::Scatter,
    Slot::Roulette,
    Slot::LightChoice(0),
    Slot::LightPoint(0),
    Slot::LightPoint(1),
];

/// Test S16 of the stress list for neighbours in pixel, bounce, slot and seed: |r| < 4/√N,
/// widened to 4.9/√N because some 400 coefficients are looked at. Samples of one pixel are not
/// independent; there, what dimensions have to do with each other counts.
#[test]
fn neighbours_are_uncorrelated() {
    const N: u32 = 65_536;
    let bound = 4.9 / f64::from(N).sqrt();
    for bounce in 0..8 {
        for slot in SLOTS {
            let at = |seed: u64, x: u32, y: u32, s: u32, b: u32| {
                PathSampler::new(seed, [x, y], s).get_2d(b, slot)
            };
            let cases = [
                correlation((0..N).map(|i| {
                    let next = at(7, i + 1, 3, 5, bounce);
                    (at(7, i, 3, 5, bounce).x, next.x)
                })),
                correlation((0..N).map(|i| {
                    let below = at(7, i, 4, 0, bounce);
                    (at(7, i, 3, 0, bounce).x, below.x)
                })),
                correlation((0..N).map(|i| {
                    let p = at(7, i, 3, 1, bounce);
                    (p.x, p.y)
                })),
                correlation((0..N).map(|i| {
                    let other = at(u64::from(i) + 1, 5, 3, 2, bounce);
                    (at(u64::from(i), 5, 3, 2, bounce).y, other.y)
                })),
                correlation((0..N).map(|i| {
                    let next = at(7, 5, 3, i, bounce + 1);
                    (at(7, 5, 3, i, bounce).x, next.x)
                })),
                correlation((0..N).map(|i| {
                    let p = at(7, 5, 3, i, bounce);
                    (p.x, p.y)
                })),
            ];
            for r in cases {
                assert!(r.abs() < bound, "bounce {bounce} {slot:?}: {cases:?}");
            }
        }
    }
}

/// Whether each elementary interval of area 1/n holds one of the n points.
fn is_net(points: &[Vec2]) -> bool {
    let n = points.len();
    (0..=n.trailing_zeros()).all(|log_columns| {
        let columns = 1 << log_columns;
        let mut seen = vec![false; n];
        points.iter().all(|p| {
            let (column, row) = (p.x * columns as f32, p.y * (n / columns) as f32);
            let cell = column as usize * (n / columns) + row as usize;
            !std::mem::replace(&mut seen[cell], true)
        })
    })
}

/// Block `block` of `n` samples of one replicate.
fn block_of(
    (pixel, bounce, slot): (u32, u32, Slot),
    (n, block): (u32, u32),
    (replicate, replicates): (u32, u32),
) -> Vec<Vec2> {
    (block * n..(block + 1) * n)
        .map(|i| i * replicates + replicate)
        .map(|sample| PathSampler::replicated(9, [pixel, 2], sample, replicates))
        .map(|numbers| numbers.get_2d(bounce, slot))
        .collect()
}

/// Test S17: exact for every two-dimensional slot, any aligned block, and every replicate.
#[test]
fn samples_of_a_pixel_fill_all_elementary_intervals() {
    let blocks = [(2, 0), (16, 0), (16, 77), (64, 3), (128, 1), (4096, 0)];
    let slots = SLOTS.into_iter().filter(|&slot| slot != Slot::Roulette);
    for slot in slots {
        for (bounce, pixel) in [(0, 0), (1, 1), (2, 2), (3, 3), (4, 4), (31, 5)] {
            for block in blocks {
                for replicate in [(0, 1), (0, 3), (2, 3), (3, 4)] {
                    let points = block_of((pixel, bounce, slot), block, replicate);
                    assert!(is_net(&points), "{bounce} {slot:?} {block:?} {replicate:?}");
                }
            }
        }
    }
}

/// What depends on scatter and light of two bounces at once gains from one net: at most 0.8 of
/// the squared error that the same slots have at later bounces, each in an order of its own.
#[test]
fn the_first_bounces_are_spread_together() {
    let squared_error = |first: u32| {
        let pixels = 4000;
        let mean = |pixel: u32| {
            let sum: f64 = (0..64)
                .map(|sample| {
                    let numbers = PathSampler::new(3, [pixel, first], sample);
                    let a = numbers.get_2d(first, Slot::Scatter).as_dvec2();
                    let b = numbers.get_2d(first + 1, Slot::Scatter).as_dvec2();
                    let c = numbers.get_2d(first + 1, Slot::LightPoint(0)).as_dvec2();
                    // The mean is 1.
                    (0.5 + a.x) * (0.5 + b.y) * (0.5 + c.x) * (1.25 - 0.75 * a.y * a.y)
                })
                .sum();
            sum / 64.0
        };
        (0..pixels).map(|p| (mean(p) - 1.0).powi(2)).sum::<f64>() / f64::from(pixels)
    };
    let (net, padded) = (squared_error(0), squared_error(3));
    assert!(net < 0.8 * padded, "{net} {padded}");
}

#[test]
fn replicates_are_sequences_of_their_own() {
    let value = |sample, replicates| {
        PathSampler::replicated(5, [8, 9], sample, replicates).get_2d(1, Slot::Scatter)
    };
    // A replicate of one is the sequence itself.
    let plain = PathSampler::new(5, [8, 9], 6).get_2d(1, Slot::Scatter);
    assert_eq!(value(6, 1), plain);
    // Samples 13 and 14 are number 3 of replicates 1 and 2.
    let r = correlation((0..40_000).map(|i| {
        let at = |replicate: u32| {
            PathSampler::replicated(5, [i % 200, i / 200], 12 + replicate, 4)
                .get_2d(1, Slot::Scatter)
        };
        (at(1).x, at(2).x)
    }));
    assert!(r.abs() < 4.0 / 200.0, "{r}");
}

/// No two dimensions of a path are the same numbers, in any pixel.
#[test]
fn no_dimension_is_used_twice() {
    for pixel in 0..40 {
        let numbers = PathSampler::new(1, [pixel, 0], 3);
        let mut seen = std::collections::HashSet::new();
        for bounce in 0..40 {
            let several = (0..16).flat_map(|n| {
                [
                    Slot::LightChoice(n),
                    Slot::LightPoint(n),
                    Slot::Hemisphere(n),
                ]
            });
            let single = [
                Slot::Pixel,
                Slot::Lens,
                Slot::Scatter,
                Slot::Lobe,
                Slot::Roulette,
            ];
            for slot in single.into_iter().chain(several) {
                let u = numbers.get_2d(bounce, slot);
                let bits = (u.x.to_bits(), u.y.to_bits());
                assert!(
                    seen.insert(bits),
                    "pixel {pixel}, bounce {bounce}, {slot:?}"
                );
            }
        }
    }
}

#[test]
fn numbers_stay_below_one_and_are_uniform() {
    let n = 200_000_u32;
    // The number of a sample over the pixels, and samples far into the sequence.
    for (sample, bounce, slot) in [
        (0, 2, Slot::Scatter),
        (1, 0, Slot::Pixel),
        (37, 5, Slot::Scatter),
        (u32::MAX, 1, Slot::LightPoint(0)),
        (0, 1, Slot::Roulette),
    ] {
        let mut bins = [0_u32; 64];
        for i in 0..n {
            let u = PathSampler::new(1, [i % 640, i / 640], sample).get_2d(bounce, slot);
            assert!((0.0..1.0).contains(&u.x) && (0.0..1.0).contains(&u.y));
            bins[(u.x * 8.0) as usize * 8 + (u.y * 8.0) as usize] += 1;
        }
        let expected = f64::from(n) / 64.0;
        let chi2: f64 = bins
            .iter()
            .map(|&b| (f64::from(b) - expected).powi(2) / expected)
            .sum();
        // 63 degrees of freedom: mean 63, deviation 11.2; four and a half deviations.
        assert!(chi2 < 114.0, "sample {sample}, {slot:?}: {chi2}");
    }
    assert_eq!(unit(u32::MAX), crate::sampling::ONE_MINUS_EPSILON);
}

/// The paths of a cluster together have one point in each elementary interval of the slots that they
/// share, at every sample and after all of the first 2ᵏ; their own slots differ.
#[test]
fn the_paths_of_a_cluster_draw_from_one_net() {
    for size in [2, 4, 16] {
        let samplers: Vec<PathSampler> = (0..8 * size)
            .map(|i| {
                let (sample, number) = (i / size, i % size);
                let member = Member {
                    first: [6, 2],
                    number,
                    size,
                };
                PathSampler::in_cluster(5, ([6 + number, 2], sample), 1, member)
            })
            .collect();
        for (bounce, slot) in [
            (0, Slot::Scatter),
            (1, Slot::LightPoint(0)),
            (4, Slot::Lobe),
        ] {
            for samples in [1, 2, 8] {
                let points: Vec<_> = (samplers[..(samples * size) as usize].iter())
                    .map(|sampler| sampler.get_2d(bounce, slot))
                    .collect();
                let levels = (samples * size).ilog2();
                for columns in 0..=levels {
                    let cells = [1 << columns, 1 << (levels - columns)];
                    let mut seen = std::collections::HashSet::new();
                    for u in &points {
                        let cell = [
                            (u.x * cells[0] as f32) as u32,
                            (u.y * cells[1] as f32) as u32,
                        ];
                        assert!(
                            seen.insert(cell),
                            "{size}, {slot:?}, {samples}: {cell:?} twice"
                        );
                    }
                }
            }
        }
        for (sampler, other) in samplers.iter().zip(&samplers[1..]) {
            let own = |s: &PathSampler| s.get_2d(0, Slot::LightPoint(0));
            assert_ne!(own(sampler), own(other));
        }
    }
}

/// The first 2ⁿ points of one path of a cluster, in the pairs that matter most, are the same number in
/// every elementary interval of area 2⁻ⁿ⁺⁴.
#[test]
fn the_points_of_one_path_of_a_cluster_are_even() {
    const GAP: u32 = 4;
    for size in [2, 4, 8, 16] {
        for (bounce, slot) in [
            (0, Slot::Scatter),
            (1, Slot::Scatter),
            (1, Slot::LightPoint(0)),
        ] {
            let member = Member {
                first: [3, 8],
                number: size - 1,
                size,
            };
            let points: Vec<_> = (0..16_384)
                .map(|sample| {
                    PathSampler::in_cluster(6, ([4, 8], sample), 1, member).get_2d(bounce, slot)
                })
                .collect();
            for levels in GAP + 1..=14 {
                let points = &points[..1 << levels];
                for columns in 0..=levels - GAP {
                    let cells = [1_usize << columns, 1 << (levels - GAP - columns)];
                    let mut counts = vec![0; cells[0] * cells[1]];
                    for u in points {
                        let x = (u.x * cells[0] as f32) as usize;
                        let y = (u.y * cells[1] as f32) as usize;
                        counts[x * cells[1] + y] += 1;
                    }
                    assert!(
                        counts.iter().all(|&count| count == 1 << GAP),
                        "{size} paths, {slot:?} {bounce}, 2^{levels} points, {cells:?}"
                    );
                }
            }
        }
    }
}
