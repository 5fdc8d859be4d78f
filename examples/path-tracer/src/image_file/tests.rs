//! Round trips, hostile files, and what is left on the disk.

use std::fs;
use std::path::PathBuf;

use super::*;

fn picture() -> Image {
    let values = [0.0, 1.0, -1.0, 0.18, 1e-30, 1e30, f32::MAX, f32::MIN_POSITIVE, 3.5, 100.0, 0.5, 0.25];
    let pixels = (0..35).map(|i| [values[i % 12], i as f32, values[(i * 5) % 12]]).collect();
    Image { width: 7, height: 5, pixels }
}

fn folder() -> (tempfile::TempDir, impl Fn(&str) -> PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().to_owned();
    (folder, move |name: &str| root.join(name))
}

fn names(folder: &tempfile::TempDir) -> Vec<String> {
    let names = fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = names.collect();
    names.sort();
    names
}

#[test]
fn linear_formats_keep_every_bit() {
    let (dir, at) = folder();
    for name in ["a.pfm", "a.EXR"] {
        picture().write(&at(name), 3.0).unwrap();
        assert_eq!(Image::read(&at(name)).unwrap(), picture(), "{name}");
        assert_eq!(Image::read_sized(&at(name), 7, 5).unwrap(), picture(), "{name}");
        let error = Image::read_sized(&at(name), 5, 7).unwrap_err().to_string();
        assert!(error.ends_with(": is 7x5, 5x7 is needed"), "{error}");
    }
    // A picture replaces another.
    let one = Image { width: 1, height: 1, pixels: vec![[f32::INFINITY, 2.0, 3.0]] };
    one.write(&at("a.pfm"), 0.0).unwrap();
    assert_eq!(Image::read(&at("a.pfm")).unwrap(), one);
    assert_eq!(names(&dir), ["a.EXR", "a.pfm"]);
}

#[test]
fn pfm_is_bottom_up_and_little_endian() {
    let (_dir, at) = folder();
    let image = Image { width: 1, height: 2, pixels: vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]] };
    image.write(&at("a.pfm"), 0.0).unwrap();
    let bytes = fs::read(at("a.pfm")).unwrap();
    let mut expected = b"PF\n1 2\n-1.0\n".to_vec();
    expected.extend([4.0_f32, 5.0, 6.0, 1.0, 2.0, 3.0].iter().flat_map(|x| x.to_le_bytes()));
    assert_eq!(bytes, expected);
    // Big-endian and grey, as others write them.
    let mut grey = b"Pf\r2  1\r1.0 ".to_vec();
    grey.extend([0.5_f32, 7.0].iter().flat_map(|x| x.to_be_bytes()));
    fs::write(at("b.pfm"), grey).unwrap();
    assert_eq!(Image::read(&at("b.pfm")).unwrap().pixels, [[0.5; 3], [7.0; 3]]);
}

#[test]
fn png_is_tone_mapped() {
    let (_dir, at) = folder();
    let special = [[f32::NAN, f32::INFINITY, f32::NEG_INFINITY], [1.0; 3], [0.0, 1e30, f32::MAX]];
    let image = Image { width: 3, height: 1, pixels: special.to_vec() };
    image.write(&at("a.png"), 0.0).unwrap();
    let decoder = png::Decoder::new(io::BufReader::new(File::open(at("a.png")).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!((info.width, info.height, info.color_type), (3, 1, png::ColorType::Rgb));
    // The curve takes 1 to 2.54 / 3.16 = 0.804, of which the sRGB code is 231.6.
    assert_eq!(bytes, [0, 255, 0, 232, 232, 232, 0, 255, 255]);

    let steps = (0..=2000).map(|i| tone_map(i as f32 * 0.01));
    assert!(steps.clone().zip(steps.skip(1)).all(|(a, b)| a <= b), "must be monotonic");
    assert_eq!((tone_map(0.0), tone_map(1e6)), (0.0, 1.0));
}

#[test]
fn extensions_are_named() {
    for name in ["a.jpg", "png", "a", ""] {
        let error = ImageFormat::of(Path::new(name)).unwrap_err().to_string();
        assert_eq!(error, format!("{name}: a picture ends in .png (tone-mapped), .exr or .pfm (both linear)"));
    }
    let error = Image::read(Path::new("a.png")).unwrap_err().to_string();
    assert_eq!(error, "a.png: a linear picture ends in .pfm or .exr");
}

#[test]
fn pfm_faults_are_named() {
    let (_dir, at) = folder();
    let cases: [(&[u8], &str); 11] = [
        (b"", "does not begin with 'PF': it is not a portable float map"),
        (b"P6\n1 1\n255\n", "does not begin with 'PF': it is not a portable float map"),
        (b"PF", "ends within the header: it has no width"),
        (b"PF\n3", "ends within the header: it has no height"),
        (b"PF\n0 1\n-1\n", "the width in the header, \"0\", is not a positive integer"),
        (b"PF\n1 -1\n-1\n", "the height in the header, \"-1\", is not a positive integer"),
        (b"PF\n1 1\n0\n", "the scale in the header, \"0\", is neither a positive nor a negative number"),
        (b"PF\n1 1\n", "the scale in the header, \"\", is neither a positive nor a negative number"),
        (b"PF\n1 1\n-1.0\n12345678901", "is cut short: 11 bytes of pixels, 1x1 has 12"),
        (b"PF\n1 1\n-1.0\n1234567890123", "is too long: 13 bytes of pixels, 1x1 has 12"),
        (b"PF\n4294967295 4294967295\n-1.0\n1", "4294967295x4294967295 is more than 2^30 pixels"),
    ];
    for (bytes, expected) in cases {
        fs::write(at("a.pfm"), bytes).unwrap();
        let error = Image::read(&at("a.pfm")).unwrap_err().to_string();
        assert!(error.ends_with(&format!("a.pfm: {expected}")), "{error}");
    }
    let missing = Image::read(&at("b.pfm")).unwrap_err().to_string();
    assert!(missing.contains("b.pfm: cannot be read: No such file"), "{missing}");
    fs::create_dir(at("c.exr")).unwrap();
    let error = Image::read(&at("c.exr")).unwrap_err().to_string();
    assert!(error.ends_with("c.exr: cannot be read: it is not a regular file"), "{error}");
}

#[test]
fn damaged_pictures_never_panic() {
    let (_dir, at) = folder();
    let mut state = 7_u64;
    let mut random = move |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % n.max(1)
    };
    for (name, cases) in [("a.pfm", 2000), ("a.exr", 3000)] {
        picture().write(&at(name), 0.0).unwrap();
        let valid = fs::read(at(name)).unwrap();
        let (mut good, mut bad) = (0, 0);
        for case in 0..cases {
            let mut bytes = valid.clone();
            if case < 400 {
                bytes.truncate(case * valid.len() / 400);
            }
            for _ in 0..random(4) {
                let i = random(bytes.len());
                if let Some(byte) = bytes.get_mut(i) {
                    *byte = if random(2) == 0 { random(256) as u8 } else { *byte ^ (1 << random(8)) };
                }
            }
            let decode: Decoder =
                if name == "a.pfm" { (pfm::size, pfm::read) } else { (exr_file::size, exr_file::read) };
            // As `read` does it: a huge header is refused before it is believed.
            match (decode.0)(&bytes).and_then(
                |size| {
                    if size == (7, 5) { (decode.1)(&bytes) } else { Err(String::new()) }
                },
            ) {
                Ok(image) => {
                    assert_eq!(image.pixels.len() as u64, u64::from(image.width) * u64::from(image.height));
                    good += 1;
                }
                Err(why) => {
                    assert!(!why.contains('\n'), "{why}");
                    bad += 1;
                }
            }
        }
        assert!(good > 50 && bad > 50, "{name}: {good} good, {bad} bad");
    }
}

#[test]
fn a_failed_write_leaves_nothing() {
    let (dir, at) = folder();
    fs::write(at("a.png"), b"old").unwrap();
    let error = write_beside(&at("a.png"), |to| {
        to.write_all(&[0; 100_000])?;
        Err(io::Error::other("the disk is full"))
    });
    assert!(error.unwrap_err().to_string().ends_with("a.png: cannot be written: the disk is full"));
    assert_eq!(fs::read(at("a.png")).unwrap(), b"old");
    let wrong = Image { width: 2, height: 2, pixels: vec![[0.0; 3]; 3] };
    let error = wrong.write(&at("a.png"), 0.0).unwrap_err().to_string();
    assert!(error.ends_with("3 pixels are no picture of 2x2"), "{error}");
    assert!(Image::default().write(&at("a.exr"), 0.0).is_err());
    assert_eq!(names(&dir), ["a.png"]);
}

#[test]
fn targets_are_checked_before_rendering() {
    let (dir, at) = folder();
    fs::create_dir(at("folder.png")).unwrap();
    fs::write(at("file"), b"").unwrap();
    fs::write(at("closed.png"), b"").unwrap();
    let mut permissions = fs::metadata(at("closed.png")).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(at("closed.png"), permissions).unwrap();
    for (path, expected) in [
        (at("folder.png"), "cannot be written: it is a folder"),
        (at("closed.png"), "cannot be written: it is read-only"),
        (at("missing/a.png"), "missing: No such file"),
        (at("file/a.png"), "file is not a folder"),
        (PathBuf::from("/dev/null"), "cannot be written: it is not a regular file"),
        (PathBuf::from(".."), "cannot be written: it is a folder"),
    ] {
        let error = check_writable(&path).unwrap_err().to_string();
        assert!(error.contains(expected) && !error.contains('\n'), "{error}");
    }
    check_writable(&at("new.png")).unwrap();
    assert_eq!(names(&dir), ["closed.png", "file", "folder.png"]);
}

#[cfg(unix)]
#[test]
fn links_are_followed() {
    let (_dir, at) = folder();
    fs::create_dir(at("real")).unwrap();
    fs::write(at("real/a.pfm"), b"old").unwrap();
    std::os::unix::fs::symlink(at("real/a.pfm"), at("link.pfm")).unwrap();
    picture().write(&at("link.pfm"), 0.0).unwrap();
    assert_eq!(Image::read(&at("real/a.pfm")).unwrap(), picture());
    assert!(fs::symlink_metadata(at("link.pfm")).unwrap().file_type().is_symlink());
}
