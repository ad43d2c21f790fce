//! A finished picture that the running one is held against, and whether it fits.

use std::path::Path;

use softbox::camera::{Camera, Framing};
use softbox::color::Rgb;
use softbox::image::{Image, score};
use softbox::io::picture::{Metadata, read_picture};
use softbox::session::Snapshot;
use softbox::settings::{MaxDepth, RenderSettings};

use super::loader::file_name;

/// Relative difference up to which two numbers of cameras are the same: one was text meanwhile.
const ROUNDING: f64 = 1e-9;

/// A finished picture, with what its file says about its making.
#[derive(Clone, Debug)]
pub(super) struct ReferencePicture {
    /// Name of its file.
    pub(super) name: String,
    image: Image<Rgb>,
    camera: Option<Camera>,
    max_depth: Option<MaxDepth>,
}

impl ReferencePicture {
    /// Reads a linear picture.
    ///
    /// # Errors
    /// One sentence when it cannot be read.
    pub(super) fn read(path: &Path) -> Result<Self, String> {
        let picture = read_picture(path).map_err(|error| error.to_string())?;
        Ok(Self {
            name: file_name(path),
            image: picture.image,
            camera: said(&picture.metadata, "camera"),
            max_depth: said(&picture.metadata, "settings").map(|s: RenderSettings| s.max_depth),
        })
    }

    /// relMSE of the rendered region of `snapshot`.
    ///
    /// # Errors
    /// One sentence when the two pictures do not show the same.
    pub(super) fn rel_mse(&self, snapshot: &Snapshot) -> Result<f64, String> {
        self.check(snapshot)?;
        let (width, height) = (snapshot.width, snapshot.height);
        let image = Image::from_pixels(width, height, snapshot.pixels.clone());
        let region = snapshot.settings.active_region();
        let scored = score(&image.part(region), &self.image.part(region));
        scored.map(|s| s.rel_mse).map_err(|error| error.to_string())
    }

    fn check(&self, snapshot: &Snapshot) -> Result<(), String> {
        let name = &self.name;
        let size = (self.image.width(), self.image.height());
        if size != (snapshot.width, snapshot.height) {
            return Err(format!(
                "{name} has {} x {} pixels, the picture {} x {}: set the picture's size to it.",
                size.0, size.1, snapshot.width, snapshot.height
            ));
        }
        if self
            .camera
            .is_some_and(|camera| !is_same(&camera, &snapshot.camera))
        {
            return Err(format!("{name} was made with another camera."));
        }
        let depth = snapshot.settings.max_depth;
        match self.max_depth {
            Some(other) if other != depth => Err(format!(
                "{name} has up to {other} bounces, the picture {depth}."
            )),
            _ => Ok(()),
        }
    }
}

/// What the file says under `key`, if anything.
fn said<T: serde::de::DeserializeOwned>(metadata: &Metadata, key: &str) -> Option<T> {
    serde_json::from_str(metadata.get(key)?).ok()
}

fn is_same(a: &Camera, b: &Camera) -> bool {
    let close = |x: f64, y: f64| (x - y).abs() <= ROUNDING * x.abs().max(y.abs()).max(1e-3);
    let vectors = [(a.eye, b.eye), (a.target, b.target), (a.up, b.up)];
    let framing = match (a.framing, b.framing) {
        (Framing::Horizontal(x), Framing::Horizontal(y))
        | (Framing::ScreenDistance(x), Framing::ScreenDistance(y)) => close(x, y),
        _ => false,
    };
    let is_focused = a.lens_radius == 0.0 || close(a.focal_distance, b.focal_distance);
    framing
        && is_focused
        && close(a.lens_radius, b.lens_radius)
        && vectors
            .iter()
            .all(|(v, w)| (0..3).all(|i| close(v[i], w[i])))
}
