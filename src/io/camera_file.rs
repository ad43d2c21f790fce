//! The course program's camera files (`-c`; it writes them as `NAME_cam_settings.txt`): thirty
//! numbers as text.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use glam::{DMat3, DVec3};

use super::picture::{OutputError, write_whole};

/// What a camera file holds, in its own order. Points are in the file's units, world y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraFile {
    /// Full horizontal angle of view in degrees.
    pub hfov: f64,
    /// Full vertical angle of view in degrees.
    pub vfov: f64,
    /// Width over height.
    pub aspect: f64,
    /// Distance of the near clipping plane; softbox does not clip.
    pub near: f64,
    /// Distance of the far clipping plane; softbox does not clip.
    pub far: f64,
    /// Where the camera stands.
    pub position: DVec3,
    /// Where it looks.
    pub target: DVec3,
    /// Polar angle of the position as seen from the target, from +y, radians.
    pub phi: f64,
    /// Azimuth of the position as seen from the target, radians.
    pub theta: f64,
    /// Distance from the target.
    pub distance: f64,
    /// Smallest distance that the course's window allows.
    pub min_distance: f64,
    /// Largest distance that the course's window allows.
    pub max_distance: f64,
    /// Directions of the camera (x right, y up, looking along −z) to the world.
    pub world_from_camera: DMat3,
    /// Width of the window in pixels.
    pub width: f64,
    /// Height of the window in pixels.
    pub height: f64,
    /// Distance of a screen with pixels of size 1, (height / 2) / tan(vfov / 2).
    pub screen_distance: f64,
    /// Distance of the plane in focus.
    pub focal_distance: f64,
    /// Radius of the lens, 0 = pinhole.
    pub lens_radius: f64,
}

/// Why a camera file cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum CameraFileError {
    /// The operating system refused.
    #[error("Cannot read the camera file '{}': {source}.", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// Its reason.
        source: std::io::Error,
    },
    /// The content is not that of a camera file.
    #[error("Cannot read the camera file '{}': {reason}.", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
}

/// Numbers in a complete file; older ones end before the lens (two fewer).
const COUNT: usize = 30;
const COUNT_WITHOUT_LENS: usize = 28;
/// The course's focal distance when nothing is given.
const DEFAULT_FOCAL_DISTANCE: f64 = 4.7;

/// Reads a camera file.
///
/// # Errors
/// When the file cannot be read, or does not hold 30 (or, without the lens, 28) finite numbers that
/// make a camera.
pub fn read_camera_file(path: &Path) -> Result<CameraFile, CameraFileError> {
    let text = std::fs::read_to_string(path).map_err(|source| CameraFileError::Io {
        path: path.into(),
        source,
    })?;
    parse(&text).map_err(|reason| CameraFileError::Content {
        path: path.into(),
        reason,
    })
}

/// Writes a camera file that the course's program reads too.
///
/// # Errors
/// When the file cannot be written.
pub fn write_camera_file(path: &Path, camera: &CameraFile) -> Result<(), OutputError> {
    let text = format(camera);
    write_whole(path, |file| {
        file.write_all(text.as_bytes())
            .map_err(|source| OutputError::Io {
                path: path.into(),
                source,
            })
    })
}

fn parse(text: &str) -> Result<CameraFile, String> {
    let mut numbers = Vec::with_capacity(COUNT);
    for word in text.split_whitespace() {
        let number: f64 = word
            .parse()
            .map_err(|_| format!("'{word}' is not a number"))?;
        if !number.is_finite() {
            return Err(format!("'{word}' is not a finite number"));
        }
        numbers.push(number);
    }
    match numbers.len() {
        COUNT => {}
        COUNT_WITHOUT_LENS => numbers.extend([DEFAULT_FOCAL_DISTANCE, 0.0]),
        other => return Err(format!("it holds {other} numbers instead of {COUNT}")),
    }
    let n = |index: usize| numbers[index];
    let v = |index: usize| DVec3::new(n(index), n(index + 1), n(index + 2));
    let camera = CameraFile {
        hfov: n(0),
        vfov: n(1),
        aspect: n(2),
        near: n(3),
        far: n(4),
        position: v(5),
        target: v(8),
        phi: n(11),
        theta: n(12),
        distance: n(13),
        min_distance: n(14),
        max_distance: n(15),
        world_from_camera: DMat3::from_cols(v(16), v(19), v(22)).transpose(),
        width: n(25),
        height: n(26),
        screen_distance: n(27),
        focal_distance: n(28),
        lens_radius: n(29),
    };
    let is_angle = |degrees: f64| degrees > 0.0 && degrees < 180.0;
    if !is_angle(camera.hfov) || !is_angle(camera.vfov) {
        return Err("its angles of view are not between 0 and 180 degrees".to_owned());
    }
    if (camera.world_from_camera.determinant() - 1.0).abs() > 1e-3 {
        return Err("its camera-to-world matrix is not a rotation".to_owned());
    }
    Ok(camera)
}

fn format(camera: &CameraFile) -> String {
    let c = camera;
    let rows = c.world_from_camera.transpose().to_cols_array_2d();
    let (p, t) = (c.position, c.target);
    let mut lines = vec![
        vec![c.hfov, c.vfov, c.aspect, c.near, c.far],
        vec![p.x, p.y, p.z, t.x, t.y, t.z],
        vec![c.phi, c.theta, c.distance, c.min_distance, c.max_distance],
    ];
    lines.push(rows.concat());
    lines.push(vec![c.width, c.height, c.screen_distance]);
    lines.push(vec![c.focal_distance, c.lens_radius]);
    let mut text = String::new();
    for line in lines {
        let words: Vec<String> = line.iter().map(f64::to_string).collect();
        writeln!(text, "{}", words.join(" ")).expect("writing to a String cannot fail");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As the course's program writes it: six digits, one line for each group.
    const SAMPLE: &str = "50 37.8493 1.33333 0.001 1000\n\
        -1 2 4.8 0 0.75 0\n\
        1.5708 0 4.80177 0.240088 48.0177\n\
        0 0 1 1 0 0 0 1 0\n\
        800 600 875\n\
        4.7 0.05\n";

    #[test]
    fn the_courses_files_are_understood() {
        let camera = parse(SAMPLE).unwrap();
        assert_eq!((camera.hfov, camera.vfov), (50.0, 37.8493));
        assert_eq!(camera.position, DVec3::new(-1.0, 2.0, 4.8));
        assert_eq!(camera.target, DVec3::new(0.0, 0.75, 0.0));
        // Row by row: the camera's x is the world's y.
        assert_eq!(camera.world_from_camera * DVec3::X, DVec3::Y);
        assert_eq!(camera.world_from_camera * DVec3::Z, DVec3::X);
        assert_eq!((camera.focal_distance, camera.lens_radius), (4.7, 0.05));
        let (without_lens, _) = SAMPLE.rsplit_once("4.7").unwrap();
        assert_eq!(parse(without_lens).unwrap().lens_radius, 0.0);
    }

    #[test]
    fn files_are_written_as_they_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x_cam_settings.txt");
        let mut camera = parse(SAMPLE).unwrap();
        camera.theta = 0.1 + 0.2;
        write_camera_file(&path, &camera).unwrap();
        assert_eq!(read_camera_file(&path).unwrap(), camera);
        assert_eq!(format(&parse(SAMPLE).unwrap()), SAMPLE);
    }

    #[test]
    fn anything_else_is_refused_with_a_reason() {
        let reason = |text: &str| parse(text).unwrap_err();
        assert!(reason("").contains("0 numbers"));
        assert!(reason(&SAMPLE.replace("875", "wide")).contains("'wide'"));
        assert!(reason(&SAMPLE.replace("875", "inf")).contains("finite"));
        assert!(reason(&SAMPLE.replace("50 37", "-50 37")).contains("angles"));
        assert!(reason(&SAMPLE.replace("0 0 1 1", "0 0 1 7")).contains("rotation"));
    }
}
