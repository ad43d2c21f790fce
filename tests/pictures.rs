//! Pictures survive their files; files appear whole or not at all.

use std::fs;
use std::path::{Path, PathBuf};

use softbox::color::{Rgb, srgb_decode};
use softbox::io::picture::{
    Metadata, OutputError, PictureError, append_extension, check_writable, numbered_path,
    read_environment, read_exr, read_picture, read_png, write_exr, write_hdr, write_linear,
    write_pfm, write_png,
};

const WIDTH: usize = 37;
const HEIGHT: usize = 21;

fn gradient() -> Vec<Rgb> {
    (0..WIDTH * HEIGHT)
        .map(|i| {
            let t = i as f32 * 0.613;
            Rgb::new(t.sin().abs() * 3.0, (t * 1.7).cos().abs(), 1e-3 * i as f32)
        })
        .collect()
}

fn metadata() -> Metadata {
    let mut metadata = Metadata::default();
    metadata.set("version", "0.1.0");
    metadata.set("seed", "18446744073709551615");
    metadata.set("settings", "{\"width\":37,\"text\":\"line\\nbreak\"}");
    metadata.set("scene", "Räume/箱.dae");
    metadata.set(Metadata::COMMAND, "softbox render 'a b.dae'\n-o x.exr");
    metadata
}

fn bits(pixels: &[Rgb]) -> Vec<[u32; 3]> {
    pixels
        .iter()
        .map(|p| p.to_array().map(f32::to_bits))
        .collect()
}

fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the test's folder exists");
    let mut names: Vec<String> = entries
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn exr_keeps_every_bit_and_every_word() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let mut pixels = gradient();
    pixels[3] = Rgb::new(f32::NAN, f32::INFINITY, -0.0);
    pixels[4] = Rgb::new(f32::MIN_POSITIVE / 8.0, f32::MAX, f32::NEG_INFINITY);
    write_exr(&path, WIDTH, HEIGHT, &pixels, &metadata()).unwrap();
    let read = read_picture(&path).unwrap();
    assert_eq!((read.image.width(), read.image.height()), (WIDTH, HEIGHT));
    assert_eq!(bits(read.image.pixels()), bits(&pixels));
    assert_eq!(read.metadata, metadata());
    assert_eq!(names_in(folder.path()), ["a.exr"]);
}

#[test]
fn exr_names_its_primaries_and_is_the_same_file_every_time() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str| {
        let path = folder.path().join(name);
        write_exr(&path, WIDTH, HEIGHT, &gradient(), &metadata()).unwrap();
        path
    };
    let first = write("a.exr");
    for name in ["b.exr", "c.exr", "d.exr"] {
        assert!(fs::read(&first).unwrap() == fs::read(write(name)).unwrap());
    }
    let header = exr::meta::MetaData::read_from_file(&first, true).unwrap();
    let header = &header.headers[0];
    let primaries = header.shared_attributes.chromaticities.unwrap();
    assert_eq!((primaries.red.x(), primaries.white.y()), (0.64, 0.329));
    let comments = header.own_attributes.comments.as_ref().unwrap();
    assert_eq!(
        Some(comments.to_string().as_str()),
        metadata().get("command")
    );
}

/// A half-float file with a data window smaller than and outside of the display window, and a
/// channel that is no colour.
#[test]
fn exr_windows_and_half_floats_are_placed() {
    use exr::prelude::*;
    let path = tempfile::tempdir().unwrap().keep().join("w.exr");
    let channel = |name: &str, base: f32| {
        let values = (0..6).map(|i| f16::from_f32(base + i as f32)).collect();
        AnyChannel::new(name, FlatSamples::F16(values))
    };
    let list = smallvec_of([
        channel("B", 200.0),
        channel("Z", 900.0),
        channel("R", 0.0),
        channel("G", 100.0),
    ]);
    let attributes = LayerAttributes::default().with_position(Vec2(12, 19));
    let layer = Layer::new(
        (3, 2),
        attributes,
        Encoding::FAST_LOSSLESS,
        AnyChannels::sort(list),
    );
    let display = IntegerBounds::new((10, 20), (4, 3));
    Image::empty(ImageAttributes::new(display))
        .with_layer(layer)
        .write()
        .to_file(&path)
        .unwrap();
    let read = read_exr(&path).unwrap().image;
    fs::remove_dir_all(path.parent().unwrap()).unwrap();
    assert_eq!((read.width(), read.height()), (4, 3));
    // Data row 1 (y = 20) is display row 0; data column 0 (x = 12) is display column 2.
    let v = |k: f32| Rgb::new(k, 100.0 + k, 200.0 + k);
    let black = Rgb::ZERO;
    assert_eq!(read.pixels()[..4], [black, black, v(3.0), v(4.0)]);
    assert!(read.pixels()[4..].iter().all(|&p| p == black));
}

fn smallvec_of(
    channels: [exr::prelude::AnyChannel<exr::prelude::FlatSamples>; 4],
) -> exr::prelude::SmallVec<[exr::prelude::AnyChannel<exr::prelude::FlatSamples>; 4]> {
    channels.into_iter().collect()
}

#[test]
fn reference_pictures_can_be_read() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/references");
    let Ok(scenes) = fs::read_dir(root) else {
        return;
    };
    for scene in scenes {
        let path = scene.unwrap().path().join("d5.exr");
        if path.exists() {
            let image = read_picture(&path).unwrap().image;
            assert_eq!((image.width(), image.height()), (480, 360), "{path:?}");
            let sum: f32 = image.pixels().iter().map(|p| p.element_sum()).sum();
            assert!(sum > 1.0 && sum.is_finite(), "{path:?}");
        }
    }
}

#[test]
fn hdr_keeps_its_precision_and_its_words() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.HDR");
    let mut pixels = gradient();
    pixels[0] = Rgb::new(1e-30, 1e30, 1e10);
    pixels[1] = Rgb::ZERO;
    write_hdr(&path, WIDTH, HEIGHT, &pixels, &metadata()).unwrap();
    let read = read_picture(&path).unwrap();
    assert_eq!(read.metadata, metadata());
    for (r, p) in read.image.pixels().iter().zip(&pixels) {
        let off = (*r - *p).abs().max_element();
        assert!(off <= p.max_element() / 256.0, "{r} {p}");
    }
    assert_eq!(read.image.pixels()[1], Rgb::ZERO);
}

#[test]
fn hdr_exposure_is_taken_off() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.hdr");
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=4.0\n\n-Y 1 +X 1\n".to_vec();
    bytes.extend([128, 64, 0, 129]);
    fs::write(&path, bytes).unwrap();
    let image = read_picture(&path).unwrap().image;
    assert_eq!(image.pixels(), [Rgb::new(0.25, 0.125, 0.0)]);
}

#[test]
fn pfm_keeps_every_bit_and_reads_both_byte_orders() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.pfm");
    let mut pixels = gradient();
    pixels[7] = Rgb::new(f32::NAN, f32::NEG_INFINITY, 1e-42);
    write_linear(&path, WIDTH, HEIGHT, &pixels, &metadata()).unwrap();
    assert_eq!(
        bits(read_picture(&path).unwrap().image.pixels()),
        bits(&pixels)
    );

    let mut grey = b"Pf\n1 2\n1.0\n".to_vec();
    grey.extend(5.0_f32.to_be_bytes());
    grey.extend(7.0_f32.to_be_bytes());
    fs::write(&path, &grey).unwrap();
    let image = read_picture(&path).unwrap().image;
    assert_eq!(image.pixels(), [Rgb::splat(7.0), Rgb::splat(5.0)]);
    fs::write(&path, &grey[..grey.len() - 1]).unwrap();
    assert!(matches!(
        read_picture(&path),
        Err(PictureError::Decode { .. })
    ));
}

#[test]
fn png_keeps_every_byte_and_every_word_but_is_not_linear_data() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let bytes: Vec<[u8; 3]> = (0..WIDTH * HEIGHT)
        .map(|i| [i as u8, (i / 3) as u8, 255 - i as u8])
        .collect();
    write_png(&path, WIDTH, HEIGHT, &bytes, &metadata()).unwrap();
    let read = read_png(&path).unwrap();
    assert_eq!(read.metadata, metadata());
    let decoded = bytes
        .iter()
        .map(|p| Rgb::from_array(p.map(|c| srgb_decode(f32::from(c) / 255.0))));
    assert!(read.image.pixels().iter().copied().eq(decoded));
    assert_eq!(read_environment(&path).unwrap(), read);
    let refused = read_picture(&path).unwrap_err();
    assert!(refused.to_string().contains("not linear data"), "{refused}");
}

#[test]
fn damaged_files_are_refused_in_one_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("whole.exr");
    let damaged = folder.path().join("damaged");
    write_exr(&path, WIDTH, HEIGHT, &gradient(), &metadata()).unwrap();
    let exr = fs::read(&path).unwrap();
    write_hdr(&path, WIDTH, HEIGHT, &gradient(), &metadata()).unwrap();
    let hdr = fs::read(&path).unwrap();
    let bytes = vec![[1, 2, 3]; WIDTH * HEIGHT];
    write_png(&path, WIDTH, HEIGHT, &bytes, &metadata()).unwrap();
    let png = fs::read(&path).unwrap();
    for whole in [exr, hdr, png] {
        for length in (0..whole.len()).step_by(whole.len() / 40) {
            fs::write(&damaged, &whole[..length]).unwrap();
            let error = read_environment(&damaged).unwrap_err().to_string();
            assert!(
                error.starts_with("Cannot read '") && error.ends_with('.'),
                "{error}"
            );
            assert!(!error.contains('\n'), "{error}");
        }
    }
    for huge in [
        "PF\n99999999 99999999\n-1.0\n",
        "#?RADIANCE\n\n-Y 60000 +X 60000\n",
    ] {
        fs::write(&damaged, huge).unwrap();
        assert!(matches!(
            read_picture(&damaged),
            Err(PictureError::Decode { .. })
        ));
    }
    let missing = read_picture(&folder.path().join("no.exr"));
    assert!(matches!(missing, Err(PictureError::Io { .. })));
}

#[test]
fn a_failed_write_leaves_the_old_file_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    fs::write(&path, "old").unwrap();
    // PNG does not know pictures without pixels; the encoder refuses after the file was opened.
    assert!(write_png(&path, 0, 0, &[], &metadata()).is_err());
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(names_in(folder.path()), ["a.png"]);
    write_png(&path, 1, 1, &[[1, 2, 3]], &metadata()).unwrap();
    assert!(fs::read(&path).unwrap().starts_with(b"\x89PNG"));
    assert_eq!(names_in(folder.path()), ["a.png"]);
}

#[cfg(unix)]
#[test]
fn files_get_ordinary_permissions_and_links_stay_links() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let plain = folder.path().join("plain");
    fs::write(&plain, "").unwrap();
    let path = folder.path().join("a.pfm");
    let link = folder.path().join("link.pfm");
    write_pfm(&path, 1, 1, &[Rgb::ONE]).unwrap();
    std::os::unix::fs::symlink(&path, &link).unwrap();
    write_pfm(&link, 1, 1, &[Rgb::ZERO]).unwrap();
    let mode = |p: &Path| fs::metadata(p).unwrap().permissions().mode();
    assert_eq!(mode(&path), mode(&plain));
    assert!(link.is_symlink());
    assert_eq!(read_picture(&path).unwrap().image.pixels(), [Rgb::ZERO]);
}

#[test]
fn unwritable_outputs_are_found_and_nothing_is_left_behind() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("dir.png")).unwrap();
    fs::write(at("locked.exr"), "kept").unwrap();
    let mut locked = fs::metadata(at("locked.exr")).unwrap().permissions();
    locked.set_readonly(true);
    fs::set_permissions(at("locked.exr"), locked).unwrap();

    let check = |name: &str| check_writable(&at(name));
    assert!(check("new.png").is_ok() && check("new.EXR").is_ok());
    assert!(matches!(
        check("x.jpg"),
        Err(OutputError::UnknownExtension { .. })
    ));
    assert!(matches!(
        check("noextension"),
        Err(OutputError::UnknownExtension { .. })
    ));
    assert!(matches!(
        check("dir.png"),
        Err(OutputError::NotAFile { .. })
    ));
    assert!(matches!(
        check("missing/x.png"),
        Err(OutputError::NoFolder { .. })
    ));
    assert!(matches!(
        check("locked.exr/x.png"),
        Err(OutputError::NoFolder { .. })
    ));
    assert!(matches!(
        check("locked.exr"),
        Err(OutputError::ReadOnly { .. })
    ));
    assert_eq!(names_in(folder.path()), ["dir.png", "locked.exr"]);
    let message = check("missing/x.png").unwrap_err().to_string();
    assert!(
        message.contains("does not exist") && message.ends_with('.'),
        "{message}"
    );
}

#[test]
fn a_folder_without_permission_is_found() {
    let folder = Path::new("/proc");
    if folder.is_dir() {
        let error = check_writable(&folder.join("x.png")).unwrap_err();
        assert!(matches!(error, OutputError::Io { .. }), "{error}");
    }
}

#[test]
fn snapshots_never_overwrite() {
    let folder = tempfile::tempdir().unwrap();
    let next = || numbered_path(folder.path(), "box_1.5spp", &["png", "exr"]);
    let expect = |n: &str| folder.path().join(format!("box_1.5spp_{n}"));
    assert_eq!(next(), expect("001"));
    fs::write(append_extension(&next(), "exr"), "").unwrap();
    assert_eq!(next(), expect("002"));
    fs::write(append_extension(&next(), "png"), "").unwrap();
    let third: PathBuf = next();
    assert_eq!(
        append_extension(&third, "png"),
        folder.path().join("box_1.5spp_003.png")
    );
}
