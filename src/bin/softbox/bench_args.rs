use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;
use softbox::settings::{Mode, RenderSettings, View};

use crate::args::Reporting;
use crate::contender::Contender;
use crate::job::Job;
use crate::settings_args::SettingsArgs;
use crate::values;

/// Help of `--size`, whose default differs from that of a render.
pub(crate) const SIZE_HELP: &str = "Size of the picture [default: 480x360]";
const SIZE: [u32; 2] = [480, 360];
/// Samples of a reference that is made here, times the most that are measured.
const REFERENCE_FACTOR: u32 = 16;

/// `softbox bench`: error against processor time.
#[derive(Args, Clone, Debug, PartialEq)]
pub(crate) struct BenchArgs {
    /// Scene files or built-in scenes; without any, all that are built in
    #[arg(value_name = "SCENE")]
    pub(crate) scenes: Vec<PathBuf>,
    /// Measure build time and rays per second instead; 'bench --rays --help' tells more
    #[arg(long)]
    pub(crate) rays: bool,
    /// Numbers of samples at which the picture is scored: a list such as 1,4,16, or a range such as
    /// 1..64 of all powers of two
    #[arg(short = 's', long, value_name = "LIST", default_value = "1..64")]
    pub(crate) spp: Levels,
    /// Runs that differ in their seed; intervals need at least 5
    #[arg(long, value_name = "N", default_value = "5", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) seeds: u32,
    /// Estimators to compare, the first with each of the others; a mode, or a mode with adaptive
    /// sampling such as best+even or best+least-error
    #[arg(
        long,
        value_name = "MODE[+GOAL],…",
        value_delimiter = ',',
        conflicts_with = "mode"
    )]
    pub(crate) compare: Vec<Contender>,
    /// Picture to score against (.exr, .hdr or .pfm); else one is made by another estimator
    #[arg(long, value_name = "FILE")]
    pub(crate) reference: Option<PathBuf>,
    /// relMSE of that picture's own noise, which is subtracted [default: 0]
    #[arg(long, value_name = "X", requires = "reference", value_parser = values::not_negative)]
    pub(crate) reference_noise: Option<f64>,
    /// Estimator of a reference that is made here [default: importance, or best]
    #[arg(long, value_name = "MODE", conflicts_with = "reference", value_parser = values::named::<Mode>)]
    pub(crate) reference_mode: Option<Mode>,
    /// Samples of a reference that is made here [default: 16 times the most of --spp]
    #[arg(long, value_name = "N", conflicts_with = "reference", value_parser = clap::value_parser!(u32).range(2..))]
    pub(crate) reference_spp: Option<u32>,
    /// Measure each scene for at most about this long, and its reference as long again
    #[arg(long, value_name = "SECONDS", value_parser = values::positive)]
    pub(crate) time_limit: Option<f64>,
    /// Draw the curves into this file (.png)
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// Append a line for each scene and mode to this text file
    #[arg(long, value_name = "FILE")]
    pub(crate) append: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) settings: SettingsArgs,
    #[command(flatten)]
    pub(crate) reporting: Reporting,
}

impl BenchArgs {
    /// Itself, if it makes sense.
    pub(crate) fn checked(self: Box<Self>) -> Result<Box<Self>, String> {
        let settings = self.render_settings();
        if settings.view != View::Render {
            return Err("only the picture has an error to measure: leave out --view".to_owned());
        }
        if self.reference.is_some() && self.scenes.len() != 1 {
            return Err("a reference belongs to one scene: name that scene".to_owned());
        }
        let compared = self.compare.iter().enumerate();
        let mut repeated = compared.filter(|(i, name)| self.compare[..*i].contains(name));
        if repeated.next().is_some() {
            return Err("--compare names a mode twice".to_owned());
        }
        crate::args::check_region(&settings)?;
        Ok(self)
    }

    /// The settings of every render, but for mode and seed.
    pub(crate) fn render_settings(&self) -> RenderSettings {
        self.settings.apply(RenderSettings {
            width: SIZE[0],
            height: SIZE[1],
            ..RenderSettings::default()
        })
    }

    /// The job of one scene; its stop rule says nothing.
    pub(crate) fn job(&self, scene: PathBuf) -> Job {
        Job {
            scene: Some(scene),
            settings: self.render_settings(),
            camera: self.settings.camera(false),
            environment: self.settings.environment.clone(),
            ..Job::default()
        }
    }

    /// What is measured, at least one.
    pub(crate) fn contenders(&self) -> Vec<Contender> {
        if self.compare.is_empty() {
            vec![Contender::of(&self.render_settings())]
        } else {
            self.compare.clone()
        }
    }

    /// The estimator of a reference that is made here: not the one that is measured.
    pub(crate) fn chosen_reference_mode(&self) -> Mode {
        let is_importance = |contender: &Contender| contender.mode == Mode::Importance;
        let own = if self.contenders().iter().all(is_importance) {
            Mode::Best
        } else {
            Mode::Importance
        };
        self.reference_mode.unwrap_or(own)
    }

    /// Its samples, both halves together.
    pub(crate) fn chosen_reference_spp(&self) -> u32 {
        let own = self.spp.last().saturating_mul(REFERENCE_FACTOR);
        self.reference_spp.unwrap_or(own)
    }
}

/// Numbers of samples, ascending, each above 0; at least one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Levels(Vec<u32>);

impl Levels {
    pub(crate) fn as_slice(&self) -> &[u32] {
        &self.0
    }

    fn last(&self) -> u32 {
        *self.0.last().expect("there is at least one")
    }
}

impl FromStr for Levels {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong =
            || format!("'{text}' is neither a list such as 1,4,16 nor a range such as 1..64");
        let number = |word: &str| match word.trim().parse::<u32>() {
            Ok(n @ 1..) => Ok(n),
            _ => Err(wrong()),
        };
        let mut levels = match text.split_once("..") {
            Some((first, last)) => {
                let (first, last) = (number(first)?, number(last)?);
                let powers = (0..u32::BITS).map(|k| 1_u32 << k);
                powers.filter(|n| (first..=last).contains(n)).collect()
            }
            None => text
                .split(',')
                .map(number)
                .collect::<Result<Vec<u32>, String>>()?,
        };
        levels.sort_unstable();
        levels.dedup();
        if levels.is_empty() {
            return Err(format!("'{text}' holds no power of two"));
        }
        Ok(Self(levels))
    }
}

impl std::fmt::Display for Levels {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let words: Vec<String> = self.0.iter().map(u32::to_string).collect();
        f.write_str(&words.join(","))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_samples_are_a_list_or_a_range() {
        let levels = |text: &str| text.parse::<Levels>().map(|levels| levels.to_string());
        assert_eq!(levels("1..16").unwrap(), "1,2,4,8,16");
        assert_eq!(levels("3..20").unwrap(), "4,8,16");
        assert_eq!(levels("16, 1,16").unwrap(), "1,16");
        for wrong in ["", "0", "1..", "a..4", "4..1", "5..7", "1,-2"] {
            assert!(levels(wrong).unwrap_err().contains(wrong), "{wrong}");
        }
    }
}
