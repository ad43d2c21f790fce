use std::fmt::Display;
use std::str::FromStr;

use softbox::settings::{Adaptive, AdaptiveGoal, Mode, RenderSettings};

use crate::values;

/// Samples between two decisions and tolerance, where `--adaptive` does not say.
const BATCH: u32 = 32;
const TOLERANCE: f32 = 0.05;

/// What `bench` measures: an estimator, with or without adaptive sampling.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Contender {
    /// Estimator of direct light.
    pub(crate) mode: Mode,
    /// What adaptive sampling is for; none when `None`.
    pub(crate) goal: Option<AdaptiveGoal>,
}

impl Contender {
    /// What `settings` ask for.
    pub(crate) fn of(settings: &RenderSettings) -> Self {
        Self {
            mode: settings.mode,
            goal: settings.adaptive.map(|adaptive| adaptive.goal),
        }
    }

    /// Its adaptive sampling, with the numbers of `settings`.
    pub(crate) fn adaptive(&self, settings: &RenderSettings) -> Option<Adaptive> {
        let numbers = settings.adaptive.unwrap_or(Adaptive {
            batch: BATCH,
            tolerance: TOLERANCE,
            goal: AdaptiveGoal::default(),
            exposure: 0.0,
        });
        self.goal.map(|goal| Adaptive { goal, ..numbers })
    }
}

impl Display for Contender {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.mode.name())?;
        match self.goal {
            Some(goal) => write!(f, "+{}", goal.name()),
            None => Ok(()),
        }
    }
}

impl FromStr for Contender {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (mode, goal) = match text.split_once('+') {
            Some((mode, goal)) => (mode, Some(values::named(goal)?)),
            None => (text, None),
        };
        let mode = values::named(mode)?;
        Ok(Self { mode, goal })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_written() {
        for name in [
            "best",
            "importance+even",
            "best+least-error",
            "hemisphere+course",
        ] {
            let contender: Contender = name.parse().unwrap();
            assert_eq!(contender.to_string(), name);
        }
        for wrong in ["", "+even", "best+", "best+better", "even"] {
            assert!(wrong.parse::<Contender>().is_err(), "{wrong}");
        }
    }
}
