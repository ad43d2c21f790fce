use std::path::PathBuf;

use clap::Args;
use glam::DVec3;
use softbox::bvh::{BvhKind, BvhQuality};
use softbox::display::{DisplaySettings, ToneCurve};
use softbox::image::Region;
use softbox::math::Isa;
use softbox::settings::{
    Adaptive, AdaptiveGoal, CameraRule, IntegratorKind, MaxDepth, Mode, RenderSettings, Reuse,
    StopRule, View,
};

use crate::job::{CameraChoice, FieldOfView};
use crate::values;

/// When a render ends, whichever comes first.
#[derive(Args, Clone, Debug, Default, PartialEq)]
pub(crate) struct StopArgs {
    /// Samples for each pixel; with adaptive sampling the most of them, or the mean for least error
    #[arg(short = 's', long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) spp: Option<u32>,
    /// Stop after this many seconds
    #[arg(long, value_name = "SECONDS", value_parser = values::positive)]
    pub(crate) time_limit: Option<f64>,
    /// Stop at this estimated relative error of the picture
    #[arg(long, value_name = "X", value_parser = values::positive)]
    pub(crate) target_error: Option<f64>,
}

impl StopArgs {
    /// `stop` with everything that was given in its place.
    pub(crate) fn apply(&self, stop: StopRule) -> StopRule {
        StopRule {
            samples_per_pixel: self.spp.or(stop.samples_per_pixel),
            seconds: self.time_limit,
            relative_error: self.target_error,
        }
    }
}

/// The options that decide what is rendered; every setting of the viewer has one.
#[derive(Args, Clone, Debug, Default, PartialEq)]
pub(crate) struct SettingsArgs {
    /// Size of the picture [default: 800x600]
    #[arg(long, value_name = "WxH", value_parser = values::size)]
    pub(crate) size: Option<[u32; 2]>,
    /// Render only this part, in pixels from the top left
    #[arg(long, value_name = "X,Y,W,H", value_parser = values::region)]
    pub(crate) region: Option<Region>,
    /// Samples for each area light [default: 1]
    #[arg(short = 'l', long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) light_samples: Option<u32>,
    /// Largest number of bounces, or 'inf': 0 shows emission, 1 direct light [default: 5; with -f 1]
    #[arg(short = 'm', long, value_name = "N|inf")]
    pub(crate) max_depth: Option<MaxDepth>,
    /// Show only the light of the last bounce
    #[arg(long)]
    pub(crate) only_last_bounce: bool,
    /// Estimator of direct light: hemisphere, importance or best [default: best; with -f importance]
    #[arg(long, value_parser = values::named::<Mode>)]
    pub(crate) mode: Option<Mode>,
    /// Pixels that share their indirect light, with mode best: auto, 1, 2, 4, 8 or 16 [default: auto]
    #[arg(long, value_name = "N")]
    pub(crate) reuse: Option<Reuse>,
    /// Path tracer: wavefront, or the slow and plain reference
    #[arg(long, value_parser = values::named::<IntegratorKind>)]
    pub(crate) integrator: Option<IntegratorKind>,
    /// Adaptive sampling: samples between decisions and relative tolerance, such as 64,0.05
    #[arg(long, value_name = "BATCH,TOL", value_parser = values::batch_and_tolerance)]
    pub(crate) adaptive: Option<(u32, f32)>,
    /// What adaptive sampling is for: even (each pixel ends within the tolerance), least-error (the
    /// least error for the samples, of which --spp is the mean), or course (its rule) [default: even]
    #[arg(long, visible_alias = "adaptive-rule", value_name = "GOAL", value_parser = values::named::<AdaptiveGoal>)]
    pub(crate) adaptive_goal: Option<AdaptiveGoal>,
    /// Exposure at which adaptive sampling looks at dark pixels [default: that of --exposure]
    #[arg(long, value_name = "STOPS", allow_hyphen_values = true, value_parser = values::finite)]
    pub(crate) adaptive_exposure: Option<f32>,
    /// Seed of the random numbers [default: 0]
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,
    /// What to show: render, normals, geometric-normals, albedo, depth, cost, samples or noise
    #[arg(long, value_parser = values::named::<View>)]
    pub(crate) view: Option<View>,
    /// Worker threads, 0 for all cores [default: 0; with -f 1]
    #[arg(short = 't', long, value_name = "N")]
    pub(crate) threads: Option<usize>,
    /// Bounding volume hierarchy: none, median or sah
    #[arg(long, value_parser = values::named::<BvhKind>)]
    pub(crate) bvh: Option<BvhKind>,
    /// Most primitives in a leaf of the hierarchy; two triangles that share an edge are one [default: 4]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=255))]
    pub(crate) leaf_size: Option<u32>,
    /// Effort for the hierarchy: fast, standard, or high, which goes on while the picture renders
    #[arg(long, value_name = "QUALITY", value_parser = values::named::<BvhQuality>)]
    pub(crate) bvh_quality: Option<BvhQuality>,
    /// Instruction set: portable, avx2 or avx512 [default: SOFTBOX_ISA, else the best of this processor]
    #[arg(long, value_parser = Isa::usable)]
    pub(crate) isa: Option<Isa>,
    /// Reproduce the course program's picture with its errors: light, exposure, gamma, view, normals
    #[arg(long)]
    pub(crate) course_compatible: bool,
    /// Exposure in stops [default: 0]
    #[arg(long, value_name = "STOPS", allow_hyphen_values = true, value_parser = values::finite)]
    pub(crate) exposure: Option<f32>,
    /// Tone curve: srgb, course, reinhard or filmic
    #[arg(long, value_name = "CURVE", value_parser = values::named::<ToneCurve>)]
    pub(crate) tone_curve: Option<ToneCurve>,
    #[command(flatten)]
    pub(crate) camera: CameraArgs,
    /// Picture of the surroundings (.exr, .hdr, .pfm or .png), latitude-longitude
    #[arg(short = 'e', long, value_name = "FILE")]
    pub(crate) environment: Option<PathBuf>,
}

/// The options of the camera; points are in the file's coordinates, y up.
#[derive(Args, Clone, Debug, Default, PartialEq)]
pub(crate) struct CameraArgs {
    /// Camera file of the course's program
    #[arg(short = 'c', long = "camera", value_name = "FILE")]
    pub(crate) file: Option<PathBuf>,
    /// Where the camera comes from: auto, course, file or fit
    #[arg(long = "camera-rule", value_name = "RULE", value_parser = values::named::<CameraRule>)]
    pub(crate) rule: Option<CameraRule>,
    /// Where the camera stands
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = values::point)]
    pub(crate) eye: Option<DVec3>,
    /// Where it looks
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = values::point)]
    pub(crate) target: Option<DVec3>,
    /// Which way is up
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = values::point)]
    pub(crate) up: Option<DVec3>,
    /// Horizontal angle of view
    #[arg(long, value_name = "DEGREES", value_parser = values::degrees, conflicts_with = "yfov")]
    pub(crate) xfov: Option<f64>,
    /// Vertical angle of view
    #[arg(long, value_name = "DEGREES", value_parser = values::degrees)]
    pub(crate) yfov: Option<f64>,
    /// Cut the picture out of the 800x600 view, as the course's -r does, instead of scaling it
    #[arg(long)]
    pub(crate) crop_view: bool,
    /// Radius of the lens, 0 for a pinhole
    #[arg(short = 'b', long, value_name = "R", value_parser = values::not_negative)]
    pub(crate) lens_radius: Option<f64>,
    /// Distance of the plane in focus
    #[arg(short = 'd', long, value_name = "D", value_parser = values::positive)]
    pub(crate) focal_distance: Option<f64>,
}

impl SettingsArgs {
    /// `settings` with everything that was given in its place.
    pub(crate) fn apply(&self, mut settings: RenderSettings) -> RenderSettings {
        fn set<T: Copy>(place: &mut T, given: Option<T>) {
            *place = given.unwrap_or(*place);
        }
        if let Some([width, height]) = self.size {
            (settings.width, settings.height) = (width, height);
        }
        settings.region = self.region.or(settings.region);
        set(&mut settings.light_samples, self.light_samples);
        set(&mut settings.max_depth, self.max_depth);
        settings.only_last_bounce |= self.only_last_bounce;
        set(&mut settings.mode, self.mode);
        set(&mut settings.reuse, self.reuse);
        set(&mut settings.integrator, self.integrator);
        set(&mut settings.seed, self.seed);
        settings.course_compatible |= self.course_compatible;
        set(&mut settings.bvh.kind, self.bvh);
        set(&mut settings.bvh.leaf_size, self.leaf_size);
        set(&mut settings.bvh.quality, self.bvh_quality);
        set(&mut settings.threads, self.threads);
        set(&mut settings.view, self.view);
        settings.isa = self.isa.or(settings.isa);
        if let Some((batch, tolerance)) = self.adaptive {
            settings.adaptive = Some(self.adaptive(batch, tolerance));
        }
        settings
    }

    /// Adaptive sampling with the goal that was asked for.
    pub(crate) fn adaptive(&self, batch: u32, tolerance: f32) -> Adaptive {
        let own = if self.course_compatible {
            AdaptiveGoal::Course
        } else {
            AdaptiveGoal::default()
        };
        Adaptive {
            batch,
            tolerance,
            goal: self.adaptive_goal.unwrap_or(own),
            exposure: self.adaptive_exposure.or(self.exposure).unwrap_or(0.0),
        }
    }

    /// How the picture is displayed: the course's curve for its compatible picture, unless told.
    pub(crate) fn display(&self) -> DisplaySettings {
        let own = if self.course_compatible {
            ToneCurve::Course
        } else {
            ToneCurve::default()
        };
        DisplaySettings {
            exposure: self.exposure.unwrap_or(0.0),
            tone_curve: self.tone_curve.unwrap_or(own),
        }
    }

    /// The camera that was asked for; `crops` when the form of the command line crops by itself.
    pub(crate) fn camera(&self, crops: bool) -> CameraChoice {
        let given = &self.camera;
        let fov = given
            .xfov
            .map(FieldOfView::X)
            .or(given.yfov.map(FieldOfView::Y));
        let own_rule = if self.course_compatible {
            CameraRule::Course
        } else {
            CameraRule::Auto
        };
        CameraChoice {
            file: given.file.clone(),
            rule: given.rule.unwrap_or(own_rule),
            eye: given.eye,
            target: given.target,
            up: given.up,
            fov,
            crops: crops || given.crop_view || self.course_compatible,
            lens_radius: given.lens_radius,
            focal_distance: given.focal_distance,
        }
    }
}
