use std::fmt;

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// An instruction set that kernels are compiled for; chosen at run time. Never changes a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Isa {
    /// What every processor of the architecture has (SSE2, NEON).
    Portable,
    /// AVX2 with fused multiply-add and bit manipulation (x86-64-v3).
    Avx2,
    /// AVX-512 (F, BW, CD, DQ, VL; x86-64-v4): sixteen numbers at once in shading, in small scenes and
    /// for camera rays, eight for other rays.
    Avx512,
}

/// Why a name does not stand for an instruction set that can be used here.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum IsaError {
    /// No instruction set is called so.
    #[error("there is no instruction set '{0}': give portable, avx2 or avx512")]
    Unknown(String),
    /// This processor does not have it.
    #[error("this processor has no {0}")]
    Missing(Isa),
}

impl Isa {
    /// All of them, slowest first.
    pub const ALL: [Self; 3] = [Self::Portable, Self::Avx2, Self::Avx512];

    /// True when this processor has it.
    pub fn is_available(self) -> bool {
        match self {
            Self::Portable => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => {
                is_x86_feature_detected!("avx2")
                    && is_x86_feature_detected!("fma")
                    && is_x86_feature_detected!("bmi1")
                    && is_x86_feature_detected!("bmi2")
                    && is_x86_feature_detected!("lzcnt")
                    && is_x86_feature_detected!("popcnt")
            }
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => {
                Self::Avx2.is_available()
                    && is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512bw")
                    && is_x86_feature_detected!("avx512cd")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512vl")
            }
            #[cfg(not(target_arch = "x86_64"))]
            Self::Avx2 | Self::Avx512 => false,
        }
    }

    /// Those that this processor has, slowest first.
    pub fn available() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|isa| isa.is_available())
    }

    /// The fastest that this processor has.
    pub fn best() -> Self {
        Self::available().last().unwrap_or(Self::Portable)
    }

    /// As it is called in the command line, the window and the metadata.
    pub fn name(self) -> &'static str {
        match self {
            Self::Portable => "portable",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    /// The instruction set of this name.
    ///
    /// # Errors
    /// When there is none, or this processor does not have it.
    pub fn usable(name: &str) -> Result<Self, IsaError> {
        Self::among(name, Self::is_available)
    }

    fn among(name: &str, is_available: impl Fn(Self) -> bool) -> Result<Self, IsaError> {
        match Self::ALL.into_iter().find(|isa| isa.name() == name) {
            None => Err(IsaError::Unknown(name.to_owned())),
            Some(isa) if is_available(isa) => Ok(isa),
            Some(isa) => Err(IsaError::Missing(isa)),
        }
    }
}

impl fmt::Display for Isa {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_is_available_and_portable_always_is() {
        assert!(Isa::best().is_available());
        assert_eq!(Isa::available().next(), Some(Isa::Portable));
        assert_eq!(Isa::usable(Isa::best().name()), Ok(Isa::best()));
    }

    #[test]
    fn a_name_is_refused_with_the_reason() {
        let old = |isa| isa == Isa::Portable;
        for isa in Isa::ALL {
            assert_eq!(Isa::among(isa.name(), |_| true), Ok(isa));
        }
        assert_eq!(Isa::among("portable", old), Ok(Isa::Portable));
        assert_eq!(Isa::among("avx2", old), Err(IsaError::Missing(Isa::Avx2)));
        let unknown = Isa::usable("AVX9").unwrap_err();
        assert_eq!(
            unknown.to_string(),
            "there is no instruction set 'AVX9': give portable, avx2 or avx512"
        );
    }
}
