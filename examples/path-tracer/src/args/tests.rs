//! Defaults, every refusal, and that each is one line.

use std::fs;

use super::*;

fn parse(words: &[&str]) -> Result<Args, Refused> {
    Args::parse_words([&["path-tracer"], words].concat())
}

fn refusal(words: &[&str]) -> String {
    match parse(words) {
        Err(Refused::Wrong(line)) => {
            assert!(!line.contains('\n') && !line.contains('\u{1b}'), "{line:?}");
            line
        }
        other => panic!("{words:?}: {other:?}"),
    }
}

#[test]
fn defaults() {
    let args = parse(&[]).unwrap();
    assert_eq!((args.size, args.samples, args.bounces, args.seed), (Size { width: 512, height: 512 }, 64, 8, 0));
    assert_eq!((args.device, args.threads, args.explain, args.validate), (DeviceChoice::Auto, 0, false, false));
    assert_eq!((args.out.to_str(), args.mesh, args.reference), (Some("path-tracer.png"), None, None));
    Args::command().debug_assert();
}

#[test]
fn everything_at_once() {
    let line = "--device optix --mesh a.glb --size 1920X1080 --samples 4294967296 --bounces 0 --seed 18446744073709551615 \
                --out a.exr --report a.csv --report a.png --reference r.pfm --explain --threads 3 --validate";
    let args = parse(&line.split_whitespace().collect::<Vec<_>>()).unwrap();
    assert_eq!(args.device, DeviceChoice::Optix);
    assert_eq!(args.size.pixels(), 1920 * 1080);
    assert_eq!((args.samples, args.bounces, args.seed, args.threads), (1 << 32, 0, u64::MAX, 3));
    assert_eq!(args.report, [PathBuf::from("a.csv"), PathBuf::from("a.png")]);
    assert!(args.explain && args.validate);
}

#[test]
fn refusals_say_what_is_wrong_in_one_line() {
    let cases: [(&[&str], &str); 14] = [
        (&["--size", "0x5"], "error: invalid value '0x5' for '--size <WxH>': the width is zero (try --help)"),
        (&["--size", "5x0"], "'--size <WxH>': the height is zero"),
        (&["--size", "5"], "WIDTHxHEIGHT is needed, such as 640x480"),
        (&["--size=-5x5"], "the width: invalid digit"),
        (&["--size", "99999999999x1"], "the width: number too large"),
        (&["--size", "32769x32768"], "more than 1073741824 pixels (2^30), the limit of an OptiX launch"),
        (&["--samples", "0"], "error: invalid value '0' for '--samples <N>': 0 is not in 1..=4294967296"),
        (&["--samples", "many"], "'--samples <N>': invalid digit found in string"),
        (&["--bounces", "1025"], "1025 is not in 0..=1024"),
        (
            &["--device", "vulkan"],
            "invalid value 'vulkan' for '--device <DEVICE>'; [possible values: auto, cpu, optix]",
        ),
        (&["--seed", "-1"], "invalid value '-1' for '--seed <N>': invalid digit found in string"),
        (
            &["--sample", "3"],
            "error: unexpected argument '--sample' found; tip: a similar argument exists: '--samples'",
        ),
        (&["--mesh"], "a value is required for '--mesh <FILE>'"),
        (&["bunny.obj"], "unexpected argument 'bunny.obj' found"),
    ];
    for (words, expected) in cases {
        let line = refusal(words);
        assert!(line.contains(expected), "{line}");
    }
}

#[test]
fn help_names_every_option() {
    let Err(Refused::Shown(help)) = parse(&["--help"]) else { panic!("no help") };
    let help = help.render().to_string();
    for option in
        ["device", "mesh", "size", "samples", "bounces", "seed", "out", "report", "reference", "explain", "threads"]
    {
        assert!(help.contains(&format!("--{option}")), "{option}");
    }
    assert!(matches!(parse(&["--version"]), Err(Refused::Shown(_))));
}

#[test]
fn files_are_checked_before_rendering() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let small = Image { width: 2, height: 2, pixels: vec![[0.5; 3]; 4] };
    small.write(Path::new(&at("ref.pfm")), 0.0).unwrap();
    let (out, csv, reference) = (at("a.png"), at("a.csv"), at("ref.pfm"));
    let check = |words: &[&str]| {
        let args = parse(&[&["--size", "2x2", "--out", &out], words].concat()).unwrap();
        args.check().map_err(|e| e.to_string())
    };
    let checked = check(&["--report", &csv, "--report", &at("b.PNG"), "--reference", &reference]).unwrap();
    assert_eq!(checked.reports.iter().map(|r| r.1).collect::<Vec<_>>(), [ReportFormat::Csv, ReportFormat::Png]);
    assert_eq!(checked.reference, Some(small));

    let other_spelling = format!("{}/./a.png", folder.path().display());
    let missing = at("missing.pfm");
    let cases: [(&[&str], &str); 10] = [
        (&["--out", "a.gif"], "--out a.gif: a picture ends in .png (tone-mapped), .exr or .pfm (both linear)"),
        (&["--out", "/nowhere/a.png"], "--out /nowhere/a.png: cannot be written: the folder /nowhere: No such file"),
        (&["--report", "a.txt"], "--report a.txt: a report ends in .csv (a table) or .png (a plot)"),
        (&["--report", "/nowhere/a.csv"], "--report /nowhere/a.csv: cannot be written: "),
        (&["--report", &other_spelling], "--out and --report are the same file"),
        (&["--report", &csv, "--report", &csv], "--report and --report are the same file"),
        (&["--mesh", "bunny.ply"], "--mesh bunny.ply: a mesh file ends in .obj, .gltf or .glb"),
        (&["--reference", "ref.png"], "--reference ref.png: a linear picture ends in .pfm or .exr"),
        (&["--reference", &missing], "missing.pfm: cannot be read: No such file"),
        (&["--size", "3x2", "--reference", &reference], "ref.pfm: is 2x2, 3x2 is needed"),
    ];
    for (words, expected) in cases {
        // A later option does not override an earlier one in clap; leave out what the case gives itself.
        let mut line: Vec<&str> = words.to_vec();
        for (option, value) in [("--size", "2x2"), ("--out", out.as_str())] {
            if !words.contains(&option) {
                line.extend([option, value]);
            }
        }
        let error = parse(&line).unwrap().check().unwrap_err().to_string();
        assert!(error.contains(expected) && !error.contains('\n'), "{error}");
    }
    let error = parse(&["--size", "2x2", "--out", &reference, "--reference", &reference]).unwrap().check().unwrap_err();
    assert!(error.to_string().starts_with("--out and --reference are the same file"), "{error}");
    // Nothing was written.
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn memory_is_checked() {
    let args = parse(&["--size", "32768x32768"]).unwrap();
    let error = args.check_memory(Some(1 << 30)).unwrap_err().to_string();
    assert_eq!(error, "--size 32768x32768 needs about 163840 MiB of memory, 1024 MiB are free");
    assert!(args.check_memory(None).is_ok());
    assert!(parse(&[]).unwrap().check_memory(Some(1 << 30)).is_ok());
    if cfg!(target_os = "linux") {
        assert!(free_memory().is_none_or(|free| free > 0));
    }
}
