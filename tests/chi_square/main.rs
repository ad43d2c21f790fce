//! Every sampler against its own density: Pearson's chi-square test over cells of the domain, with
//! fixed seeds, at a significance of 0.01 for all cases together (Šidák).

mod bsdfs;
mod directions;
mod gamma;
mod guide;
mod harness;
mod lights;
mod measure;
mod warps;

use harness::Case;

fn all_groups() -> [fn() -> Vec<Case>; 5] {
    [
        warps::cases,
        bsdfs::cases,
        lights::surface_cases,
        lights::environment_cases,
        guide::cases,
    ]
}

fn check(group: fn() -> Vec<Case>) {
    let total: usize = all_groups().iter().map(|cases| cases().len()).sum();
    let level = 1.0 - (1.0 - 0.01_f64).powf(1.0 / total as f64);
    let failures: Vec<String> = group()
        .iter()
        .enumerate()
        .filter_map(|(seed, case)| case.run(seed as u64).complaint(&case.name, level))
        .collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn warps_match_their_densities() {
    check(warps::cases);
}

#[test]
fn materials_match_their_densities() {
    check(bsdfs::cases);
}

#[test]
fn light_surfaces_match_their_densities() {
    check(lights::surface_cases);
}

#[test]
fn environments_match_their_densities() {
    check(lights::environment_cases);
}

#[test]
fn guided_rays_match_their_densities() {
    check(guide::cases);
}

/// The test must be able to fail: densities that are wrong in the ways that programs get them wrong.
#[test]
fn wrong_densities_are_caught() {
    let wrong = warps::wrong_cases()
        .into_iter()
        .chain(lights::wrong_cases());
    for case in wrong {
        let outcome = case.run(1);
        assert!(outcome.p_value < 1e-6, "{} passes: {outcome:?}", case.name);
    }
}
