use std::path::{Path, PathBuf};

use clap::Args;
use softbox::image::Region;
use softbox::settings::{MaxDepth, Mode, RenderSettings};

use crate::job::Job;
use crate::settings_args::{SettingsArgs, StopArgs};
use crate::values;

/// The letters of the course's program that differ from the long options in form, so that its
/// command lines work unchanged. The others (-t -s -l -m -c -e -b -d) are short names of options.
#[derive(Args, Clone, Debug, Default, PartialEq)]
pub(crate) struct CourseArgs {
    /// Render this picture without a window; the course's defaults hold: -t 1 -s 1 -l 1 -m 1
    #[arg(short = 'f', value_name = "OUT", requires = "scene")]
    output: Option<PathBuf>,
    /// Size of the picture; with -f it is cut out of the 800x600 view
    #[arg(short = 'r', num_args = 2, value_names = ["W", "H"], conflicts_with = "size")]
    course_size: Option<Vec<u32>>,
    /// Render only this part; y counts from the top, with --course-compatible from the bottom
    #[arg(short = 'p', num_args = 4, value_names = ["X", "Y", "DX", "DY"], conflicts_with = "region")]
    course_region: Option<Vec<u32>>,
    /// Adaptive sampling: samples between decisions and relative tolerance
    #[arg(short = 'a', num_args = 2, value_names = ["BATCH", "TOL"], conflicts_with = "adaptive")]
    course_adaptive: Option<Vec<String>>,
    /// Uniform hemisphere sampling of direct light, as --mode hemisphere
    #[arg(short = 'H', conflicts_with = "mode")]
    hemisphere: bool,
    /// 1 adds up all bounces, 0 shows only the last one
    #[arg(short = 'o', value_name = "0|1", value_parser = clap::value_parser!(u8).range(0..=1))]
    accumulate: Option<u8>,
}

impl CourseArgs {
    /// True when a file is to be written instead of opening the window.
    pub(crate) fn is_headless(&self) -> bool {
        self.output.is_some()
    }

    /// The job that the letters and the options ask for together.
    pub(crate) fn job(
        &self,
        scene: Option<PathBuf>,
        options: &SettingsArgs,
        stop: &StopArgs,
    ) -> Result<Job, String> {
        let mut settings = RenderSettings::default();
        if self.is_headless() {
            settings.threads = 1;
            settings.max_depth = MaxDepth(1);
            settings.mode = Mode::Importance;
            let is_limited = stop.time_limit.is_some() || stop.target_error.is_some();
            settings.stop.samples_per_pixel = (!is_limited).then_some(1);
        }
        if let Some(&[width, height]) = self.course_size.as_deref() {
            [settings.width, settings.height] = values::check_size([width, height])?;
        }
        settings.only_last_bounce = self.accumulate == Some(0);
        if self.hemisphere {
            settings.mode = Mode::Hemisphere;
        }
        if let Some([batch, tolerance]) = self.course_adaptive.as_deref() {
            let (batch, tolerance) = values::check_batch(batch, tolerance)?;
            settings.adaptive = Some(options.adaptive(batch, tolerance));
        }
        let mut settings = options.apply(settings);
        settings.stop = stop.apply(settings.stop);
        if let Some(&[x, y, width, height]) = self.course_region.as_deref() {
            settings.region = Some(region([x, y, width, height], &settings)?);
        }
        let rate_picture = match (&self.output, settings.adaptive) {
            (Some(output), Some(_)) => Some(rate_name(output)),
            _ => None,
        };
        Ok(Job {
            scene,
            outputs: self.output.iter().cloned().collect(),
            rate_picture,
            settings,
            camera: options.camera(self.is_headless()),
            display: options.display(),
            environment: options.environment.clone(),
        })
    }
}

/// `-p`: the course's text counts y from the top, its program from the bottom.
fn region([x, y, width, height]: [u32; 4], settings: &RenderSettings) -> Result<Region, String> {
    if width == 0 || height == 0 {
        return Err("a region needs a width and a height above 0".to_owned());
    }
    let y = if settings.course_compatible {
        let bottom = y.saturating_add(height);
        settings.height.saturating_sub(bottom)
    } else {
        y
    };
    Ok(Region {
        x,
        y,
        width,
        height,
    })
}

/// The course's name for the picture of the sampling rate: `NAME_rate.png` beside `NAME.png`.
fn rate_name(output: &Path) -> PathBuf {
    let mut name = output.file_stem().unwrap_or_default().to_owned();
    name.push("_rate.png");
    output.with_file_name(name)
}
