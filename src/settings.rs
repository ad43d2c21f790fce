//! Floor 4: every setting of a render, defined once. The command line, the viewer's panels, the
//! file metadata and the JSON output all come from these definitions; the doc comments serve as
//! help and tooltip.

use serde::{Deserialize, Serialize};

use crate::bvh::BvhSettings;
use crate::image::Region;
use crate::math::Isa;

/// How direct light is estimated. All modes converge to the same picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mode {
    /// Uniform directions over the hemisphere, the course's first estimator; (lights × light
    /// samples) directions a vertex. Point-like lights are sampled directly.
    Hemisphere,
    /// Every light sampled at every vertex, light-samples times each (point-like lights once).
    Importance,
    /// One light chosen by power, multiple-importance weighting against the material.
    #[default]
    Best,
}

impl Mode {
    /// All modes, in the order in which they are offered.
    pub const ALL: [Self; 3] = [Self::Hemisphere, Self::Importance, Self::Best];

    /// The name used in the command line, the window and the metadata.
    pub fn name(self) -> &'static str {
        match self {
            Self::Hemisphere => "hemisphere",
            Self::Importance => "importance",
            Self::Best => "best",
        }
    }
}

/// Which path tracer runs. Both draw the same random numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum IntegratorKind {
    /// One path at a time: plain, slow, the oracle.
    Reference,
    /// Batches of a few thousand paths, stage by stage.
    #[default]
    Wavefront,
}

/// The largest number of bounces at surfaces: 0 = emission seen directly, 1 = direct light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct MaxDepth(pub u32);

impl MaxDepth {
    /// No limit; Russian roulette alone ends paths.
    pub const INFINITE: Self = Self(u32::MAX);
}

impl std::fmt::Display for MaxDepth {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if *self == Self::INFINITE {
            f.write_str("inf")
        } else {
            write!(f, "{}", self.0)
        }
    }
}

impl std::str::FromStr for MaxDepth {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "inf" | "infinite" => Ok(Self::INFINITE),
            _ => text
                .parse()
                .map(Self)
                .map_err(|_| format!("'{text}' is not a depth: give a whole number or 'inf'")),
        }
    }
}

/// Pixels that share their indirect light: a power of two up to 16; 1 for none, or as many as suit
/// the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Reuse(u32);

impl Reuse {
    /// Every pixel by itself.
    pub const NONE: Self = Self(1);

    /// As many as suit the scene: 16, 4 where much of the noise is that of many lights, 1 under a sky
    /// without a picture if not all surfaces are diffuse.
    pub const AUTO: Self = Self(0);

    /// All choices, in the order in which they are offered.
    pub const ALL: [Self; 6] = [Self::AUTO, Self(1), Self(2), Self(4), Self(8), Self(16)];

    /// The name used in the command line, the window and the metadata.
    pub fn name(self) -> &'static str {
        match self.0 {
            0 => "auto",
            2 => "2",
            4 => "4",
            8 => "8",
            16 => "16",
            _ => "1",
        }
    }

    /// Of 3×3 pixels, as many as give a 95 % interval that holds the truth 95 times in 100: those of
    /// different clusters, and some more, since pixels that share have noise of their own, too.
    pub fn independent_of_nine(self) -> usize {
        match self.0 {
            1 | 2 => 9,
            4 => 6,
            8 => 5,
            _ => 4,
        }
    }

    /// Pixels that share; 0 for [`Self::AUTO`].
    pub fn pixels(self) -> u32 {
        self.0
    }
}

impl std::fmt::Display for Reuse {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

impl std::str::FromStr for Reuse {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        (Self::ALL.into_iter())
            .find(|reuse| text == reuse.name())
            .ok_or_else(|| format!("'{text}' pixels cannot share: give auto, 1, 2, 4, 8 or 16"))
    }
}

/// What adaptive sampling is for: which pixels get how many samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AdaptiveGoal {
    /// The same quality everywhere: a pixel ends when the 95 % interval of all channels, pooled over
    /// 3×3 pixels, is within the tolerance, and so it is for all its neighbours. At least 64 samples
    /// (256 in hemisphere mode), dealt out to independent replicates that tell the interval.
    #[default]
    #[serde(alias = "neighbourhood")]
    Even,
    /// The least mean squared relative error for the samples: each pixel gets them in proportion to
    /// its deviation relative to its brightness. There is no tolerance; the limit of samples is the
    /// mean of the picture.
    LeastError,
    /// The course's rule: each pixel ends by itself, by the spread of its luminance.
    Course,
}

impl AdaptiveGoal {
    /// All goals, in the order in which they are offered.
    pub const ALL: [Self; 3] = [Self::Even, Self::LeastError, Self::Course];

    /// The name used in the command line, the window and the metadata.
    pub fn name(self) -> &'static str {
        match self {
            Self::Even => "even",
            Self::LeastError => "least-error",
            Self::Course => "course",
        }
    }
}

/// Adaptive sampling. Slightly biased, as what samples have found decides about more of them: off by
/// default.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Adaptive {
    /// Samples (with least error the mean of them) between two decisions.
    pub batch: u32,
    /// Half width of the 95 % interval as a fraction of the mean at which a pixel ends.
    pub tolerance: f32,
    /// What it is for.
    #[serde(default)]
    pub goal: AdaptiveGoal,
    /// Exposure in stops at which dark pixels are looked at: with even quality, brightness below
    /// half of 1/255 there counts as that.
    #[serde(default)]
    pub exposure: f32,
}

impl Adaptive {
    /// Independent sequences that the samples of a pixel are dealt out to.
    pub fn replicates(&self) -> u32 {
        match self.goal {
            AdaptiveGoal::Even => REPLICATES,
            AdaptiveGoal::LeastError | AdaptiveGoal::Course => 1,
        }
    }
}

/// Replicates of even quality.
const REPLICATES: u32 = 4;

/// Where the camera comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CameraRule {
    /// The course's rule for files of its dialect, the file's camera for others, fitted without one.
    #[default]
    Auto,
    /// Target = centre of the bounding box, 1.5 diagonals away, direction from the file's camera.
    Course,
    /// The file's camera as it stands.
    File,
    /// The whole scene in view.
    Fit,
}

/// What a picture shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum View {
    /// The path-traced picture.
    #[default]
    Render,
    /// Shading normals, mapped to 0.5 n + 0.5.
    Normals,
    /// Geometric normals, mapped alike.
    GeometricNormals,
    /// Reflectance (or tint) of the first surface.
    Albedo,
    /// Distance from the camera, near bright.
    Depth,
    /// Box and primitive tests of the camera ray.
    Cost,
    /// Samples taken in each pixel, blue (few) to red (most).
    Samples,
    /// Estimated relative error of each pixel.
    Noise,
}

impl View {
    /// All views, in the order in which they are offered.
    pub const ALL: [Self; 8] = [
        Self::Render,
        Self::Normals,
        Self::GeometricNormals,
        Self::Albedo,
        Self::Depth,
        Self::Cost,
        Self::Samples,
        Self::Noise,
    ];

    /// The name used in the command line, the window and the metadata.
    pub fn name(self) -> &'static str {
        match self {
            Self::Render => "render",
            Self::Normals => "normals",
            Self::GeometricNormals => "geometric-normals",
            Self::Albedo => "albedo",
            Self::Depth => "depth",
            Self::Cost => "cost",
            Self::Samples => "samples",
            Self::Noise => "noise",
        }
    }

    /// True for views that need only the first hit of each camera ray and no light.
    pub fn is_first_hit(self) -> bool {
        !matches!(self, Self::Render | Self::Samples | Self::Noise)
    }
}

/// When a render is finished, whichever comes first; nothing set means never.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StopRule {
    /// Samples per pixel; with adaptive sampling the most of them, or with least error their mean.
    pub samples_per_pixel: Option<u32>,
    /// Seconds of rendering.
    pub seconds: Option<f64>,
    /// Estimated relative error of the whole picture.
    pub relative_error: Option<f64>,
}

/// Everything that decides what is rendered, apart from the scene and the camera.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct RenderSettings {
    /// Image width in pixels.
    pub width: u32,
    /// Image height in pixels.
    pub height: u32,
    /// Render only this part of the image.
    pub region: Option<Region>,
    /// Light samples per area light and vertex.
    pub light_samples: u32,
    /// Largest number of bounces.
    pub max_depth: MaxDepth,
    /// Keep only the light of the last bounce (`-o 0` of the course).
    pub only_last_bounce: bool,
    /// Estimator of direct light.
    pub mode: Mode,
    /// Pixels that share their indirect light (mode best only). Unbiased; the noise of pixels that
    /// share is alike.
    pub reuse: Reuse,
    /// Path tracer.
    pub integrator: IntegratorKind,
    /// Adaptive sampling, off when `None`.
    pub adaptive: Option<Adaptive>,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Reproduce the course program's picture on purpose, with its errors.
    pub course_compatible: bool,
    /// BVH build.
    pub bvh: BvhSettings,
    /// Worker threads; 0 = all cores. Never changes the picture.
    pub threads: usize,
    /// Instruction set to trace with; the best of this processor when `None`. Never changes the
    /// picture. Not stored: it belongs to one run on one machine.
    #[serde(skip)]
    pub isa: Option<Isa>,
    /// When to stop.
    pub stop: StopRule,
    /// What the picture shows.
    pub view: View,
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self {
            width: 800,
            height: 600,
            region: None,
            light_samples: 1,
            max_depth: MaxDepth(5),
            only_last_bounce: false,
            mode: Mode::Best,
            reuse: Reuse::default(),
            integrator: IntegratorKind::Wavefront,
            adaptive: None,
            seed: 0,
            course_compatible: false,
            bvh: BvhSettings::default(),
            threads: 0,
            isa: None,
            stop: StopRule::default(),
            view: View::Render,
        }
    }
}

impl RenderSettings {
    /// The pixels to render: the region inside the image, else the whole image.
    pub fn active_region(&self) -> Region {
        let whole = Region {
            x: 0,
            y: 0,
            width: self.width,
            height: self.height,
        };
        self.region
            .and_then(|r| r.clipped(self.width, self.height))
            .unwrap_or(whole)
    }

    /// Independent sequences that the samples of a pixel are dealt out to, at least 1.
    pub fn replicates(&self) -> u32 {
        self.adaptive.as_ref().map_or(1, Adaptive::replicates)
    }

    /// The instruction set that `isa` stands for.
    pub fn instruction_set(&self) -> Isa {
        self.isa.unwrap_or_else(Isa::best)
    }

    /// The worker threads that `threads` stands for.
    pub fn thread_count(&self) -> usize {
        match self.threads {
            0 => std::thread::available_parallelism().map_or(1, std::num::NonZero::get),
            n => n,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_reads_and_prints_inf() {
        assert_eq!("inf".parse(), Ok(MaxDepth::INFINITE));
        assert_eq!("3".parse(), Ok(MaxDepth(3)));
        assert!("-1".parse::<MaxDepth>().is_err());
        assert_eq!(MaxDepth::INFINITE.to_string(), "inf");
    }
}
