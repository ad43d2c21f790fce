//! Rays per second and build time on standard scenes: what `softbox bench --rays` measures of our
//! tracer, and `benches/rays` of ours and others side by side.
//!
//! - The rays are made once, from hits in double precision, and are the same for all systems.
//! - All systems write into the same buffers. What a system needs to turn a ray into its own form is
//!   part of its time; making its input mesh is not.
//! - Rates count processor time, which other work on the machine disturbs less than wall time. They
//!   are medians over rounds; in each round all systems take turns, some milliseconds each.
//! - Primary rays go in tiles of 8 x 8 pixels, and ours and the packets of others may use that. Bounces are diffuse (proportional to the cosine) and
//!   shadow rays go to a random point of the lamp; both keep the order of the primary rays.

mod catalog;
mod clock;
mod contest;
mod exact;
pub(crate) mod mesh;
mod random;
mod rays;
pub(crate) mod result;
mod subject;
pub(crate) mod system;
mod table;

use clap::Args;
use softbox::math::Isa;

pub(crate) use catalog::{SCENES, subject};
pub(crate) use contest::contest;
pub(crate) use exact::Exact;
pub(crate) use random::Random;
pub(crate) use rays::Kind;
pub(crate) use result::SceneResult;
pub(crate) use subject::Subject;
pub(crate) use system::{System, Tracer, ours};
pub(crate) use table::write_table;

/// Name of the system that others are compared with.
pub(crate) const ANCHOR: &str = "embree";

/// What is measured and how often.
#[derive(Args, Clone, Debug, PartialEq)]
pub(crate) struct Protocol {
    /// Times that every system traces every set of rays
    #[arg(long, value_name = "N", default_value = "5", value_parser = count)]
    pub(crate) rounds: usize,
    /// Times that every system builds; large scenes less often
    #[arg(long, value_name = "N", default_value = "3", value_parser = count)]
    pub(crate) builds: usize,
    /// Numbers of threads
    #[arg(long, value_name = "N,N", default_value = "1,2", value_delimiter = ',', value_parser = count)]
    pub(crate) threads: Vec<usize>,
    /// Instruction set that ours traces with: portable, avx2 or avx512 [default: the best of this processor]
    #[arg(long, value_parser = Isa::usable)]
    pub(crate) isa: Option<Isa>,
    /// Kinds of rays
    #[arg(
        long,
        value_name = "KIND,KIND",
        value_delimiter = ',',
        default_value = "primary,bounce1,bounce2,shadow0,shadow1"
    )]
    pub(crate) kinds: Vec<Kind>,
    /// Number of primary rays
    #[arg(long, value_name = "WxH", default_value = "512x384", value_parser = size)]
    pub(crate) size: (u32, u32),
}

fn count(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n @ 1..) => Ok(n),
        _ => Err(format!("'{text}' is not a number above 0")),
    }
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let numbers = text.split_once('x').and_then(|(width, height)| {
        let number = |word: &str| word.parse().ok().filter(|n| (1..=8192).contains(n));
        Some((number(width)?, number(height)?))
    });
    numbers.ok_or_else(|| format!("'{text}' is not a size up to 8192x8192"))
}

/// The middle of `values`; of an even number the mean of the two in the middle. NaN of nothing.
pub(crate) fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => f64::NAN,
        n if n % 2 == 0 => 0.5 * (values[middle - 1] + values[middle]),
        _ => values[middle],
    }
}
