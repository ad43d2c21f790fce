use serde::{Deserialize, Serialize};

/// Tone curve from linear radiance to 0..1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ToneCurve {
    /// Exact sRGB, clipped at 1.
    #[default]
    Srgb,
    /// The course's: exposure √2, then the power 1/2.2.
    Course,
    /// Reinhard 2002 on each channel, then sRGB.
    Reinhard,
    /// A filmic curve (Narkowicz 2015 fit of ACES), then sRGB.
    Filmic,
}

impl ToneCurve {
    /// All curves, in the order in which they are offered.
    pub const ALL: [Self; 4] = [Self::Srgb, Self::Course, Self::Reinhard, Self::Filmic];

    /// The name used in the command line, the window and the metadata.
    pub fn name(self) -> &'static str {
        match self {
            Self::Srgb => "srgb",
            Self::Course => "course",
            Self::Reinhard => "reinhard",
            Self::Filmic => "filmic",
        }
    }
}

/// How linear pixels become displayed ones. Never restarts a render.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct DisplaySettings {
    /// Exposure in stops: radiance is multiplied by 2^exposure.
    pub exposure: f32,
    /// Tone curve.
    pub tone_curve: ToneCurve,
}

impl DisplaySettings {
    /// The factor 2^exposure.
    pub fn gain(&self) -> f32 {
        self.exposure.exp2()
    }
}
